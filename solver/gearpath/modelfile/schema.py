"""JSON schema of the model file, generated from its tables, for editors and other programs."""

import json
from typing import Any

from .tables import FileTable
from .wording import NAME

DIALECT = "https://json-schema.org/draft/2020-12/schema"
# Of these keys exactly one set must be given.
_ONE_OF = {
    "ShaftTable": (("length", "diameter"), ("sections",)),
    "BearingTable": (("stiffness",), ("geometry",), ("catalogue",)),
    "ExcitationTable": (("mesh",), ("point", "dof")),
}
_NAMED = ("properties", "patternProperties", "$defs", "default")
_ANY_OF = {"SourceTable": (("harmonics",), ("sidebands",))}  # at least one
_NOT_BOTH = {"BearingTable": ("damping", "damping_time"), "MountTable": ("damping", "damping_time")}


def json_schema() -> dict[str, Any]:
    """The schema (draft 2020-12); every key carries a description and numbers their unit as `x-unit`."""
    schema = FileTable.model_json_schema()
    definitions = schema["$defs"]
    for table in (schema, *definitions.values()):
        for field in table["properties"].values():
            if "default" in field and field["default"] in (None, "", []):
                del field["default"]
            if {"type": "null"} in field.get("anyOf", ()):  # a table that may be left out; a file has no null
                field |= field.pop("anyOf")[0]
            _close(field)
    for name, choices in _ONE_OF.items():
        definitions[name]["oneOf"] = [{"required": list(keys)} for keys in choices]
    for name, choices in _ANY_OF.items():
        definitions[name]["anyOf"] = [{"required": list(keys)} for keys in choices]
    for name, keys in _NOT_BOTH.items():
        definitions[name]["not"] = {"required": list(keys)}
    for key in ("components", "joints"):
        schema["properties"][key]["minProperties"] = 1
    for table in (schema, *definitions.values()):
        table.pop("title", None)
    return {"$schema": DIALECT, "title": "Gearpath model file", **_canonical(schema)}


def _canonical(node: Any, names: bool = False) -> Any:
    """The same schema whatever the version of pydantic: keywords in order, no idle wrappers.

    `names` holds inside `properties` and the like, whose keys are the file's own and keep their order.
    """
    if isinstance(node, list):
        return [_canonical(item) for item in node]
    if not isinstance(node, dict):
        return node
    node = dict(node)
    if not names:
        if len(node.get("allOf", ())) == 1:
            node |= node.pop("allOf")[0]
        if "const" in node:
            node.pop("enum", None)
    keys = node if names else sorted(node)
    return {key: _canonical(node[key], not names and key in _NAMED) for key in keys}


def _close(field: dict[str, Any]) -> None:
    """Give a table of named entries its pattern of names and nothing else."""
    entries = field.pop("additionalProperties", None)
    patterns = field.pop("patternProperties", {})
    if field.get("type") == "object":
        values = patterns.get(NAME, entries)
        field |= {"patternProperties": {NAME: values}, "additionalProperties": False}
        field.pop("propertyNames", None)
    field.pop("title", None)


def schema_text() -> str:
    """The schema as the text of models/gearpath.schema.json."""
    return json.dumps(json_schema(), indent=2, ensure_ascii=False) + "\n"
