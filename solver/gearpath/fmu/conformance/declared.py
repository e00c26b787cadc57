"""Type definitions: each defined once, of the kind of the variables that declare it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

from .contents import FILE, Fmu
from .finding import Finding, error

DUPLICATE = error("type-duplicate", "No two types have the same name.", "2.2.3", "2.4.4")
CLASH = error("type-variable-name", "No type has the name of a variable.", "2.2.3", "2.4.4")
UNDEFINED = error("type-undefined", "Every declared type is defined.", "2.2.7", "2.4.7.5")
KIND = error("type-kind", "A declared type is of the kind of its variable.", "2.2.7", "2.4.7.5")
ITEM = error("type-item", "Items of an enumeration differ in name and in value.", "2.2.3", "2.4.4")
ENUMERATION = error("enumeration-start", "The start of an enumeration is one of its items.", "2.2.7", "2.4.7.5")


def check(fmu: Fmu) -> Iterator[Finding]:
    """Definitions, then uses."""
    elements = list(fmu.root.iterfind("TypeDefinitions/*"))
    for name, count in Counter(e.get("name", "") for e in elements).items():
        if count > 1:
            yield DUPLICATE.found(fmu.version, f'{FILE}: type "{name}" is defined {count} times; keep one')
    for element in elements:
        name = element.get("name", "")
        place = f'{FILE}, type "{name}" (line {element.sourceline})'
        if name in fmu.by_name:
            yield CLASH.found(fmu.version, f"{place}: a variable has the same name; rename one")
        for attribute in ("name", "value"):
            for value, count in Counter(e.get(attribute) for e in _items(fmu.version, element)).items():
                if count > 1:
                    yield ITEM.found(fmu.version, f'{place}: {count} items have the {attribute} "{value}"; keep one')
    yield from _uses(fmu, {e.get("name", ""): e for e in elements})


def _uses(fmu: Fmu, defined: dict[str, Any]) -> Iterator[Finding]:
    for v in fmu.variables:
        declared = v.own.get("declaredType")
        if declared is None:
            continue
        if declared not in defined:
            yield UNDEFINED.found(fmu.version, f'{v.place}: declared type "{declared}" is not defined; define it')
            continue
        kind = _kind(fmu.version, defined[declared])
        if kind and kind != v.type:
            message = f'{v.place}: is a {v.type} but its declared type "{declared}" is for {kind}; declare another'
            yield KIND.found(fmu.version, message)
        items = {item.get("value") for item in _items(fmu.version, defined[declared])}
        for start in set(v.start or ()) - items if v.type == "Enumeration" else ():
            yield ENUMERATION.found(fmu.version, f'{v.place}: start {start} is no item of "{declared}"; use one')


def _kind(version: int, element: Any) -> str:
    if version == 3:
        return str(element.tag).removesuffix("Type")
    inner = next(element.iterchildren("*"), None)
    return "" if inner is None else str(inner.tag)


def _items(version: int, element: Any) -> list[Any]:
    return list(element.iterfind("Enumeration/Item" if version == 2 else "Item"))
