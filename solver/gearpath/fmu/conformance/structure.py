"""The lists of the ModelStructure: complete, without repetition, in order."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import pairwise

from .contents import FILE, FLOATS, Fmu, Unknown, Variable
from .finding import Finding, Rule, error, warning

REFERENCE = error("structure-reference", "Every entry leads to a variable.", "2.2.8", "2.4.8")
DUPLICATE = error("structure-duplicate", "No list names a variable twice.", "2.2.8", "2.4.8")
OUTPUT_MISSING = error("output-missing", "Every output is listed.", "2.2.8", "2.4.8")
OUTPUT_EXTRA = error("output-extra", "Only outputs are listed as outputs.", "2.2.8", "2.4.8")
OUTPUT_ORDER = warning("output-order", "Outputs are listed in the order of the variables.", "2.2.8", "2.4.8")
DERIVATIVE_EXTRA = error("derivative-extra", "Every listed derivative has the attribute derivative.", "2.2.8", "2.4.8")
DERIVATIVE_MISSING = error("derivative-missing", "Model exchange lists every derivative of a state.", "2.2.8", "2.4.8")
INITIAL_MISSING = error("initial-unknown-missing", "Every initial unknown is listed.", "2.2.8", "2.4.8")
INITIAL_EXTRA = error("initial-unknown-extra", "Only initial unknowns are listed as such.", "2.2.8", "2.4.8")
INITIAL_ORDER = error("initial-unknown-order", "Initial unknowns are in the order of the variables.", "2.2.8", None)
INITIAL_ORDER_3 = warning(
    "initial-unknown-unordered", "Initial unknowns are in the order of the variables.", None, "2.4.8"
)
EVENT = error("event-indicator", "Event indicators are continuous floats.", None, "2.4.8")


def resolved(fmu: Fmu, entry: Unknown) -> Variable | None:
    """The variable of an entry."""
    return fmu.by_key.get(entry.key) if entry.key is not None else None


def check(fmu: Fmu) -> Iterator[Finding]:
    """Each list against the variables."""
    for kind in ("Output", "Derivative", "ClockedState", "InitialUnknown", "EventIndicator"):
        entries = fmu.listed(kind)
        for entry in entries:
            if entry.key not in fmu.by_key:
                yield REFERENCE.found(fmu.version, f"{entry.place}: no variable has that number; correct or remove it")
        for key, count in Counter(e.key for e in entries).items():
            if count > 1:
                message = f"{FILE}: the {kind} list names {_name(fmu, key)} {count} times; keep one"
                yield DUPLICATE.found(fmu.version, message)
    yield from _outputs(fmu)
    yield from _derivatives(fmu)
    yield from _initial(fmu)
    for entry in fmu.listed("EventIndicator"):
        v = resolved(fmu, entry)
        if v is not None and (v.type not in FLOATS or v.variability != "continuous"):
            message = f'{entry.place}: "{v.name}" is a {v.variability} {v.type}; list a continuous float'
            yield EVENT.found(fmu.version, message)


def _outputs(fmu: Fmu) -> Iterator[Finding]:
    wanted = [v for v in fmu.variables if v.causality == "output"]
    yield from _compare(fmu, "Output", wanted, OUTPUT_MISSING, OUTPUT_EXTRA, "an output")
    yield from _ordered(fmu, "Output", OUTPUT_ORDER)


def _derivatives(fmu: Fmu) -> Iterator[Finding]:
    listed = {e.key for e in fmu.listed("Derivative")}
    for entry in fmu.listed("Derivative"):
        v = resolved(fmu, entry)
        if v is not None and v.derivative is None:
            message = f'{entry.place}: "{v.name}" has no attribute derivative; say which state it derives'
            yield DERIVATIVE_EXTRA.found(fmu.version, message)
    if "ModelExchange" not in fmu.interfaces:
        return
    for v in fmu.variables:
        state = fmu.by_key.get(v.derivative) if v.derivative is not None else None
        internal = v.causality == "local" and state is not None and state.causality == "local"
        if internal and fmu.key(v) not in listed:
            message = f"{v.place}: is the derivative of a local variable but not listed; add it to the derivatives"
            yield DERIVATIVE_MISSING.found(fmu.version, message)


def _initial(fmu: Fmu) -> Iterator[Finding]:
    continuous = {s.name for s in fmu.states if s is not None}
    continuous |= {v.name for e in fmu.listed("Derivative") if (v := resolved(fmu, e)) is not None}
    wanted = []
    for v in fmu.variables:
        open_ = v.initial in ("approx", "calculated")
        plain = v.clocks is None and v.type != "Clock"
        shown = v.causality == "output" or v.name in continuous
        if v.causality == "calculatedParameter" or (open_ and plain and shown):
            wanted.append(v)
    yield from _compare(fmu, "InitialUnknown", wanted, INITIAL_MISSING, INITIAL_EXTRA, "an initial unknown")
    yield from _ordered(fmu, "InitialUnknown", INITIAL_ORDER if fmu.version == 2 else INITIAL_ORDER_3)


def _compare(fmu: Fmu, kind: str, wanted: list[Variable], missing: Rule, extra: Rule, what: str) -> Iterator[Finding]:
    listed = {e.key for e in fmu.listed(kind)}
    keys = {fmu.key(v) for v in wanted}
    for v in wanted:
        if fmu.key(v) not in listed:
            yield missing.found(fmu.version, f"{v.place}: is {what} but not listed; add it to the {kind} list")
    for entry in fmu.listed(kind):
        found = resolved(fmu, entry)
        if found is not None and entry.key not in keys and found.clocks is None and found.type != "Clock":
            yield extra.found(
                fmu.version, f'{entry.place}: "{found.name}" is not {what}; remove it from the {kind} list'
            )


def _ordered(fmu: Fmu, kind: str, rule: Rule) -> Iterator[Finding]:
    entries = fmu.listed(kind)
    positions = [(v.index, e) for e in entries if (v := resolved(fmu, e)) is not None]
    for (before, _), (after, entry) in pairwise(positions):
        if after < before:
            message = f"{entry.place}: comes after a later variable; list them in the order of the variables"
            yield rule.found(fmu.version, message)
            return


def _name(fmu: Fmu, key: int | None) -> str:
    v = fmu.by_key.get(key) if key is not None else None
    return f'"{v.name}"' if v else str(key)
