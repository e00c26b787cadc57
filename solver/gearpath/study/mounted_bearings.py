"""The rolling bearings of a machine at its operating point, and how their stiffness follows load and torque."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from ..errors import InputError
from ..joints.bearings import Equilibrium
from ..joints.mounting import Mounting, own_state
from ..network.operation import operating_point
from ..network.system import System
from .bearings import FINE, SAMPLES, Case, Curve, Phases, curve_over, measure, scaled


def rolling_joints(system: System) -> list[str]:
    """Joints whose bearing is given by geometry or catalogue."""
    return [name for name, joint in system.joints.items() if joint.mounting is not None]


def study_machine(
    system: System, joint: str | None = None, *, phases: bool = False, factors: Sequence[float] = FINE
) -> list[Case]:
    """One case for each rolling bearing of the machine, or for one joint; raises InputError.

    Bearings with a load or displacement of their own have curves over that, those that follow the operation over its
    torque, which loads the whole machine. `phases` turns all cages by the same part of their distances.
    """
    names = rolling_joints(system)
    if not names:
        raise InputError("joints: the model has no bearing given by geometry or catalogue; give a joint one of them")
    if joint is not None and joint not in names:
        raise InputError(f"joint: there is no rolling bearing {joint!r} in the model; there are {', '.join(names)}")
    states = operating_point(system)
    turned = [operating_point(_turned(system, k / SAMPLES)) for k in range(SAMPLES)] if phases else []

    @lru_cache
    def at_torque(factor: float) -> Mapping[str, Equilibrium]:
        assert system.operation is not None
        return operating_point(replace(system, operation=replace(system.operation, torque=factor * torque)))

    torque = system.operation.torque if system.operation else 0.0
    cases = []
    for name in names if joint is None else [joint]:
        mounting = system.joints[name].mounting
        assert mounting is not None
        over, given = _decided_by(mounting, torque if system.operation else None)
        curve = _curve(name, mounting, over, given, at_torque, factors)
        spread = Phases(np.array([each[name].stiffness for each in turned])) if phases else None
        cases.append(Case(name, mounting.bearing, over, given, states[name], "", curve, spread))
    return cases


def _decided_by(mounting: Mounting, torque: float | None) -> tuple[str, Mapping[str, float]]:
    if mounting.load is not None:
        return "load", mounting.load
    if mounting.displacement is not None:
        return "displacement", mounting.displacement
    return ("preload", {}) if torque is None else ("torque", {"torque": torque})


def _curve(
    name: str,
    mounting: Mounting,
    over: str,
    given: Mapping[str, float],
    at_torque: Callable[[float], Mapping[str, Equilibrium]],
    factors: Sequence[float],
) -> Curve | None:
    if not any(given.values()):
        return None  # nothing that could grow
    if over == "torque":
        return curve_over(over, given["torque"], "N m", lambda factor: at_torque(factor)[name], factors)
    size, unit = measure(over, given)

    def own(factor: float) -> Equilibrium:
        grown = scaled(given, factor)
        state = own_state(replace(mounting, load=grown) if over == "load" else replace(mounting, displacement=grown))
        assert state is not None
        return state

    return curve_over(over, size, unit, own, factors)


def _turned(system: System, part: float) -> System:
    """All cages turned on by a part of the distance of two elements."""
    joints = dict(system.joints)
    for name, joint in system.joints.items():
        if joint.mounting is not None:
            mounting = replace(joint.mounting, row=joint.mounting.row._shifted(part))
            joints[name] = replace(joint, mounting=mounting)
    return replace(system, joints=joints)
