"""The attribute derivative: what is the derivative of what, and which variables are states."""

from __future__ import annotations

import re
from collections.abc import Iterator

from .contents import FLOATS, Fmu, Variable, true
from .finding import Finding, error, warning
from .units import base

TARGET = error("derivative-target", "derivative points to another continuous float.", "2.2.7", "2.4.7.5")
NAMED = error("derivative-name", "The variable named der(x) is the derivative of x.", "2.2.7, 2.2.9", "2.4.7.5")
UNIT = warning(
    "derivative-unit", "The unit of a derivative is the unit of its variable by the second.", "2.2.7", "2.4.7.5"
)
SIZE = error("derivative-size", "A derivative has the dimensions of its variable.", None, "2.4.7.5")
STATE = error("state-causality", "A continuous state is a local variable or an output.", "2.2.7", "2.4.7.4")
SHARED = error("state-shared", "Every state has one derivative in the list.", "2.2.8", "2.4.8")
REINIT = error("reinit", "Only states of model exchange have reinit.", "2.2.7", "2.4.7.5")


def check(fmu: Fmu) -> Iterator[Finding]:
    """All variables with the attribute, then the states."""
    for v in fmu.variables:
        if v.derivative is not None:
            yield from _target(fmu, v, v.derivative)
        elif re.fullmatch(r"der\((.+)\)", v.name) and v.name[4:-1] in fmu.by_name:
            yield NAMED.found(
                fmu.version, f'{v.place}: does not say what it is the derivative of; point to "{v.name[4:-1]}"'
            )
    counted: dict[str, list[Variable]] = {}
    for state in fmu.states:
        if state is not None:
            counted.setdefault(state.name, []).append(state)
    for group in counted.values():
        state = group[0]
        if len(group) > 1:
            message = f"{state.place}: {len(group)} entries of the list of derivatives have it as their state; keep one"
            yield SHARED.found(fmu.version, message)
        if state.causality not in ("local", "output"):
            yield STATE.found(fmu.version, f"{state.place}: is a state and a {state.causality}; make it local")
    for v in fmu.variables:
        if true(v.own.get("reinit")) and v.name not in counted:
            yield REINIT.found(fmu.version, f"{v.place}: has reinit but is no state; leave it out")


def _target(fmu: Fmu, v: Variable, key: int) -> Iterator[Finding]:
    target = fmu.by_key.get(key)
    if target is None or target is v:
        what = "itself" if target is v else f"{key}, which no variable has"
        yield TARGET.found(fmu.version, f"{v.place}: is the derivative of {what}; point to the variable it derives")
        return
    if target.type not in FLOATS or target.type != v.type or target.variability != "continuous":
        message = f'{v.place}: is the derivative of "{target.name}", a {target.variability} {target.type}'
        yield TARGET.found(fmu.version, f"{message}; point to a continuous float")
    named = re.fullmatch(r"der\((.+)\)", v.name)
    if named and named[1] in fmu.by_name and fmu.by_name[named[1]] is not target:
        message = f'{v.place}: is said to be the derivative of "{target.name}"; point to "{named[1]}"'
        yield NAMED.found(fmu.version, message)
    if fmu.size(v) != fmu.size(target):
        message = f'{v.place}: has {fmu.size(v)} elements, and "{target.name}" has {fmu.size(target)}'
        yield SIZE.found(fmu.version, f"{message}; give them one size")
    yield from _unit(fmu, v, target)


def _unit(fmu: Fmu, v: Variable, target: Variable) -> Iterator[Finding]:
    units = {e.get("name"): base(e) for e in fmu.root.iterfind("UnitDefinitions/Unit")}
    own, other = units.get(v.unit), units.get(target.unit)
    if own is None or other is None:
        return
    expected = {**other, "s": other.get("s", 0) - 1}
    if {k: e for k, e in expected.items() if e and k != "rad"} != {k: e for k, e in own.items() if k != "rad"}:
        message = f'{v.place}: has unit "{v.unit}", and "{target.name}", which it derives, has "{target.unit}"'
        yield UNIT.found(fmu.version, f"{message}; correct a unit or point elsewhere")
