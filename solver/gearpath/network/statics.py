"""The machine under its mean load, without its rolling bearings: stiffness in the few coordinates that matter.

Shafts, casing, mounts and other linear joints have the stiffness K and carry the mean tooth forces f; B are the
relative motions of the rolling bearings. Whatever forces the bearings exert, the machine's place lies in the span V of
A^-1 f and A^-1 B^T, A = K + B^T K_0 B with any stiffness K_0 in place of the bearings: as many coordinates as the
bearings have degrees of freedom, and one; this is exact. Rigid joints hold as constraints of A^-1. Motions that meet
no stiffness at all are held: all gears rolling, and a machine that floats, at its casing.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

from ..components import DOFS, GearTrain
from ..components.mean_load import MeanLoad, mean_load
from ..errors import InputError
from ..joints import RIGID
from ..joints.bearings.rolling import RollingBearing
from ..numerics.arrays import Real
from ..numerics.subspaces import null_space, row_space, unit_rows
from .channels import joint_rows
from .measured import fitted_system
from .ports import Ports
from .records import JointRows
from .rigid import rigid_rows
from .system import Operation, System

_HELD, _SAME = 1e-12, 1e-14  # relative stiffness of what nothing holds; directions of V that are the same
_OUTSIDE = 1e-6  # part of a motion's mass outside the gear trains that can hold it


@dataclass(frozen=True)
class Statics:
    """The machine in a few coordinates z, x = V z with V^T A V = 1."""

    stiffness: Real  # (m, m) V^T K V
    load: Real  # (m,) V^T f
    motions: Mapping[str, Real]  # bearing -> (6, m): its relative motion


def load_of(system: System, operation: Operation) -> MeanLoad:
    """Tooth forces and speed ratios; raises InputError where the torque finds no way."""
    train = system.components.get(operation.component)
    if not isinstance(train, GearTrain):
        raise InputError(f"operation: {operation.component!r} is no gear train; name one with a mesh")
    return mean_load(train.meshes, operation.torque, operation.shaft)


def statics(system: System, bearings: Mapping[str, RollingBearing], operation: Operation) -> Statics:
    """The machine without these bearings, under the torque of the operation."""
    names = list(bearings)
    ports = Ports(fitted_system(system))
    rows = {name: joint_rows(ports, name, joint) for name, joint in system.joints.items() if joint.kind != RIGID}
    rigid = row_space(unit_rows(np.vstack([np.zeros((0, ports.size)), *(r.rows for r in rigid_rows(ports, system))])))
    K = scipy.sparse.block_diag([s.stiffness for s in ports.structures.values()], format="csc")
    for name, joint in rows.items():
        if name not in names:
            B = scipy.sparse.csc_array(joint.relative)
            K = K + B.T @ scipy.sparse.csc_array(joint.stiffness) @ B
    motions = {name: _six(rows[name], ports.size) for name in names}
    load = _tooth_forces(ports, system, operation)
    weights = {name: _usual_stiffness(bearings[name], operation) for name in names}
    stacked = np.concatenate([np.sqrt(weights[name])[:, None] * motions[name] for name in names])
    stacked = np.asarray(stacked[stacked.any(axis=1)])
    S = scipy.sparse.csc_array(stacked)
    held = np.hstack([_held(ports, rows, names, stacked, rigid), rigid.T])
    V = _solutions(K + S.T @ S, held, np.column_stack([load, stacked.T]))
    G = V.T @ (K @ V) + (stacked @ V).T @ (stacked @ V)
    size, directions = np.linalg.eigh(0.5 * (G + G.T))
    kept = size > _SAME * size[-1]
    V = V @ (directions[:, kept] / np.sqrt(size[kept]))
    stiffness = V.T @ (K @ V)
    return Statics(0.5 * (stiffness + stiffness.T), V.T @ load, {name: B @ V for name, B in motions.items()})


def _six(joint: JointRows, size: int) -> Real:
    """Relative motion on all six degrees of freedom, (6, n)."""
    out = np.zeros((6, size))
    out[[DOFS.index(dof) for dof in joint.dofs]] = joint.relative
    return out


def _usual_stiffness(bearing: RollingBearing, operation: Operation) -> Real:
    """Stiffness (6,) as one element has it under a force of the mean load's size; rz none."""
    constant, exponent = bearing.scale
    force = max(operation.torque / bearing.lever, 1.0)
    usual = force / (force / constant) ** (1.0 / exponent)
    return np.asarray(usual * np.array([1.0, 1.0, 1.0, bearing.lever**2, bearing.lever**2, 0.0]))


def _tooth_forces(ports: Ports, system: System, operation: Operation) -> Real:
    """The torques on the gears as a load (n,): every mesh then carries its mean tooth force."""
    forces = load_of(system, operation).force
    meshes = ports.structures[operation.component].meshes
    rows = [ports.embed(operation.component, forces[name] * meshes[name].spin) for name in forces]
    return np.asarray(np.sum(rows, axis=0))


def _held(ports: Ports, rows: Mapping[str, JointRows], names: Sequence[str], stacked: Real, rigid: Real) -> Real:
    """Forces (n, r) that hold the rigid motions that no joint and no bearing resists, spread like the mass.

    They act on the casing, as whoever holds a machine does, and on a gear train only where nothing else moves.
    """
    inside, outside, shapes = [], [], []
    for name, structure in ports.structures.items():
        R, M = structure.rigid_modes, structure.mass
        R = R @ np.linalg.inv(np.linalg.cholesky(R.T @ (M @ R))).T
        train = isinstance(ports.system.components[name], GearTrain)
        momentum = ports.embed(name, (M @ R).T).T
        shapes.append(ports.embed(name, R.T).T)
        inside.append(momentum)
        outside.append(0.0 * momentum if train else momentum)
    together = null_space(rigid @ np.hstack(shapes))
    R, at_all, at_casing = (np.hstack(part) @ together for part in (shapes, inside, outside))
    resisted = (stacked @ R).T @ (stacked @ R)
    for name, joint in rows.items():
        if name not in names:
            resisted += (joint.relative @ R).T @ joint.stiffness @ (joint.relative @ R)
    size, directions = np.linalg.eigh(resisted)
    free = directions[:, size <= _HELD * float(size.max(initial=0.0))]
    # of these, in the order of how much of their mass lies outside the gear trains
    share, order = np.linalg.eigh((R @ free).T @ (at_casing @ free))
    chosen = [(at_casing if part > _OUTSIDE else at_all) for part in share]
    return np.array([held @ free @ e for held, e in zip(chosen, order.T)]).reshape(-1, len(R)).T


def _solutions(A: Any, held: Real, right: Real) -> Real:
    """A^-1 right, without the motions that are held."""
    if held.shape[1]:
        side = scipy.sparse.csc_array(held * (float(abs(A).max()) / np.abs(held).max(axis=0)))
        A = scipy.sparse.block_array([[A, side], [side.T, None]])
        right = np.vstack([right, np.zeros((held.shape[1], right.shape[1]))])
    factors = scipy.sparse.linalg.splu(scipy.sparse.csc_array(A))
    solved = factors.solve(right)
    return np.asarray(solved[: len(solved) - held.shape[1]])
