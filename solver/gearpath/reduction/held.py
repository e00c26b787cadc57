"""A structure held at its boundary: interior matrices, constraint modes and the factor of the interior stiffness.

The boundary is what chosen rows L (m, n) read, u = L q. Rows need not be single coordinates (a port on a footprint
reads the mean motion of many, a gear mesh the common spin of two shafts), so the coordinates are changed first,

    q = S u + N x,    L S = I,    L N = 0,

with as many pivot coordinates eliminated as there are rows. For rows that are single coordinates this is the
partition of Eq. 9 itself; for others K_ii = N^T K N fills in only where one row couples coordinates. Compared with the
bordered system [K L^T; L 0] the matrix stays positive definite, so that the factor needs no pivoting, and the
boundary stays a set of coordinates that joints can take hold of.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
import scipy.sparse

from ..components.structure import Structure
from ..errors import InputError
from ..numerics.arrays import Real
from .factor import Factor

_DEPENDENT = 1e-9  # rows and rigid motions closer than this to others of their kind are combinations of them


@dataclass(frozen=True)
class Held:
    """The structure with its boundary held; m boundary coordinates, n - m interior ones."""

    structure: Structure
    rows: Any  # L (m, n), sparse: independent rows, then single coordinates that hold the remaining rigid motion
    given: int  # how many of the rows come from the caller
    to_interior: Any  # N (n, n - m), sparse
    inner: "np.ndarray[tuple[int], np.dtype[np.intp]]"  # (n - m,): the coordinates that x consists of
    factor: Factor  # of K_ii = N^T K N
    mass: Any  # M_ii = N^T M N, sparse
    constraint_modes: Real  # T_c = S + N A, A = -K_ii^-1 K_ib (Eq. 10), (n, m)

    @property
    def boundary(self) -> int:
        """Number of boundary coordinates m."""
        return int(self.rows.shape[0])

    def interior(self, motion: Real) -> Real:
        """What the constraint modes leave of a motion (n, k), in interior coordinates (n - m, k)."""
        return np.asarray((motion - self.constraint_modes @ (self.rows @ motion))[self.inner])

    def load(self, force: Real) -> Real:
        """Interior force N^T f of a force (n, k)."""
        return np.asarray(self.to_interior.T @ force)

    def embed(self, interior: Real) -> Real:
        """Motion N x of interior coordinates (n - m, k), (n, k)."""
        return np.asarray(self.to_interior @ interior)


def hold(structure: Structure, rows: Any) -> Held:
    """Hold a structure at what `rows` (m, n; dense or sparse) read.

    Rows that are zero or depend on others are dropped. Where the rows leave rigid motion free (gear spin beside
    bearings without rotation about the shaft), K_ii would be singular: as many single coordinates as needed, those
    that move most, join the boundary. Raises InputError for rows of the wrong width and AccuracyError where the
    structure can still move without deforming (a motion that it does not declare).
    """
    n = int(structure.mass.shape[0])
    L = scipy.sparse.csr_array(rows)
    if L.shape[1] != n:
        raise InputError(f"boundary rows have {L.shape[1]} columns for a structure of {n} coordinates; give {n}")
    L = L[_independent_rows(L)]
    given = int(L.shape[0])
    L = scipy.sparse.csr_array(scipy.sparse.vstack([L, _unit_rows(_free_coordinates(structure, L), n)]))
    S, N, inner = _change_of_coordinates(L)
    K, M = scipy.sparse.csc_array(structure.stiffness), scipy.sparse.csc_array(structure.mass)
    factor = Factor(N.T @ K @ N)
    coupling = (N.T @ K @ S).toarray()
    T = S.toarray() - N @ factor.solve(coupling)
    # rigid-body motion, known exactly, replaces what the solve found of it: A R_b = R_i to rounding
    R = np.asarray(structure.rigid_modes)
    seen = L @ R
    T += N @ ((R - T @ seen)[inner] @ scipy.linalg.pinv(seen))
    return Held(structure, L, given, N, inner, factor, scipy.sparse.csc_array(N.T @ M @ N), T)


def _independent_rows(L: Any) -> Any:
    """Indices of a largest set of independent rows, ascending; pivoted QR of the rows at unit length."""
    length = np.sqrt(np.asarray(L.multiply(L).sum(axis=1)).ravel())
    used = np.flatnonzero(length)
    if not len(used):
        return used
    B = L[used] / length[used, None]
    return np.sort(used[_independent_columns(_touched(B)[1].T)])


def _independent_columns(B: Real) -> Any:
    """Indices of independent columns of B, most independent first."""
    R, order = scipy.linalg.qr(B, mode="r", pivoting=True)
    diagonal = abs(np.diag(R))
    return order[: np.count_nonzero(diagonal > _DEPENDENT * diagonal.max(initial=0.0))]


def _touched(L: Any) -> tuple[Any, Real]:
    """Columns with entries, and the rows on them as a dense array."""
    L = scipy.sparse.csc_array(L)
    columns = np.flatnonzero(np.diff(L.indptr))
    return columns, np.asarray(L[:, columns].toarray())


def _free_coordinates(structure: Structure, L: Any) -> Any:
    """Coordinates that hold what rigid motion the rows leave: those that move most in it."""
    R = np.asarray(structure.rigid_modes, float)
    R = R / np.linalg.norm(R, axis=0)
    if not R.shape[1]:
        return np.zeros(0, np.intp)
    seen = L @ R
    reach = np.sqrt(np.asarray(L.multiply(L).sum(axis=1)).ravel()) * abs(R).max()
    free = scipy.linalg.null_space(seen / reach[:, None], rcond=_DEPENDENT) if len(seen) else np.eye(R.shape[1])
    return _independent_columns((R @ free).T) if free.shape[1] else np.zeros(0, np.intp)


def _unit_rows(coordinates: Any, n: int) -> Any:
    return scipy.sparse.eye_array(n, format="csr")[coordinates]


def _change_of_coordinates(L: Any) -> tuple[Any, Any, Any]:
    """S (n, m), N (n, n - m) and the coordinates that x keeps."""
    m, n = L.shape
    if not m:
        return scipy.sparse.csc_array((n, 0)), scipy.sparse.eye_array(n, format="csc"), np.arange(n)
    columns, B = _touched(L)
    pivots = columns[_independent_columns(B)]
    inner = np.setdiff1d(np.arange(n), pivots)
    solved = np.linalg.inv(L[:, pivots].toarray())
    S = scipy.sparse.csc_array((solved.ravel(), (np.repeat(pivots, m), np.tile(np.arange(m), m))), shape=(n, m))
    rest = scipy.sparse.coo_array(-scipy.sparse.csr_array(solved) @ L[:, inner])
    entries = np.concatenate([np.ones(n - m), rest.data])
    at = np.concatenate([inner, pivots[rest.row]]), np.concatenate([np.arange(n - m), rest.col])
    return S, scipy.sparse.csc_array((entries, at), shape=(n, n - m)), inner
