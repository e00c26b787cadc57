"""The attributes dependencies and dependenciesKind of the ModelStructure."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from .contents import FILE, FLOATS, Fmu, Unknown
from .finding import Finding, error, warning
from .structure import resolved

MISSING = warning("dependencies-missing", "dependencies are given, if only as an empty list.", "2.2.8", "2.4.8")
REFERENCE = error("dependency-reference", "Every dependency is a variable.", "2.2.8", "2.4.8")
KNOWN = error("dependency-known", "Unknowns depend on knowns only.", "2.2.8", "2.4.8")
PARAMETER = warning("dependency-parameter", "Outputs and derivatives of FMI 2 list no parameters.", "2.2.8", None)
DUPLICATE = error("dependency-duplicate", "No dependency is listed twice.", "2.2.8", "2.4.8")
ORDER = error("dependency-order", "Dependencies are in ascending order.", "2.2.8", None)
KIND_COUNT = error("dependency-kind-count", "There is a dependenciesKind for every dependency.", "2.2.8", "2.4.8")
KIND = error("dependency-kind", "dependenciesKind fits the list and the type of the unknown.", "2.2.8", "2.4.8")

_LATER = ("fixed", "tunable", "discrete")


def check(fmu: Fmu) -> Iterator[Finding]:
    """Every entry of every list but the event indicators."""
    silent = Counter(e.list for e in fmu.unknowns if e.dependencies is None and e.list != "EventIndicator")
    for kind, count in silent.items():
        message = f"{FILE}: {count} entries of the {kind} list give no dependencies, so importers assume all; give them"
        yield MISSING.found(fmu.version, message)
    states = {s.name for s in fmu.states if s is not None}
    for entry in fmu.unknowns:
        if entry.dependencies is not None:
            yield from _listed(fmu, entry, entry.dependencies, states)
        yield from _kinds(fmu, entry)


def _listed(fmu: Fmu, entry: Unknown, keys: tuple[int, ...], states: set[str]) -> Iterator[Finding]:
    for key, count in Counter(keys).items():
        if count > 1:
            yield DUPLICATE.found(fmu.version, f"{entry.place}: names {key} {count} times; keep one")
    if fmu.version == 2 and list(keys) != sorted(keys):
        yield ORDER.found(2, f"{entry.place}: its dependencies are not in ascending order; sort them")
    for key in dict.fromkeys(keys):
        known = fmu.by_key.get(key)
        if known is None:
            yield REFERENCE.found(fmu.version, f"{entry.place}: depends on {key}, which no variable has; remove it")
            continue
        place = f'{entry.place}: depends on "{known.name}"'
        if known.causality in ("input", "independent") or known.type == "Clock" or entry.list == "EventIndicator":
            continue
        if entry.list == "InitialUnknown":
            if known.initial != "exact" and known.name not in states:
                yield KNOWN.found(fmu.version, f"{place}, which is calculated itself; list what that depends on")
        elif known.causality in ("parameter", "structuralParameter"):
            if fmu.version == 2:
                yield PARAMETER.found(2, f"{place}, a parameter, which is no known there; remove it")
        elif known.name not in states and known.clocks is None and known.variability != "discrete":
            yield KNOWN.found(fmu.version, f"{place}, which is neither an input nor a state; list inputs and states")


def _kinds(fmu: Fmu, entry: Unknown) -> Iterator[Finding]:
    if entry.kinds is None:
        return
    count = None if entry.dependencies is None else len(entry.dependencies)
    if count != len(entry.kinds):
        message = f"{entry.place}: has {len(entry.kinds)} kinds for {count or 'no'} dependencies; give one for each"
        yield KIND_COUNT.found(fmu.version, message)
    unknown = resolved(fmu, entry)
    for kind in dict.fromkeys(entry.kinds):
        if entry.list == "InitialUnknown" and kind in _LATER:
            yield KIND.found(fmu.version, f'{entry.place}: kind "{kind}" does not exist at the start; use dependent')
        elif kind != "dependent" and unknown is not None and unknown.type not in FLOATS:
            yield KIND.found(fmu.version, f'{entry.place}: kind "{kind}" is for floats; use dependent')
