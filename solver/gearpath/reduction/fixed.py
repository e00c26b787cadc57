"""Reductions with the interface held: Guyan, constraint modes, Lanczos vectors, Craig-Bampton (Eq. 9, 10, 12).

    q = T_c u + N (spins, vectors) eta,     T_c = [I; A],  A = -K_ii^-1 K_ib     with K_ib = (K_bi)^T

The printed Eq. 12 reads the boundary only; the excitation is a row of its own. Beside the boundary all but Guyan keep
the spin d that a mesh's transmission error leaves undone: it is the static response to that error with the ports held.
Without it the error's own motion moves the joints, which cancels in the complete basis only: with 18 vectors the power
ratio of the default gearbox would be up to 19 dB off at low frequency.
"""

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
import scipy.sparse
from numpy.typing import NDArray

from ..components.structure import Structure
from ..errors import InputError
from ..numerics.arrays import Real
from ..numerics.lanczos import BlockLanczos, independent
from .held import Held, hold
from .interface import interface_rows, mesh_spins, port_rows
from .normal_modes import lowest_modes
from .record import Reduction, project


def guyan(structure: Structure, kept: Sequence[int] | NDArray[np.intp]) -> Reduction:
    """Guyan's reduction to the coordinates `kept` (indices): the others follow statically, q_i = A q_b.

    Keep the coordinates that a transmission error moves (p and both gears' uy) beside the ports'. Raises InputError
    for an index out of range or twice, and where the coordinates leave rigid motion free.
    """
    n = int(structure.mass.shape[0])
    wanted = np.asarray(kept, np.intp)
    if wanted.size == 0 or wanted.min() < 0 or wanted.max() >= n or len(np.unique(wanted)) < len(wanted):
        raise InputError(f"kept coordinates {wanted.tolist()} are not distinct indices from 0 to {n - 1}; give such")
    held = hold(structure, scipy.sparse.eye_array(n, format="csr")[np.sort(wanted)])
    if held.boundary > held.given:
        free = held.boundary - held.given
        raise InputError(f"the {len(wanted)} kept coordinates leave {free} rigid-body motions free; keep more of them")
    nothing = np.zeros((len(held.inner), 0))
    return _reduction(held, "Guyan", nothing, nothing)


def constraint_modes(structure: Structure, rows: Any = None, held: Held | None = None) -> Reduction:
    """The static responses to unit motions of the boundary alone: exact at 0 Hz.

    rows (m, n) default to ports and meshes; `held` is a structure held already, whose factor is used again.
    """
    held = held or hold(structure, interface_rows(structure) if rows is None else rows)
    return _reduction(held, "constraint modes", _spins(held), np.zeros((len(held.inner), 0)))


def lanczos(
    structure: Structure,
    vectors: int,
    rows: Any = None,
    start: Literal["block", "mesh"] = "block",
) -> Reduction:
    """Constraint modes and Lanczos vectors of the held interior, the paper's basis Gamma_s (Eq. 10).

    The interior starts from its static response to the mesh forces, then to the inertia forces of the constraint
    modes: K_ii^-1 [F_e, M_ii A + M_ib]. start "mesh" takes the first part only, as the paper does; in a nearly
    symmetric gearbox it misses all antisymmetric motion and stagnates; what more than nine vectors find of it in the
    default gearbox is decided by rounding. rows default to the ports, since the mesh
    response is the first vector. Fewer vectors come back where the Krylov space ends before.
    """
    return LanczosReduction(hold(structure, port_rows(structure) if rows is None else rows), start).take(vectors)


class LanczosReduction:
    """`lanczos` of a held structure with one number of vectors after the other; none is found twice."""

    def __init__(self, held: Held, start: Literal["block", "mesh"] = "block") -> None:
        self._held, self._spins = held, _spins(held)
        mass = held.structure.mass
        loads = [held.load(np.asarray(mass @ mesh_spins(held.structure)))]
        if start == "block":
            loads.append(held.load(mass @ held.constraint_modes))
        first = held.factor.solve(np.hstack(loads))
        self._name = f"Lanczos vectors, {start} start"
        self._vectors = BlockLanczos(lambda x: held.factor.solve(held.mass @ x), held.mass, first, self._spins)

    def take(self, vectors: int) -> Reduction:
        """The reduction by the constraint modes and the first `vectors` vectors."""
        _check_count(vectors)
        return _reduction(self._held, self._name, self._spins, self._vectors.take(vectors).vectors)


def craig_bampton(structure: Structure, vectors: int, rows: Any = None, held: Held | None = None) -> Reduction:
    """Constraint modes and the lowest normal modes of the held interior (Craig and Bampton 1968).

    rows default to ports and meshes: the modes themselves say nothing of the static response to the mesh.
    """
    held = held or hold(structure, interface_rows(structure) if rows is None else rows)
    _check_count(vectors)
    spins = _spins(held)
    modes = lowest_modes(held.factor.matrix, held.mass, held.factor.solve, vectors)
    found = independent(modes, held.mass, spins, held.mass @ spins)  # a mode that the spins already span is dropped
    return _reduction(held, "fixed-interface modes", spins, found)


def _check_count(vectors: int) -> None:
    if vectors < 0:
        raise InputError(f"the number of vectors is {vectors}; give zero or more")


def _spins(held: Held) -> Real:
    """What the constraint modes do not hold of the spins d, M-orthonormal, (n_i, k)."""
    spins = mesh_spins(held.structure)
    inside = held.interior(spins)
    beside = np.linalg.norm(held.embed(inside), axis=0) > 1e-9 * np.linalg.norm(spins, axis=0)
    none = np.zeros((len(held.inner), 0))
    return independent(inside[:, beside], held.mass, none, none)


def _reduction(held: Held, method: str, spins: Real, vectors: Real) -> Reduction:
    basis = np.hstack([held.constraint_modes, held.embed(np.hstack([spins, vectors]))])
    rigid = np.zeros((basis.shape[1], held.structure.rigid_modes.shape[1]))
    rigid[: held.boundary] = held.rows @ held.structure.rigid_modes
    return project(held.structure, method, basis, rigid, held.boundary, vectors.shape[1])
