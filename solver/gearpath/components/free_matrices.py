"""Matrices of a structure made fit for its modes: symmetric, semidefinite, with mass, rigid motions known."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.sparse

from ..errors import InputError
from ..numerics.arrays import Real, Sparse
from .rigid_motions import rigid_motions, rounding_of

_SYMMETRIC = 1e-6  # largest skew part, of the largest entry; files print as few as seven digits
_MASSLESS = 1e-12  # eigenvalue of the mass matrix, of the largest
_ROUNDED = 1e-13  # part of an entry: more leaves rigid motions of sparse matrices a resistance that cannot be taken out
_STILL = (2.0 * np.pi * 0.1) ** 2  # (rad/s)^2: what rounding hides below 0.1 Hz is rigid without a question
_STATIC = (2.0 * np.pi * 3e6) ** 2  # w_z^2, (rad/s)^2
_FAR = 100.0 * _STATIC  # the same of sparse coordinates, whose mass moves with the rest as well


@dataclass(frozen=True)
class FreeMatrices:
    """M (n, n) positive definite, K (n, n) with K R = 0."""

    mass: Real | Sparse
    stiffness: Real | Sparse
    rigid_modes: Real  # R (n, r)


def free_matrices(
    mass: Real | Sparse, stiffness: Real | Sparse, ports: Sequence[int] = (), rigid: int | None = None
) -> FreeMatrices:
    """Checks and prepares the matrices (n, n) of a structure, free or held, dense or sparse.

    `rigid` is the number of motions that nothing resists, where the digits of the stiffness cannot tell. `ports` are
    the coordinates that forces act on. Motions Z without mass follow the others statically, Z^T K q = 0.
    What a force on them moves beside that gets the mass K Z (Z^T K Z)^-1 Z^T K / w_z^2: nothing in all motions without
    such a force, and 3e-6 of the compliance at 5 kHz is missing with w_z = 3 MHz. In sparse matrices only coordinates
    of ports get some, K_jj / (10 w_z)^2: the others follow in all vectors of the reduction.
    Raises InputError for matrices that are not symmetric, not semidefinite, of different size, without mass, with
    motions that have neither mass nor stiffness, or sparse, free and printed with few digits.
    """
    M, K = checked("mass", mass), checked("stiffness", stiffness)
    if M.shape != K.shape:
        raise InputError(
            f"mass is {M.shape[0]} x {M.shape[1]} and stiffness {K.shape[0]} x {K.shape[1]}; give equal sizes"
        )
    _check_order(M, K)
    if scipy.sparse.issparse(K) or scipy.sparse.issparse(M):
        K, M = scipy.sparse.csc_array(K), scipy.sparse.csc_array(M)
        M = _with_mass_at_ports(M, K, ports)
        R = _rigid_modes(K, M, rigid)
        if R.shape[1] and rounding_of(K) > _ROUNDED:
            raise InputError(
                f"stiffness: its digits are too few to reduce a free structure of {len(R)} coordinates; export it with "
                "14 digits or more, or as a dense matrix"
            )
        return FreeMatrices(M, K, R)
    values, vectors = scipy.linalg.eigh(M)
    if not values[-1] > 0.0 or values[0] < -_SYMMETRIC * values[-1]:
        raise InputError(f"mass: its lowest eigenvalue {values[0]:.3g} is negative or all are 0; give a mass matrix")
    idle = values <= max(_MASSLESS * values[-1], -2.0 * values[0])  # what printed digits leave of 0 has either sign
    if idle.any():
        M = _symmetric((vectors[:, ~idle] * values[~idle]) @ vectors[:, ~idle].T) + _little(K, vectors[:, idle])
    R = _rigid_modes(K, M, rigid)
    if R.shape[1]:
        P = np.eye(len(M)) - R @ (R.T @ M)  # R is M-orthonormal: takes out what printed digits leave of resistance
        K = _symmetric(P.T @ K @ P)
    return FreeMatrices(M, K, R)


def _check_order(M: Real | Sparse, K: Real | Sparse) -> None:
    """Refuses matrices whose stiffest coordinate would take more than ten seconds for one oscillation."""
    mass, stiff = M.diagonal(), K.diagonal()
    if mass.min() >= 0.0 and 0.0 < (stiff / np.where(mass > 0.0, mass, np.inf)).max() < _STILL:
        raise InputError(
            "stiffness: is so small beside the mass that no coordinate reaches 0.1 Hz; exchange stiffness and mass, or "
            "give both in the same units"
        )


def checked(name: str, matrix: Real | Sparse) -> Real | Sparse:
    """The exactly symmetric part of a square, finite matrix that is symmetric to printed digits."""
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1] or not matrix.shape[0]:
        raise InputError(f"{name}: shape {tuple(matrix.shape)} is not square; give an n x n matrix")
    values = matrix.data if scipy.sparse.issparse(matrix) else matrix
    if not np.isrealobj(values) or not np.isfinite(values).all():
        raise InputError(f"{name}: has entries that are not finite real numbers; export it again")
    largest, skew = abs(matrix).max(), abs(matrix - matrix.T).max()
    if skew > _SYMMETRIC * largest:
        raise InputError(
            f"{name}: is not symmetric, off by {skew / largest:.1g} of its largest entry; give the full matrix, or one "
            "triangle in a format that says so"
        )
    return _symmetric(matrix)


def _symmetric(matrix: Real | Sparse) -> Real | Sparse:
    return (matrix + matrix.T) / 2.0


def _little(K: Real, idle: Real) -> Real:
    """The mass of motions `idle` (n, k) that have none, of what they move beside following the others."""
    push = K @ idle
    try:
        half = scipy.linalg.solve_triangular(scipy.linalg.cholesky(idle.T @ push, lower=True), push.T, lower=True)
    except np.linalg.LinAlgError as error:
        raise InputError(
            f"mass: {idle.shape[1]} motions have no mass and some no stiffness either; take those coordinates out"
        ) from error
    return np.asarray(half.T @ half / _STATIC)


def _with_mass_at_ports(M: Sparse, K: Sparse, ports: Sequence[int]) -> Sparse:
    """A little for single coordinates of a sparse mass matrix, those of ports: on all it would add up to real mass."""
    mass, stiff = M.diagonal(), K.diagonal()
    idle = mass <= _MASSLESS * mass.max()
    loose = np.flatnonzero(idle & (stiff <= 0.0))
    if not mass.max() > 0.0 or len(loose):
        problem = f"coordinate {loose[0]} has neither mass nor stiffness" if len(loose) else "there is none"
        raise InputError(f"mass: {problem}; take such coordinates out")
    at = np.isin(np.arange(len(mass)), ports)
    return scipy.sparse.csc_array(M + scipy.sparse.diags_array(np.where(idle & at, stiff / _FAR, 0.0)))


def _rigid_modes(K: Real | Sparse, M: Real | Sparse, given: int | None) -> Real:
    """The rigid motions of K, M-orthonormal, (n, r): those below its rounding, or the `given` softest of them.

    Raises InputError for a motion that has no mass, where rounding hides motions at frequencies that a structure may
    well have, and for a given number that the stiffness contradicts.
    """
    R = rigid_motions(K)
    if R.shape[1] < (given or 0):
        raise InputError(f"rigid_motions: the stiffness resists all but {R.shape[1]} motions; give this number")
    if not R.shape[1]:
        return R
    G = R.T @ (M @ R)
    scale = np.sqrt(np.maximum(np.diag(G), np.finfo(float).tiny))
    if np.linalg.eigvalsh(G / np.outer(scale, scale))[0] < _MASSLESS:
        raise InputError("mass: there is none in some motion that no stiffness resists; take those coordinates out")
    values, turn = scipy.linalg.eigh(_symmetric(R.T @ (K @ R)), G)
    if given is None and abs(values).max() > _STILL:
        raise InputError(
            f"stiffness: its digits do not tell whether {len(values)} motions of up to "
            f"{np.sqrt(abs(values).max()) / (2.0 * np.pi):.2g} Hz are rigid; give their number as rigid_motions "
            "(6 of a free body, 0 of a held one), or export it with more digits"
        )
    if given is not None and given < len(values) and values[given] <= _STILL:
        found = int((values <= _STILL).sum())
        raise InputError(f"rigid_motions: {given} is given, but {found} motions meet no resistance; give this number")
    return np.asarray(R @ turn[:, : len(values) if given is None else given])
