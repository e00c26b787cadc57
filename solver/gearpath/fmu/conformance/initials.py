"""Which causality, variability and initial go together (FMI 2.0.4, 2.2.7; FMI 3.0.1, 2.4.7.4 and 2.4.7.5)."""

from __future__ import annotations

from collections.abc import Iterator

from .contents import FLOATS, Fmu, Variable
from .finding import Finding, error

COMBINATION = error(
    "variable-combination", "Causality and variability are a combination that exists.", "2.2.7", "2.4.7.4"
)
INITIAL = error("variable-initial", "initial is one that causality and variability allow.", "2.2.7", "2.4.7.5")
CONTINUOUS = error("variable-continuous", "Only floating point variables are continuous.", "2.2.7", "2.4.7.4")
INDEPENDENT = error("variable-independent", "There is one independent variable.", "2.2.7", "2.4.7.4")
INDEPENDENT_TYPE = error(
    "variable-independent-type", "The independent variable is a continuous float, no state.", "2.2.7", "2.4.7.4"
)

_PARAMETERS = ("structuralParameter", "parameter")
_CHANGING = ("discrete", "continuous")
_FREE = ("calculated", "exact", "approx")  # the first of each is the default


def allowed_initials(causality: str, variability: str) -> tuple[str | None, ...] | None:
    """What initial may be, the default first; None where the combination itself does not exist."""
    if causality in _PARAMETERS:
        return ("exact",) if variability in ("fixed", "tunable") else None
    if causality == "calculatedParameter":
        return ("calculated", "approx") if variability in ("fixed", "tunable") else None
    if causality == "input":
        return ("exact",) if variability in _CHANGING else None
    if causality == "independent":
        return (None,) if variability == "continuous" else None
    if variability == "constant":
        return ("exact",)
    if causality == "local" and variability in ("fixed", "tunable"):
        return ("calculated", "approx")
    return _FREE if causality in ("output", "local") and variability in _CHANGING else None


def default_initial(causality: str, variability: str) -> str | None:
    """The value of initial where it is not given."""
    allowed = allowed_initials(causality, variability)
    return allowed[0] if allowed else None


def check(fmu: Fmu) -> Iterator[Finding]:
    """Combinations of all variables, and the independent variable."""
    for variable in fmu.variables:
        yield from _one(fmu, variable)
    times = [v for v in fmu.variables if v.causality == "independent"]
    if len(times) > 1 or (fmu.version == 3 and not times):
        listed = ", ".join(v.name for v in times) or "none"
        message = f"modelDescription.xml has {len(times)} independent variables ({listed}); declare exactly one"
        yield INDEPENDENT.found(fmu.version, message)
    for time in times:
        if time.type not in FLOATS or time.derivative is not None or time.dimensions:
            yield INDEPENDENT_TYPE.found(fmu.version, f"{time.place}: is independent; make it a scalar float")


def _one(fmu: Fmu, v: Variable) -> Iterator[Finding]:
    allowed = allowed_initials(v.causality, v.variability)
    if v.type == "Clock" or v.clocks is not None:
        return
    if v.variability == "continuous" and v.type not in FLOATS:
        message = f"{v.place}: is a continuous {v.type}; make its variability discrete"
        yield CONTINUOUS.found(fmu.version, message)
    if v.causality == "structuralParameter" and fmu.version == 2:
        return  # the schema says so
    if allowed is None:
        message = f"{v.place}: cannot be a {v.variability} {v.causality}; choose a variability that fits"
        yield COMBINATION.found(fmu.version, message)
    elif v.initial_given and (v.initial not in allowed or (fmu.version == 2 and v.causality == "input")):
        wanted = [i for i in allowed if i and not (fmu.version == 2 and v.causality == "input")]
        remedy = f"use {' or '.join(wanted)}" if wanted else "leave it out"
        message = f'{v.place}: initial="{v.initial}" does not fit a {v.variability} {v.causality}; {remedy}'
        yield INITIAL.found(fmu.version, message)
