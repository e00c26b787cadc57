"""From the model description to what the checks look at."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from .archive import Archive
from .contents import FLOATS, Dimension, Fmu, Unknown, Variable, whole
from .initials import default_initial

_LISTS = {"Outputs": "Output", "Derivatives": "Derivative", "InitialUnknowns": "InitialUnknown"}


def version_of(root: Any) -> int | None:
    """2 or 3, or None for anything else; what exactly is written is the matter of a rule."""
    stated = str(root.get("fmiVersion", "")).strip()
    return int(stated[0]) if stated[:1] in ("2", "3") and stated[1:2] in ("", ".") else None


def read(archive: Archive, version: int, root: Any, documents: Mapping[str, Any]) -> Fmu:
    """Everything that the checks need."""
    types = _types(version, root)
    listed = root.find("ModelVariables")
    elements = [] if listed is None else list(listed.iterchildren("*"))
    reader = _variable_2 if version == 2 else _variable_3
    variables = tuple(reader(index, element, types) for index, element in enumerate(elements, 1))
    return Fmu(archive, version, root, variables, tuple(_unknowns(version, root)), documents)


def _types(version: int, root: Any) -> dict[str, Mapping[str, str]]:
    """Attributes of the type definitions by name."""
    found: dict[str, Mapping[str, str]] = {}
    for element in root.iterfind("TypeDefinitions/*"):
        name = element.get("name")
        if name is not None:
            inner = next(element.iterchildren("*"), None) if version == 2 else element
            found[name] = {} if inner is None else _without(inner.attrib, "name", "description")
    return found


def _variable_2(index: int, element: Any, types: Mapping[str, Mapping[str, str]]) -> Variable:
    inner = next((e for e in element.iterchildren("*") if e.tag != "Annotations"), None)
    own = dict(element.attrib) | ({} if inner is None else dict(inner.attrib))
    kind = "" if inner is None else str(inner.tag)
    start = (own["start"],) if "start" in own else None
    return _variable(index, element, kind, own, types, start, "continuous", (), ())


def _variable_3(index: int, element: Any, types: Mapping[str, Mapping[str, str]]) -> Variable:
    own, kind = dict(element.attrib), str(element.tag)
    start = tuple(own["start"].split()) if "start" in own else None
    if kind in ("String", "Binary"):
        values = tuple(e.get("value", "") for e in element.iterchildren("Start"))
        start = values or None
    sizes = tuple(
        Dimension(whole(e.get("start")), whole(e.get("valueReference"))) for e in element.iterchildren("Dimension")
    )
    aliases = tuple((e.get("name", ""), e.get("displayUnit")) for e in element.iterchildren("Alias"))
    default = "continuous" if kind in FLOATS else "discrete"
    return _variable(index, element, kind, own, types, start, default, sizes, aliases)


def _variable(
    index: int,
    element: Any,
    kind: str,
    own: dict[str, str],
    types: Mapping[str, Mapping[str, str]],
    start: tuple[str, ...] | None,
    default_variability: str,
    dimensions: tuple[Dimension, ...],
    aliases: tuple[tuple[str, str | None], ...],
) -> Variable:
    causality = element.get("causality", "local")
    variability = element.get("variability", default_variability)
    given = element.get("initial")
    clocks = element.get("clocks")
    return Variable(
        index=index,
        name=element.get("name", ""),
        type=kind,
        reference=whole(element.get("valueReference")),
        causality=causality,
        variability=variability,
        initial=given if given is not None else default_initial(causality, variability),
        initial_given=given is not None,
        attributes={**types.get(own.get("declaredType", ""), {}), **own},
        own=own,
        start=start,
        dimensions=dimensions,
        aliases=aliases,
        clocks=None if clocks is None else tuple(n for n in map(whole, clocks.split()) if n is not None),
        line=element.sourceline or 0,
    )


def _unknowns(version: int, root: Any) -> Iterator[Unknown]:
    if version == 2:
        for tag, kind in _LISTS.items():
            for element in root.iterfind(f"ModelStructure/{tag}/Unknown"):
                yield _unknown(kind, element, "index")
        return
    for element in root.iterfind("ModelStructure/*"):
        kind = "Derivative" if element.tag == "ContinuousStateDerivative" else str(element.tag)
        yield _unknown(kind, element, "valueReference")


def _unknown(kind: str, element: Any, key: str) -> Unknown:
    dependencies, kinds = element.get("dependencies"), element.get("dependenciesKind")
    numbers = None if dependencies is None else tuple(n for n in map(whole, dependencies.split()) if n is not None)
    return Unknown(
        kind, whole(element.get(key)), numbers, None if kinds is None else tuple(kinds.split()), element.sourceline or 0
    )


def _without(attributes: Mapping[str, str], *names: str) -> dict[str, str]:
    return {key: value for key, value in attributes.items() if key not in names}
