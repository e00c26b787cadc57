"""The operating point: where the mean load of the gears puts every rolling bearing, and its stiffness there.

Shafts, casing, mounts and other linear joints have the stiffness K and carry the mean tooth forces f, rolling bearings
the energies U_b of their relative motion q_b = B_b x (inner ring minus outer ring). The static equilibrium

    min over x of   x^T K x / 2 - f^T x + sum U_b(B_b x)

is convex. Contact is unilateral: K alone need not hold the shafts. Newton's method works in the few coordinates of
`statics`.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..components import DOFS
from ..errors import AccuracyError, InputError
from ..joints import Joint
from ..joints.bearings.equilibrium import Equilibrium, state_at
from ..joints.bearings.rolling import Contacts, RollingBearing
from ..joints.mounting import own_state
from ..numerics.arrays import Real
from ..numerics.convex import Look, minimise
from .records import Schedule
from .statics import load_of, statics
from .system import Operation, System

TOLERANCE, ENOUGH = 1e-12, 1e-9  # of the load, in the energy norm of A
_FAR = 0.2  # of a bearing's lever: it comes apart


def operating_point(system: System) -> dict[str, Equilibrium]:
    """The state of every rolling bearing given by its geometry: displacement, load, stiffness and contacts, by joint.

    Raises InputError for a load that the bearings cannot carry and for bearings without any contact.
    """
    found = {name: own_state(joint.mounting) for name, joint in system.joints.items() if joint.mounting}
    waiting = [name for name, state in found.items() if state is None]
    if waiting and system.operation is not None:
        found |= _settle(_with_stiffness(system, found), waiting, system.operation)
    else:
        found |= {name: state_at(_bearing(system, name), np.zeros(6)) for name in waiting}
    speeds = _speeds(system)
    out = {}
    for name, state in found.items():
        assert state is not None
        notes = _notes(system, name, state, speeds)
        out[name] = replace(state, notes=notes)
    return out


def at_operating_point(system: System) -> System:
    """The system with the stiffness of its rolling bearings, and damping that follows it, at the operating point.

    Warns where the bearing theory stops. Raises what `operating_point` does.
    """
    if not any(joint.mounting for joint in system.joints.values()):
        return system
    found = operating_point(system)
    for name, state in found.items():
        for note in state.notes:
            warnings.warn(f"{name}: {note}", stacklevel=2)
    return _with_stiffness(system, found)


def schedule(system: System, torques: Sequence[float]) -> Schedule:
    """Matrices of all bearings that follow the operation, at each of these torques (N m), which must increase.

    Raises InputError for a system without operation or bearings that follow it, and for torques in no order.
    """
    torques = [float(torque) for torque in torques]
    following = {name for name, joint in system.joints.items() if joint.mounting and joint.mounting.follows_operation}
    if system.operation is None or not following:
        raise InputError(
            "schedule: the model has no [operation] with bearings given by geometry or catalogue that follow it"
        )
    if len(torques) < 2 or not np.isfinite(torques).all() or min(np.diff(torques)) <= 0.0 or torques[0] < 0.0:
        raise InputError(f"schedule: {torques} are not at least two torques (N m), finite, not negative and increasing")
    points = [at_operating_point(replace(system, operation=replace(system.operation, torque=t))) for t in torques]
    timed = {name for name in following if _mounting(system, name).damping_time is not None}
    return Schedule(
        np.array(torques),
        {name: np.array([point.joints[name].stiffness for point in points]) for name in sorted(following)},
        {name: np.array([point.joints[name].damping for point in points]) for name in sorted(timed)},
    )


def _with_stiffness(system: System, found: Mapping[str, Equilibrium | None]) -> System:
    joints = {}
    for name, joint in system.joints.items():
        state = found.get(name)
        joints[name] = joint if state is None else _with_matrices(joint, state.stiffness)
    return replace(system, joints=joints)


def _with_matrices(joint: Joint, stiffness: Real) -> Joint:
    picked = [DOFS.index(dof) for dof in joint.dofs]
    K = stiffness[np.ix_(picked, picked)]
    K = 0.5 * (K + K.T)
    matrix = tuple(tuple(row) for row in K.tolist())
    time = joint.mounting.damping_time if joint.mounting else None
    if time is None:
        return replace(joint, stiffness=matrix)
    return replace(joint, stiffness=matrix, damping=tuple(tuple(row) for row in (time * K).tolist()))


def _mounting(system: System, name: str) -> Any:
    mounting = system.joints[name].mounting
    assert mounting is not None
    return mounting


def _bearing(system: System, name: str) -> RollingBearing:
    bearing = _mounting(system, name).bearing
    assert isinstance(bearing, RollingBearing)
    return bearing


def _settle(system: System, names: Sequence[str], operation: Operation) -> dict[str, Equilibrium]:
    """The states of these bearings under the mean load, by Newton's method."""
    bearings = {name: _bearing(system, name) for name in names}
    machine = statics(system, bearings, operation)

    def carried(z: Real) -> tuple[float, Real]:
        energy, load = 0.0, np.zeros(len(z))
        for name, bearing in bearings.items():
            B = machine.motions[name]
            each, force = bearing._potential((B @ z)[None, :5])
            energy, load = energy + float(each[0]), load + B[:5].T @ force[0]
        return energy, load

    start = np.zeros(len(machine.load))
    strength = max(float(np.linalg.norm(machine.load)), float(np.linalg.norm(carried(start)[1])))

    def look(z: Real) -> Look:
        energy, load = carried(z)
        rest = machine.load - machine.stiffness @ z - load
        total = energy + float(0.5 * z @ machine.stiffness @ z - machine.load @ z)
        return Look(total, rest, float(np.linalg.norm(rest)) / (strength or 1.0))

    def hessian(z: Real) -> Real:
        H = machine.stiffness.copy()
        for name, bearing in bearings.items():
            B = machine.motions[name][:5]
            H += B.T @ bearing._stiffness((B @ z)[None])[0] @ B
        return H

    def strain(z: Real) -> dict[str, Real]:
        """Displacements of every bearing over its lever."""
        sizes = {name: np.array([1.0, 1.0, 1.0, b.lever, b.lever, 0.0]) / b.lever for name, b in bearings.items()}
        return {name: np.abs(machine.motions[name] @ z) * sizes[name] for name in names}

    found = minimise(
        look,
        hessian,
        start,
        tolerance=TOLERANCE,
        slack=1e-14 * strength**2,
        lost=lambda z: max(float(part.max()) for part in strain(z).values()) > _FAR,
    )
    if found.residual > ENOUGH:
        raise _failure(operation, strain(found.place), found.residual)
    free = np.array([1.0, 1.0, 1.0, 1.0, 1.0, 0.0])  # how far all gears have rolled says nothing
    places = {name: free * (machine.motions[name] @ found.place) for name in names}
    return {name: state_at(bearings[name], places[name], found.solves, found.residual) for name in names}


