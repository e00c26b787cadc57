"""Matrices of a structure made fit for its modes: symmetric, semidefinite, with mass, rigid motions known."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.sparse

from ..errors import InputError
from ..numerics.arrays import Real, Sparse
from .massless import STATIC_HZ, condensed
from .rigid_motions import resistance, rigid_motions, rounding_of, rounding_resistance

_SYMMETRIC = 1e-6  # largest skew part, of the largest entry; files print as few as seven digits
_MASSLESS = 1e-12  # eigenvalue of the mass matrix, of the largest
_ROUNDED = 1e-13  # part of an entry: more leaves rigid motions of sparse matrices a resistance that cannot be taken out
_STILL = (2.0 * np.pi * 0.1) ** 2  # (rad/s)^2: what rounding hides below 0.1 Hz is rigid without a question
_BEYOND = (2.0 * np.pi * 1e9) ** 2  # (rad/s)^2
_COARSE = 1e-8  # part of an entry: rounded by more, motions that it may hide are asked for below 0.1 Hz too
_FAR = (2.0 * np.pi * 10.0 * STATIC_HZ) ** 2  # (rad/s)^2, of sparse coordinates, whose mass moves with the rest as well


@dataclass(frozen=True)
class FreeMatrices:
    """M (N, N) positive definite, K (N, N) with K R = 0."""

    mass: Real | Sparse
    stiffness: Real | Sparse
    rigid_modes: Real  # R (N, r)
    motion: Real | None = None  # (n, N), of the given coordinates; None where they are the coordinates themselves


def free_matrices(
    mass: Real | Sparse, stiffness: Real | Sparse, ports: Sequence[int] = (), rigid: int | None = None
) -> FreeMatrices:
    """Checks and prepares the matrices (n, n) of a structure, free or held, dense or sparse.

    `rigid` is the number of motions that nothing resists, where the digits of the stiffness cannot tell. `ports` are
    the coordinates that forces act on. Motions without mass are taken out of dense matrices (`condensed`). In sparse
    ones only coordinates of ports get a little mass, K_jj / (10 w_z)^2 with w_z = 3 MHz: the others follow in all
    vectors of the reduction.
    Raises InputError for matrices that are not symmetric, not semidefinite, without mass, with motions that have
    neither mass nor stiffness, or sparse, free and printed with few digits.
    """
    M, K = checked("mass", mass), checked("stiffness", stiffness)
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
        M = _symmetric((vectors[:, ~idle] * values[~idle]) @ vectors[:, ~idle].T)
    R = _rigid_modes(K, M, rigid)
    if R.shape[1]:
        P = np.eye(len(M)) - R @ (R.T @ M)  # R is M-orthonormal: takes out what printed digits leave of resistance
        K = _symmetric(P.T @ K @ P)
    if not idle.any():
        return FreeMatrices(M, K, R)
    massive = vectors[:, ~idle]
    K, motion = condensed(K, massive, vectors[:, idle], ports)
    added = len(K) - massive.shape[1]
    M = np.diag(np.concatenate([values[~idle], np.ones(added)]))
    return FreeMatrices(M, K, np.vstack([massive.T @ R, np.zeros((added, R.shape[1]))]), motion)


def _check_order(M: Real | Sparse, K: Real | Sparse) -> None:
    """Refuses matrices whose coordinates would all take more than ten seconds, or less than 1 ns, for one oscillation.

    Each by itself, the others held.
    """
    mass, stiff = M.diagonal(), K.diagonal()
    both = (mass > 0.0) & (stiff > 0.0)
    if mass.min() < 0.0 or not both.any():
        return
    with np.errstate(over="ignore"):
        squares = stiff[both] / mass[both]
    if squares.max() < _STILL or squares.min() > _BEYOND:
        what = "small beside the mass that no coordinate reaches 0.1 Hz"
        if squares.min() > _BEYOND:
            what = "large beside the mass that no coordinate is below 1 GHz"
        raise InputError(f"stiffness: is so {what}; exchange stiffness and mass, or give both in the same units")


def checked(name: str, matrix: Real | Sparse) -> Real | Sparse:
    """The exactly symmetric part of a square matrix that is finite, and symmetric to printed digits."""
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
    R = rigid_motions(K, given)
    if not R.shape[1]:
        return R
    G = R.T @ (M @ R)
    scale = np.sqrt(np.maximum(np.diag(G), np.finfo(float).tiny))
    if np.linalg.eigvalsh(G / np.outer(scale, scale))[0] < _MASSLESS:
        raise InputError("mass: there is none in some motion that no stiffness resists; take those coordinates out")
    values, turn = scipy.linalg.eigh(_symmetric(R.T @ (K @ R)), G)
    R = np.asarray(R @ turn)
    free = (resistance(K, R) <= 3.0 * rounding_resistance(K, R)) & (values <= _STILL)  # in double precision
    if given is not None:
        if free[given:].any():
            raise InputError(
                f"rigid_motions: {given} is given, but {int(free.sum())} motions or more meet no resistance; "
                "give their number, or export the stiffness with more digits"
            )
        return R[:, :given]
    if abs(values).max() > _STILL or (not free.all() and rounding_of(K) > _COARSE):
        raise InputError(
            f"stiffness: its digits do not tell whether {len(values)} motions of up to "
            f"{np.sqrt(abs(values).max()) / (2.0 * np.pi):.2g} Hz are rigid; give their number as rigid_motions "
            "(6 of a free body, 0 of a held one), or export it with more digits"
        )
    return R
