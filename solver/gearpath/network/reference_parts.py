"""The structures of the reference solution in physical coordinates, those that rigid joints hold together as one.

Rows A q = 0 of rigid joints give some coordinates by the others, q = N y (QR with column pivoting), so that a joined
structure has the matrices N^T M N and N^T K N, and N^T (eta K) N and N^T C N of loss factors and damping matrices. A
damping ratio, and beside gears everything, is composite: each mode takes the part of the strain energy in a component.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy.linalg
import scipy.sparse
from numpy.typing import NDArray
from scipy.sparse import issparse

from ..components import Measured, Modes, Structure, modes
from ..components.mobility import damping_matrix
from ..errors import AccuracyError
from ..numerics.arrays import Complex, Real
from .assemble import Network
from .records import Load
from .rigid import Group, groups

_RANK, _RESISTED = 1e-9, 1e-10  # pivots of rows that repeat others; A d beyond this part of |A| |d| is not rounding


@dataclass(frozen=True)
class Part:
    """A structure that moves as one: its matrices, and its place among all coordinates."""

    structure: Structure  # M, K and rigid modes in its own coordinates y
    damping: Any  # C
    hysteresis: Any  # what loss factors add to K, imaginary
    motion: Any  # (n, m), sparse: q = motion @ y
    rows: Real  # A (c, n), of the rigid joints in it
    free: NDArray[np.intp]  # (m,): which of the coordinates q the y are
    modes: Modes | None = None  # where rigid joints hold it and all its modes are known


def reference_parts(network: Network) -> list[Part]:
    """Every component, and those that rigid joints hold together as one.

    Raises AccuracyError where the damping has no matrix: modal damping of a plate or frame, and different damping of
    parts that are rigidly joined to one.
    """
    found = groups(network.rigid, network.structures)
    return [_joined(network, group) if group.joints else _single(network, group.components[0]) for group in found]


def measured_parts(network: Network, parts: Sequence[Part], omega: Real) -> dict[int, Complex]:
    """Receptances Y / (i w) (m, m, F) of measured components, by the place of their part: none is joined rigidly."""
    return {
        k: item.at(omega) / (1j * omega)
        for name, item in network.system.components.items()
        if isinstance(item, Measured)
        for k, part in enumerate(parts)
        if part.motion[network.blocks[name]].nnz
    }


def massless(part: Part) -> Part:
    """The part with the unit matrix as its stiffness, and nothing else: its rows are those of u itself."""
    s = part.structure
    return replace(part, structure=replace(s, mass=0.0 * s.mass, stiffness=s.mass, rigid_modes=s.rigid_modes[:, :0]))


def load_of(network: Network, parts: Sequence[Part], load: Load) -> Load:
    """A load in the coordinates of all parts; its d is one that the rigid joints allow, with the same force K d."""
    N = scipy.sparse.hstack([part.motion for part in parts], format="csc")
    column, d = N.T @ load.column, load.mesh_displacement
    if d is None:
        return replace(load, column=column)
    allowed = np.concatenate([_allowed(network, part, d) for part in parts])
    momentum = [part.structure.mass @ y for part, y in zip(parts, _split(parts, allowed))]
    return replace(load, column=np.concatenate(momentum), mesh_displacement=allowed)


def _split(parts: Sequence[Part], y: Real) -> list[Real]:
    return np.split(y, np.cumsum([part.motion.shape[1] for part in parts])[:-1])


def _allowed(network: Network, part: Part, d: Real) -> Real:
    """The motion d of a transmission error in the coordinates y of a part."""
    if (abs(part.rows @ d) <= _RESISTED * (abs(part.rows) @ abs(d))).all():
        return d[part.free]
    if part.modes is None:
        raise AccuracyError("a transmission error against a rigid joint has no reference beside plates and frames")
    K = scipy.sparse.block_diag([s.stiffness for s in network.structures.values()], format="csc")
    push = part.modes.shapes.T @ (part.motion.T @ (K @ d))
    L = part.modes.eigenvalues
    return np.asarray(part.modes.shapes @ np.divide(push, L, out=np.zeros_like(push), where=L > 0.0))


def _single(network: Network, name: str) -> Part:
    structure, size = network.structures[name], sum(s.size for s in network.structures.values())
    unit = scipy.sparse.eye_array(size, format="csc")[:, network.blocks[name]]
    C, H = damping_matrix(structure), structure.loss_factor * structure.stiffness
    return Part(structure, C, H, unit, np.zeros((0, size)), np.arange(size)[network.blocks[name]])


def _joined(network: Network, group: Group) -> Part:
    own = [network.structures[name] for name in group.components]
    place = np.concatenate([np.arange(group.rows.shape[1])[network.blocks[name]] for name in group.components])
    A = group.rows[:, place]
    N, free = _independent(A)
    M, K = (scipy.sparse.block_diag([getattr(s, name) for s in own], format="csc") for name in ("mass", "stiffness"))
    R = scipy.linalg.block_diag(*(s.rigid_modes for s in own))
    R = R / np.sqrt(np.einsum("ij,ij->j", R, M @ R))
    R = R @ scipy.linalg.null_space(A @ R, rcond=_RANK)
    joined = Structure(N.T @ M @ N, N.T @ K @ N, R[free], 0.0, {})
    place_of = scipy.sparse.eye_array(group.rows.shape[1], format="csc")[:, place]
    gears = any(d[place].any() for d in (load.mesh_displacement for load in network.loads) if d is not None)
    if any(issparse(s.mass) for s in own):
        _check_sparse(own, gears)
        return Part(joined, 0.0 * joined.mass, _losses(own, N), place_of @ N, group.rows, place[free])
    joined = replace(joined, mass=joined.mass.toarray(), stiffness=joined.stiffness.toarray())  # type: ignore[union-attr]
    basis = modes(joined)
    C, H = _composite(own, np.asarray(N @ basis.shapes), joined.mass @ basis.shapes, basis.eigenvalues, gears)
    if not gears:
        C, H = C + _matrices(own, N), _losses(own, N).toarray()
    return Part(joined, C, H, place_of @ N, group.rows, place[free], basis)


def _losses(own: Sequence[Structure], N: Any) -> Any:
    """N^T diag(eta_c K_c) N, sparse."""
    return N.T @ scipy.sparse.block_diag([s.loss_factor * s.stiffness for s in own], format="csc") @ N


def _matrices(own: Sequence[Structure], N: Any) -> Real:
    """N^T C N of the components whose damping is a matrix of its own."""
    blocks = [0.0 * s.mass if s.damping_ratios is None else damping_matrix(s) for s in own]
    return np.asarray((N.T @ scipy.sparse.block_diag(blocks, format="csc") @ N).toarray())


def _independent(A: Real) -> tuple[Any, NDArray[np.intp]]:
    """N (n, m), sparse, of q = N y with A N = 0, and which coordinates of q the y are."""
    A = A / np.maximum(np.linalg.norm(A, axis=1), np.finfo(float).tiny)[:, None]
    touched = np.flatnonzero(A.any(axis=0))
    factor, order = scipy.linalg.qr(A[:, touched], mode="r", pivoting=True)
    pivots = abs(np.diag(factor))
    rank = int((pivots > _RANK * pivots[0]).sum())
    follow, lead = touched[order[:rank]], touched[order[rank:]]
    free = np.setdiff1d(np.arange(A.shape[1]), follow)
    N = scipy.sparse.lil_array((A.shape[1], len(free)))
    N[free, np.arange(len(free))] = 1.0
    ratios = -scipy.linalg.solve_triangular(factor[:rank, :rank], factor[:rank, rank:])
    for row, values in zip(follow, ratios):
        N[[row], np.searchsorted(free, lead)] = values
    return scipy.sparse.csc_array(N), free


def _check_sparse(own: Sequence[Structure], gears: bool) -> None:
    elastic = [s for s in own if s.size > s.rigid_modes.shape[1]]
    if (gears and len({s.loss_factor for s in elastic}) > 1) or any(s.modal_damping for s in elastic):
        raise AccuracyError(
            "the damping of plates and frames in rigid joints has no matrix, for not all of their modes are known, "
            "where it is modal damping, or where loss factors differ and gears are among them; give all one loss_factor"
        )


def _composite(
    own: Sequence[Structure], shapes: Real, momentum: Real, eigenvalues: Real, gears: bool
) -> tuple[Real, Real]:
    """C and eta K of the joined structure, from the strain energy of each component in each of its modes.

    Ratios of single modes are among them beside gears only: otherwise `_matrices` has them.
    """
    ratios, factors, start = np.zeros_like(eigenvalues), np.zeros_like(eigenvalues), 0
    for s in own:
        part = shapes[start : start + s.size]
        zeta = np.full(s.size, s.modal_damping) if s.damping_ratios is None else s.damping_ratios * gears
        for target, factor in ((ratios, zeta), (factors, np.full(s.size, s.loss_factor))):
            energy = np.einsum("ir,i,ir->r", part, factor, s.stiffness @ part)
            target += np.divide(energy, eigenvalues, out=np.zeros_like(energy), where=eigenvalues > 0.0)
        start += s.size
    damping = 2.0 * ratios * np.sqrt(eigenvalues)
    return momentum * damping @ momentum.T, momentum * (factors * eigenvalues) @ momentum.T
