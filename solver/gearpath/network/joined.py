"""Components that rigid joints hold together become one component of the modal network.

With A q = 0 the rows of the rigid joints on the modal coordinates q of the components, q = T x where A T = 0 and
T^T T = 1, T^T diag(L) T = diag(mu): rigid motions of the joined body first, mu exactly 0, its modes after them.

The motion d of a transmission error e pushes with L d e. Where the joints resist d itself (A d != 0), d' takes its
place with the same force on the joined body, diag(mu) d' = T^T L d; otherwise d' = T^T d, which is the same.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..components.modes import sharpen
from ..errors import AccuracyError, InputError
from ..numerics.arrays import Real
from ..numerics.subspaces import null_space, unit_rows
from .joined_damping import joined_damping
from .joined_losses import joined_losses
from .modal import ModalNetwork
from .records import Load, Output
from .rigid import Group, RigidRows, groups

_RESISTED = 1e-10  # A d beyond this part of |A| |d| is not rounding
_SKEW = 1e-6  # of the modal mass matrix: see components.modes
_REACHED = 1e-9  # of a sum's terms: beyond, a mesh moves an output


def joined(network: ModalNetwork, held: Sequence[RigidRows]) -> ModalNetwork:
    """The network whose rigid joints, given by rows on its modal coordinates, hold.

    Raises InputError for rigid joints of measured components, for components that cannot move at all, and for
    acceleration sensors that would need the derivative of a transmission error.
    """
    if not held:
        return network
    found = groups(held, network.components)
    for group in found:
        _check_measured(network, group)
    parts = [_modes(network, group) for group in found]
    T, mu = np.hstack([shapes for shapes, _ in parts]), np.concatenate([squares for _, squares in parts])
    ends = np.cumsum([shapes.shape[1] for shapes, _ in parts])
    blocks = {
        group.name: slice(int(end) - len(squares), int(end)) for group, (_, squares), end in zip(found, parts, ends)
    }
    shares, dashpots = joined_damping(network, found, T, blocks, mu)
    loss_shares, losses = joined_losses(network, found, T, mu)
    out = replace(
        network,
        components=blocks,
        eigenvalues=mu,
        damping_shares=shares,
        dashpots=dashpots,
        loss_shares=loss_shares,
        joined_losses=losses,
        joints=tuple(replace(j, source=j.source @ T, receiver=j.receiver @ T) for j in network.joints),
        loads=tuple(_load(network, load, held, T, mu) for load in network.loads),
        outputs=tuple(replace(o, row=None if o.row is None else o.row @ T) for o in network.outputs),
    )
    return replace(out, outputs=_observed(out, found))


def _check_measured(network: ModalNetwork, group: Group) -> None:
    for name in group.components:
        if group.joints and name in network.measured:
            raise InputError(
                f"joints.{group.joints[0]}: {name} was measured, and its mobilities cannot be held rigidly; "
                "give a stiff mount or bearing instead"
            )


def _modes(network: ModalNetwork, group: Group) -> tuple[Real, Real]:
    """Columns of T (N, n) and mu (n,) of one group."""
    N = len(network.eigenvalues)
    own = np.concatenate([np.arange(N)[network.components[name]] for name in group.components])
    L = network.eigenvalues[own]
    if not group.joints:
        return np.eye(N)[:, own], L
    shapes, mu = _held_modes(L, group.rows[:, own])
    if not len(mu):
        raise InputError(
            f"joints.{group.joints[0]}: rigid joints leave {group.name} no way to move; "
            "connect its neighbours to the ground instead, and leave it out"
        )
    T = np.zeros((N, len(mu)))
    T[own] = shapes
    return T, mu


def _held_modes(L: Real, A: Real) -> tuple[Real, Real]:
    """Modes x of diag(L) on the null space of A, rigid ones first.

    The singular values of sqrt(L) on that space are the natural frequencies: so the lowest ones keep digits beside
    those of the shortest elements.
    """
    A, rigid = unit_rows(A), np.flatnonzero(L == 0.0)
    kept = null_space(A[:, rigid])
    R = np.zeros((len(L), kept.shape[1]))
    R[rigid] = kept
    free = null_space(np.vstack([A, R.T]))
    if not free.shape[1]:
        return R, np.zeros(R.shape[1])
    right = np.linalg.svd(np.sqrt(L)[:, None] * free, full_matrices=False)[2]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # judged below
        shapes, mu = sharpen(free @ right[::-1].T, np.diag(L), np.eye(len(L)))
    skew = abs(shapes.T @ shapes - np.eye(len(mu))).max()
    if not (skew < _SKEW and mu.min() > 0.0):
        raise AccuracyError("rigid joints connect parts of so different stiffness that their modes drown in rounding")
    order = np.argsort(mu)
    return np.hstack([R, shapes[:, order]]), np.concatenate([np.zeros(R.shape[1]), mu[order]])


def _load(network: ModalNetwork, load: Load, held: Sequence[RigidRows], T: Real, mu: Real) -> Load:
    d = load.mesh_displacement
    if d is None:
        return replace(load, column=load.column @ T)
    A = np.vstack([item.rows for item in held])
    moved = d @ T
    if (abs(A @ d) > _RESISTED * (abs(A) @ abs(d))).any():
        push = (network.eigenvalues * d) @ T
        moved = np.divide(push, mu, out=moved, where=mu > 0.0)
    return replace(load, column=moved, mesh_displacement=moved)


def _observed(network: ModalNetwork, found: Sequence[Group]) -> tuple[Output, ...]:
    """The outputs without accelerations, on joined components, that take the derivative of a transmission error.

    A damped body moves at once with the spin of its gears; alone, a casing does not (`fmu.native.check_network`).
    """
    kept = []
    together = np.zeros(len(network.eigenvalues), bool)
    for group in found:
        together[network.components[group.name]] = bool(group.joints)
    for output in network.outputs:
        if output.quantity != "acceleration" or output.row is None or not _slips(network, output.row * together):
            kept.append(output)
        elif output.name.startswith("sensors."):
            raise InputError(
                f"{output.name}.quantity: the acceleration of what is rigidly joined to gears needs the derivative of "
                "the transmission error; use velocity"
            )
    return tuple(kept)


def _slips(network: ModalNetwork, row: Real) -> bool:
    """Whether damping of any component can make row X d differ from 0."""
    w = np.sqrt(network.eigenvalues)
    moved = [load.mesh_displacement for load in network.loads if load.mesh_displacement is not None]
    for d in moved:
        for name in network.modal_damping:
            terms = row * w * d * network.damping_share(name)
            if abs(terms.sum()) > _REACHED * abs(terms).sum():
                return True
    return False
