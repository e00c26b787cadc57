"""Start, minimum, maximum and nominal values, and the sizes of arrays."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

from .contents import FLOATS, Dimension, Fmu, Variable, real
from .finding import Finding, error

START_MISSING = error(
    "start-missing", "Inputs, parameters, constants and exact variables have a start.", "2.2.7", "2.4.7.5"
)
START_FORBIDDEN = error("start-forbidden", "Calculated and independent variables have no start.", "2.2.7", "2.4.7.5")
START_COUNT = error("start-count", "start has one value, or one for every element of the array.", None, "2.4.7.5")
START_RANGE = error("start-range", "start lies between min and max.", "2.2.7", "2.4.7.5")
MIN_MAX = error("min-max", "min is not above max.", "2.2.3, 2.2.7", "2.4.4")
NOMINAL = error("nominal", "nominal is positive and finite.", "2.2.3, 2.2.7", "2.4.4")
FINITE = error("not-finite", "Values in the XML are finite numbers.", "2.2", "2.4")
ITSELF = error(
    "dimension-reference", "A dimension refers to a structural parameter or constant of type UInt64.", None, "2.4.7.2"
)
SIZE = error("dimension-size", "A dimension has either a size above 0 or a reference.", None, "2.4.7.2")
STRUCTURAL = error("structural-parameter", "A structural parameter is a scalar.", None, "2.4.7.4")

_WHOLE = {f"{sign}Int{bits}": (bits, sign) for bits in (8, 16, 32, 64) for sign in ("", "U")}


def check(fmu: Fmu) -> Iterator[Finding]:
    """Every variable on its own, with the sizes that others give it."""
    for v in fmu.variables:
        if v.type != "Clock":
            yield from _start(fmu, v)
        yield from _bounds(fmu, v)
        for number, dimension in enumerate(v.dimensions, 1):
            yield from _dimension(fmu, v, number, dimension)
        if v.dimensions and v.causality == "structuralParameter":
            yield STRUCTURAL.found(fmu.version, f"{v.place}: is a structural parameter with dimensions; leave them out")


def _start(fmu: Fmu, v: Variable) -> Iterator[Finding]:
    needed = v.causality in ("input", "parameter", "structuralParameter") or v.variability == "constant"
    if v.start is None:
        if needed or v.initial in ("exact", "approx"):
            yield START_MISSING.found(fmu.version, f"{v.place}: has no start value; give one")
        return
    if v.causality == "independent" or (v.initial == "calculated" and not needed):
        what = "is independent" if v.causality == "independent" else "is calculated"
        yield START_FORBIDDEN.found(fmu.version, f"{v.place}: {what} but has a start value; leave it out")
    size = fmu.size(v)
    if fmu.version == 3 and size is not None and len(v.start) not in (1, size):
        message = f"{v.place}: has {len(v.start)} start values for {size} elements; give one or all"
        yield START_COUNT.found(3, message)


def _bounds(fmu: Fmu, v: Variable) -> Iterator[Finding]:
    if v.type in ("String", "Boolean", "Binary", "Clock"):
        return
    low, high, nominal = v.number("min"), v.number("max"), v.number("nominal")
    starts = [x for x in map(real, v.start or ()) if x is not None]
    given = [x for x in (low, high, nominal, *starts) if x is not None]
    if not all(map(isfinite, given)):
        yield FINITE.found(fmu.version, f"{v.place}: start, min, max or nominal is not finite; give a number")
    if low is not None and high is not None and low > high:
        yield MIN_MAX.found(fmu.version, f"{v.place}: min {low:g} is above max {high:g}; exchange them")
    if nominal is not None and v.type in FLOATS and not nominal > 0.0:
        yield NOMINAL.found(fmu.version, f"{v.place}: nominal is {nominal:g}; give a positive size")
    if v.type in _WHOLE:
        bits, sign = _WHOLE[v.type]
        first = 0.0 if sign else -(2.0 ** (bits - 1))
        last = 2.0 ** (bits if sign else bits - 1) - 1.0
        low, high = max(first, low if low is not None else first), min(last, high if high is not None else last)
    outside = [x for x in starts if (low is not None and x < low) or (high is not None and x > high)]
    if outside:
        message = f"{v.place}: start {outside[0]:g} is outside its range {low} to {high}; correct start, min or max"
        yield START_RANGE.found(fmu.version, message)


def _dimension(fmu: Fmu, v: Variable, number: int, dimension: Dimension) -> Iterator[Finding]:
    place = f"{v.place}, dimension {number}"
    if (dimension.start is None) == (dimension.reference is None):
        yield SIZE.found(3, f"{place}: needs either start or valueReference; give one of them")
    if dimension.start is not None and dimension.start <= 0:
        yield SIZE.found(3, f"{place}: has size {dimension.start}; give at least 1")
    if dimension.reference is None:
        return
    holder = fmu.by_key.get(dimension.reference)
    if holder is None:
        yield ITSELF.found(3, f"{place}: refers to valueReference {dimension.reference}, which no variable has")
    elif holder.type != "UInt64" or (holder.causality != "structuralParameter" and holder.variability != "constant"):
        message = f'{place}: refers to "{holder.name}", a {holder.variability} {holder.causality} of type {holder.type}'
        yield ITSELF.found(3, f"{message}; refer to a structural parameter of type UInt64")
    elif holder.start and (real(holder.start[0]) or 0.0) <= 0.0:
        yield SIZE.found(3, f'{place}: its size "{holder.name}" starts at {holder.start[0]}; start above 0')
