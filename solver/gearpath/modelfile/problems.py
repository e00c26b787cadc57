"""From pydantic's errors to the one sentence of a ModelError."""

from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from ..errors import ModelError
from .leaf import WRONG
from .wording import dotted, show


def first_problem(error: ValidationError, data: object, file: str | None) -> ModelError:
    """The first problem, in the order of the tables."""
    found = error.errors(include_url=False, include_input=True)[0]
    context: Mapping[str, Any] = found.get("ctx", {})
    location = list(found["loc"])
    if location[:1] in (["components"], ["joints"]) and len(location) > 2:
        del location[2]  # pydantic puts the kind there
    if "geometry" in location[:-1]:
        del location[location.index("geometry") + 1]  # and the type here
    if location[-1:] == ["[key]"]:
        del location[-1]
    key = dotted([*_named(location, data), *context.get("key", ())]) or "the file"
    if found["type"] == WRONG:
        return ModelError(key, context["problem"], context["remedy"], file=file)
    return ModelError(key, f"{show(found['input'])} cannot be used", found["msg"], file=file)


def _named(location: list[Any], data: object) -> list[Any]:
    """The location with the names of list entries that have one, as in `disks.pinion.z`."""
    out = []
    for part in location:
        inside = isinstance(data, Mapping) and part in data
        if isinstance(data, list) and isinstance(part, int) and part < len(data):
            data = data[part]
            name = data.get("name") if isinstance(data, Mapping) else None
            out.append(name if isinstance(name, str) and name.isidentifier() else str(part))
            continue
        data = data[part] if inside and isinstance(data, Mapping) else None
        out.append(part)
    return out
