"""Units: each defined once, meaning what its name says, and every unit that is used defined."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from math import isclose, isfinite, pi
from typing import Any

from .contents import FILE, Fmu, real, true, whole
from .finding import Finding, error, warning
from .unit_names import meaning

DUPLICATE = error("unit-duplicate", "No two units have the same name.", "2.2.2", "2.4.3")
EMPTY = error("unit-name", "Units and display units have names.", "2.2.2", "2.4.3")
DISPLAY_DUPLICATE = error(
    "display-unit-duplicate", "No two display units of one unit have the same name.", "2.2.2", "2.4.3"
)
FACTOR = error("unit-factor", "Factors of units are finite and not 0, offsets finite.", "2.2.2", "2.4.3")
INVERSE = error("unit-inverse", "An inverse display unit has no offset.", None, "2.4.3")
MEANING = warning("unit-meaning", "The exponents and the factor are those that the name says.", "2.2.2", "2.4.3")
BASE = warning("unit-base", "A unit says what it is in base units.", "2.2.2", "2.4.3")
UNDEFINED = error("unit-undefined", "Every unit that is used is defined.", "2.2.7", "2.4.7.5")
DISPLAY_UNDEFINED = error(
    "display-unit-undefined", "Every display unit is defined under the unit it belongs to.", "2.2.7", "2.4.7.5"
)

_BASES = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")


def base(element: Any) -> dict[str, int] | None:
    """Exponents of a Unit element that are not 0; None where it has no BaseUnit."""
    inner = element.find("BaseUnit")
    if inner is None:
        return None
    return {name: e for name in _BASES if (e := whole(inner.get(name, "0"))) not in (0, None)}


def check(fmu: Fmu) -> Iterator[Finding]:
    """Definitions, then uses."""
    elements = list(fmu.root.iterfind("UnitDefinitions/Unit"))
    for name, count in Counter(e.get("name", "") for e in elements).items():
        if count > 1:
            yield DUPLICATE.found(fmu.version, f'{FILE}: unit "{name}" is defined {count} times; keep one')
    for element in elements:
        yield from _definition(fmu.version, element)
    defined = {e.get("name", ""): {d.get("name", "") for d in e.iterfind("DisplayUnit")} for e in elements}
    yield from _uses(fmu, defined)


def _definition(version: int, unit: Any) -> Iterator[Finding]:
    place = f'{FILE}, unit "{unit.get("name", "")}" (line {unit.sourceline})'
    shown = list(unit.iterfind("DisplayUnit"))
    if any(not e.get("name", "").strip() for e in [unit, *shown]):
        yield EMPTY.found(version, f"{place}: it or a display unit of it has no name; name it")
    for name, count in Counter(e.get("name", "") for e in shown).items():
        if count > 1:
            yield DISPLAY_DUPLICATE.found(version, f'{place}: display unit "{name}" is defined {count} times; keep one')
    for element in [*unit.iterfind("BaseUnit"), *shown]:
        factor, offset = real(element.get("factor", "1")), real(element.get("offset", "0"))
        wrong = (factor is not None and (factor == 0.0 or not isfinite(factor))) or not isfinite(offset or 0.0)
        if wrong:
            yield FACTOR.found(version, f"{place}: {element.tag} has factor {factor} and offset {offset}; correct it")
        if true(element.get("inverse")) and offset:
            yield INVERSE.found(version, f"{place}: an inverse display unit has the offset {offset:g}; leave it out")
    yield from _meaning(version, unit, place)
    yield from _shown(version, unit, place)


def _meaning(version: int, unit: Any, place: str) -> Iterator[Finding]:
    exponents, said = base(unit), meaning(unit.get("name", ""))
    if exponents is None:
        yield BASE.found(version, f"{place}: has no BaseUnit, so that importers cannot convert it; add it")
        return
    if said is None or unit.get("name") == "Hz":
        return
    factor = real(unit.find("BaseUnit").get("factor", "1")) or 0.0
    # an angle may count as a pure number
    differ = {k: v for k, v in said[1].items() if k != "rad"} != {k: v for k, v in exponents.items() if k != "rad"}
    if differ or not any(isclose(factor, said[0] * turn, rel_tol=1e-6) for turn in (1.0, 0.5 / pi)):
        message = f"{place}: its BaseUnit is {exponents} with factor {factor:g}, its name says {said[1]}, {said[0]:g}"
        yield MEANING.found(version, f"{message}; correct one of them")


def _shown(version: int, unit: Any, place: str) -> Iterator[Finding]:
    """A display unit whose name is understood has the factor that both names say."""
    said = meaning(unit.get("name", ""))
    for element in unit.iterfind("DisplayUnit"):
        shown, factor = meaning(element.get("name", "")), real(element.get("factor", "1"))
        if said is None or shown is None or factor is None or true(element.get("inverse")):
            continue
        expected = said[0] / shown[0]
        if not any(isclose(factor, expected * turn, rel_tol=1e-6) for turn in (1.0, 2.0 * pi, 0.5 / pi)):
            message = f'{place}: display unit "{element.get("name")}" has factor {factor:g}, its name says {expected:g}'
            yield MEANING.found(version, f"{message}; correct one of them")


def _uses(fmu: Fmu, defined: dict[str, set[str]]) -> Iterator[Finding]:
    used = [(v.place, v.unit, v.attributes.get("displayUnit")) for v in fmu.variables]
    used += [(v.place, v.unit, shown) for v in fmu.variables for _, shown in v.aliases]
    for element in fmu.root.iterfind("TypeDefinitions/*"):
        inner = next(element.iterchildren("*"), None) if fmu.version == 2 else element
        if inner is not None:
            place = f'{FILE}, type "{element.get("name", "")}" (line {element.sourceline})'
            used.append((place, inner.get("unit"), inner.get("displayUnit")))
    for place, unit, shown in used:
        if unit is not None and unit not in defined:
            yield UNDEFINED.found(fmu.version, f'{place}: unit "{unit}" is not defined; define it in UnitDefinitions')
        if shown is not None and shown not in defined.get(unit or "", ()):
            message = f'{place}: display unit "{shown}" is not defined under unit "{unit}"; define it there'
            yield DISPLAY_UNDEFINED.found(fmu.version, message)
