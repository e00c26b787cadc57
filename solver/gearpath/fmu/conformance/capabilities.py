"""What the interface types claim: flags that need each other, and attributes in the spelling of the other edition."""

from __future__ import annotations

from collections.abc import Iterator
from difflib import get_close_matches
from functools import cache
from math import isfinite

from .contents import FILE, Fmu, real, true
from .documents import schema_attributes
from .finding import Finding, error, warning

SERIALIZE = error(
    "capability-serialize", "canSerializeFMUstate comes with canGetAndSetFMUstate.", "3.3.1, 4.3.1", "2.4.2"
)
SPELLING = error(
    "capability-spelling", "Attributes of the interface types are spelled as in their edition.", "3.3.1, 4.3.1", "2.4.2"
)
INTERNAL_STEP = error("internal-step", "fixedInternalStepSize is positive.", None, "4.3.1")
EARLY_RETURN = warning(
    "capability-early-return",
    "An early return after intermediate updates needs such updates.",
    None,
    "4.3.1",
)
EVENTS_NEGATIVE = error("event-indicators", "numberOfEventIndicators is a whole number from 0.", "2.2.1", None)
UPDATE = error("intermediate-update", "No parameter, and no clock, has intermediateUpdate.", None, "2.4.7.4")
UPDATE_UNUSED = warning(
    "intermediate-update-unused", "Variables with intermediateUpdate need providesIntermediateUpdate.", None, "2.4.7.4"
)
MULTIPLE_SET = error("multiple-set", "canHandleMultipleSetPerTimeInstant is given for inputs only.", "2.2.7", "2.4.7.4")

_TYPES_3 = {
    "ModelExchange": "fmi3ModelExchange",
    "CoSimulation": "fmi3CoSimulation",
    "ScheduledExecution": "fmi3ScheduledExecution",
}


def check(fmu: Fmu) -> Iterator[Finding]:
    """Flags of the interface types, and flags of variables that hang together with them."""
    state = "State" if fmu.version == 3 else "state"
    for kind, element in fmu.interfaces.items():
        if true(element.get(f"canSerializeFMU{state}")) and not true(element.get(f"canGetAndSetFMU{state}")):
            message = f"{FILE}, {kind}: canSerializeFMU{state} without canGetAndSetFMU{state}; set both or none"
            yield SERIALIZE.found(fmu.version, message)
        step = real(element.get("fixedInternalStepSize"))
        if step is not None and not (isfinite(step) and step > 0.0):
            message = f"{FILE}, {kind}: fixedInternalStepSize is {step:g}; give a positive one"
            yield INTERNAL_STEP.found(fmu.version, message)
        if true(element.get("canReturnEarlyAfterIntermediateUpdate")) and not true(
            element.get("providesIntermediateUpdate")
        ):
            message = f"{FILE}, {kind}: returns early after intermediate updates but provides none; set both or none"
            yield EARLY_RETURN.found(fmu.version, message)
        yield from _spelling(fmu, kind, dict(element.attrib))
    indicators = fmu.root.get("numberOfEventIndicators")
    if fmu.version == 2 and indicators is not None and not str(indicators).strip().isdecimal():
        message = f'{FILE}: numberOfEventIndicators is "{indicators}"; give a whole number'
        yield EVENTS_NEGATIVE.found(fmu.version, message)
    yield from _variables(fmu)


def _spelling(fmu: Fmu, kind: str, attributes: dict[str, str]) -> Iterator[Finding]:
    """The schema of FMI 3 lets any attribute pass here, so that a misspelled flag is silently off."""
    if fmu.version == 2:
        return  # the schema of FMI 2 refuses them
    known = _known(kind)
    for name in attributes:
        if name not in known and not name.startswith("{"):
            close = get_close_matches(name, sorted(known), 1, 0.6)
            remedy = f'write "{close[0]}"' if close else "leave it out"
            yield SPELLING.found(3, f'{FILE}, {kind}: FMI 3 has no attribute "{name}"; {remedy}')


@cache
def _known(kind: str) -> frozenset[str]:
    file = "fmi3/fmi3InterfaceType.xsd"
    return schema_attributes(file, "fmi3InterfaceType") | schema_attributes(file, _TYPES_3[kind])


def _variables(fmu: Fmu) -> Iterator[Finding]:
    simulation = fmu.interfaces.get("CoSimulation")
    provides = simulation is not None and true(simulation.get("providesIntermediateUpdate"))
    for v in fmu.variables:
        if true(v.own.get("intermediateUpdate")):
            if v.causality in ("parameter", "structuralParameter") or v.type == "Clock":
                message = f"{v.place}: is a {v.causality} of type {v.type} with intermediateUpdate; leave that out"
                yield UPDATE.found(fmu.version, message)
            elif simulation is not None and not provides:
                message = f"{v.place}: has intermediateUpdate, but no update comes; set providesIntermediateUpdate"
                yield UPDATE_UNUSED.found(fmu.version, message)
        if v.flagged("canHandleMultipleSetPerTimeInstant") and v.causality != "input":
            message = f"{v.place}: has canHandleMultipleSetPerTimeInstant but is no input; leave it out"
            yield MULTIPLE_SET.found(fmu.version, message)
