"""Stiffness that follows the torque: the input, what becomes of the parameters, and what a schedule must be."""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from ..errors import InputError
from ..network.modal import ModalNetwork
from ..network.records import JointRows, Schedule
from ..numerics.arrays import Real
from .dependencies import TORQUE
from .variables import Kind, Variable

MOST_POINTS, LARGEST_TABLE = 1 << 13, 1 << 24  # what the runtime accepts: LARGEST_COUNT, LARGEST_TABLE
_STIFFNESS, _DAMPING = (Kind.STIFFNESS, Kind.STIFFNESS_MATRIX), (Kind.DAMPING, Kind.DAMPING_MATRIX)


def torque_inputs(schedule: Schedule | None) -> Iterable[Variable]:
    """The input operation.torque, where there is a schedule."""
    if schedule is None:
        return
    first, last = float(schedule.torques[0]), float(schedule.torques[-1])
    yield Variable(
        TORQUE,
        Kind.TORQUE,
        (0, 0, 0),
        "input",
        "N.m",
        "Torque through the machine, which decides the stiffness of "
        f"{', '.join(sorted(schedule.stiffness))}; held over a step, and beyond its range taken as its end",
        max(abs(first), abs(last)),
        start=schedule.first,
        minimum=first,
        maximum=last,
    )


def followed(network: ModalNetwork, parameters: Iterable[Variable]) -> list[Variable]:
    """The joints' parameters, of which those that the torque decides are results: local variables without start."""
    schedule, found = network.schedule, []
    for v in parameters:
        name = network.joints[v.index[0]].name
        decided = schedule is not None and (
            (v.kind in _STIFFNESS and name in schedule.stiffness) or (v.kind in _DAMPING and name in schedule.damping)
        )
        text = f"{v.description}; follows {TORQUE}"
        found.append(replace(v, causality="local", start=None, minimum=None, description=text) if decided else v)
    return found


def check_schedule(network: ModalNetwork) -> None:
    """Refuse a schedule that the runtime could not follow.

    Raises:
        InputError: torques that do not increase, a joint that does not exist, or a matrix that cannot be used.
    """
    schedule = network.schedule
    if schedule is None:
        return
    torques, joints = np.asarray(schedule.torques, float), {joint.name: joint for joint in network.joints}
    if torques.ndim != 1 or len(torques) < 2 or not np.isfinite(torques).all() or np.diff(torques).min() <= 0.0:
        raise InputError(f"schedule: {torques.tolist()} are no torques; give at least two, finite and increasing")
    blocks = sum(len(joint.dofs) ** 2 for joint in network.joints)
    if len(torques) > MOST_POINTS or len(torques) * blocks > LARGEST_TABLE:
        most = min(MOST_POINTS, LARGEST_TABLE // blocks)
        raise InputError(f"schedule: {len(torques)} torques are too many for an FMU; give at most {most}")
    if not schedule.stiffness:
        raise InputError("schedule: no joint follows it; name at least one in its stiffness")
    lonely = sorted(set(schedule.damping) - set(schedule.stiffness))
    if lonely:
        raise InputError(f"schedule: {lonely[0]} has scheduled damping, but no stiffness; give both or the latter")
    for what, tables in (("stiffness", schedule.stiffness), ("damping", schedule.damping)):
        for name, table in tables.items():
            if name not in joints:
                raise InputError(f"schedule: there is no joint {name!r}; use one of: {', '.join(joints)}")
            _check_table(joints[name], what, table, torques)


def _check_table(joint: JointRows, what: str, table: Real, torques: Real) -> None:
    size = len(joint.dofs)
    if np.shape(table) != (len(torques), size, size):
        raise InputError(
            f"schedule: {what} of {joint.name} has the shape {np.shape(table)}; "
            f"give a {size} by {size} matrix at each of {len(torques)} torques"
        )
    for torque, matrix in zip(torques, table):
        check_matrix(f"{joint.name}.{what} at {torque:g} N m", matrix)


def check_matrix(name: str, matrix: Real) -> None:
    """Refuse a matrix that is not symmetric and positive semidefinite, each entry in units of the diagonal."""
    if not np.isfinite(matrix).all():
        raise InputError(f"{name}: the matrix holds a number that is not finite; correct it")
    scale = np.abs(matrix).max(initial=0.0)
    if np.abs(matrix - matrix.T).max() > 1e-10 * scale:
        raise InputError(f"{name}: the matrix is not symmetric; make it so")
    # in units of its own diagonal, so that N/m and N m/rad count alike
    unit = np.sqrt(np.where(np.diag(matrix) > 0, np.diag(matrix), 1.0))
    low = np.linalg.eigvalsh(0.5 * (matrix + matrix.T) / np.outer(unit, unit)).min()
    if low < -1e-12 or np.diag(matrix).min() < 0.0:
        raise InputError(f"{name}: the matrix is not positive semidefinite; correct it")
