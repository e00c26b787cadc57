"""Names and value references of variables."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator

from .contents import FILE, Fmu, Variable
from .finding import Finding, error

EMPTY = error("variable-name-empty", "Every variable has a name.", "2.2.7", "2.4.7.4")
DUPLICATE = error("variable-name-duplicate", "No two variables or aliases have the same name.", "2.2.7", "2.4.7.4")
STRUCTURED = error(
    "variable-name-structured", "Structured names follow the grammar of the standard.", "2.2.9", "2.4.7.5.1"
)
FLAT = error("variable-name-flat", "Names have no line ends and no tabs.", "2.2.9", "2.4.7.5.1")
REFERENCE = error("value-reference", "Every value reference belongs to one variable.", None, "2.4.7.4")
ALIAS_START = error("alias-start", "Of the variables with one reference at most one can be set.", "2.2.7", None)
ALIAS_UNIT = error("alias-unit", "Variables with one reference have the same unit.", "2.2.7", None)
ALIAS_CONSTANT = error("alias-constant", "A constant shares its reference with equal constants only.", "2.2.7", None)

_QUOTED = r"'(?:[A-Za-z0-9_!#$%&()*+,\-./:;<>=?@\[\]^{}|~ ]|\\['\"?\\abfnrtv])+'"
_PART = rf"(?:[A-Za-z_][A-Za-z0-9_]*|{_QUOTED})(?:\[\d+(?:,\d+)*\])?"
_IDENTIFIER = rf"{_PART}(?:\.{_PART})*"
_STRUCTURED = re.compile(rf"{_IDENTIFIER}|der\({_IDENTIFIER}(?:,\d+)?\)")


def check(fmu: Fmu) -> Iterator[Finding]:
    """Names of variables and aliases, then references."""
    structured = fmu.root.get("variableNamingConvention") == "structured"
    names = [(v.name, v.place) for v in fmu.variables]
    names += [(alias, f'{v.place}, alias "{alias}"') for v in fmu.variables for alias, _ in v.aliases]
    for name, place in names:
        if not name.strip():
            yield EMPTY.found(fmu.version, f"{place}: has no name; name it")
        elif re.search(r"[\r\n\t]", name):
            yield FLAT.found(fmu.version, f"{place}: has a line end or a tab in its name; leave it out")
        elif structured and not _STRUCTURED.fullmatch(name):
            message = f"{place}: is no structured name; use letters, digits, _, [1,2] and ., or put it in apostrophes"
            yield STRUCTURED.found(fmu.version, message)
    for name, count in Counter(name for name, _ in names).items():
        if count > 1:
            yield DUPLICATE.found(fmu.version, f'{FILE}: {count} variables are named "{name}"; rename all but one')
    yield from _references(fmu)


def _references(fmu: Fmu) -> Iterator[Finding]:
    groups: dict[tuple[str, int], list[Variable]] = {}
    for v in fmu.variables:
        if v.reference is not None:
            kind = {"Enumeration": "Integer"}.get(v.type, v.type) if fmu.version == 2 else ""
            groups.setdefault((kind, v.reference), []).append(v)
    for (_, reference), group in groups.items():
        if len(group) < 2:
            continue
        listed = ", ".join(f'"{v.name}"' for v in group)
        place = f"{FILE}, variables {listed} with valueReference {reference}"
        if fmu.version == 3:
            yield REFERENCE.found(3, f"{place}: share a reference; give each its own, or use <Alias>")
        else:
            yield from _aliases(group, place)


def _aliases(group: list[Variable], place: str) -> Iterator[Finding]:
    constants = [v for v in group if v.variability == "constant"]
    settable = [v for v in group if v not in constants and (v.start is not None or v.causality == "input")]
    if len(settable) > 1:
        yield ALIAS_START.found(2, f"{place}: {len(settable)} of them have a start value; leave it to one")
    if len({v.unit for v in group}) > 1:
        yield ALIAS_UNIT.found(2, f"{place}: have different units; give them one")
    if constants and (len(constants) < len(group) or len({v.start for v in constants}) > 1):
        yield ALIAS_CONSTANT.found(2, f"{place}: are not all the same constant; give them references of their own")