def _failure(operation: Operation, strain: Mapping[str, Real], residual: float) -> Exception:
    name = max(strain, key=lambda each: float(strain[each].max()))
    if strain[name].max() > _FAR:
        away = DOFS[int(strain[name].argmax())]
        return InputError(
            f"operation.torque: the bearings cannot carry {operation.torque:g} N m: {name} comes apart along {away}; "
            "take bearings that carry load in that direction, turn one round (mirrored) or add preload"
        )
    where = f"the operating point at {operation.torque:g} N m"
    return AccuracyError(f"{where} was found only to {residual:.1e} of the load")


def _speeds(system: System) -> Mapping[str, float]:
    """Speed of each shaft, rev/min; empty where the operation gives none."""
    operation = system.operation
    if operation is None or operation.speed is None:
        return {}
    ratios = load_of(system, operation).speed
    return {shaft: operation.speed * ratio for shaft, ratio in ratios.items()}


def _notes(system: System, name: str, state: Equilibrium, speeds: Mapping[str, float]) -> tuple[str, ...]:
    if not state.loaded:
        return ("no rolling element carries load, and it has no stiffness; add load or preload",)
    port = system.joints[name].between[0]
    speed = speeds.get(port.shaft or "") if system.operation and port.component == system.operation.component else None
    return tuple(_bearing(system, name).limits(Contacts(state.element_loads, state.contact_angles), speed))
