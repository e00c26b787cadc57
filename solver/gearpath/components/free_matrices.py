"""Matrices of a structure made fit for its modes: symmetric, semidefinite, with mass, rigid motions known."""

import warnings
from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.sparse
import scipy.sparse.linalg

from ..errors import InputError
from ..numerics.arrays import Real, Sparse

_SYMMETRIC = 1e-6  # largest skew part, of the largest entry; files print as few as seven digits
_MASSLESS = 1e-12  # eigenvalue of the mass matrix, of the largest
_STATIC = (2.0 * np.pi * 3e6) ** 2  # w_z^2, (rad/s)^2
_FAR = 100.0 * _STATIC  # of sparse coordinates, which have this mass in all motions
_SHIFT = (2.0 * np.pi) ** 2  # (rad/s)^2: 1 Hz, far below what a machine part vibrates at
_RIGID = 1e-3 * _SHIFT  # (rad/s)^2: below 0.03 Hz a motion is rigid
_MOST = 8  # motions looked at; a structure has six, a mechanism more
_RESIDUAL = 1e-5  # |K R| / |K||R|: above, a motion said to be rigid deforms the structure


@dataclass(frozen=True)
class FreeMatrices:
    """M (n, n) positive definite, K (n, n) with K R = 0."""

    mass: Real | Sparse
    stiffness: Real | Sparse
    rigid_modes: Real  # R (n, r)


def free_matrices(mass: Real | Sparse, stiffness: Real | Sparse) -> FreeMatrices:
    """Checks and prepares the matrices (n, n) of a structure, free or held, dense or sparse.

    Motions Z without mass follow the others statically, Z^T K q = 0. What a force on them moves beside that gets the
    mass K Z (Z^T K Z)^-1 Z^T K / w_z^2: nothing in all motions without such a force, and 3e-6 of the compliance at
    5 kHz is missing with w_z = 3 MHz. Raises InputError for matrices that are not symmetric, not semidefinite, of
    different size, without mass, or with motions that have neither mass nor stiffness.
    """
    M, K = checked("mass", mass), checked("stiffness", stiffness)
    if M.shape != K.shape:
        raise InputError(
            f"mass is {M.shape[0]} x {M.shape[1]} and stiffness {K.shape[0]} x {K.shape[1]}; give equal sizes"
        )
    if scipy.sparse.issparse(K) or scipy.sparse.issparse(M):
        K, M = scipy.sparse.csc_array(K), scipy.sparse.csc_array(M)
        M = _with_mass_everywhere(M, K)
        return FreeMatrices(M, K, _rigid_modes(K, M))
    values, vectors = scipy.linalg.eigh(M)
    if not values[-1] > 0.0 or values[0] < -_SYMMETRIC * values[-1]:
        raise InputError(f"mass: its lowest eigenvalue {values[0]:.3g} is negative or all are 0; give a mass matrix")
    idle = values <= _MASSLESS * values[-1]
    if idle.any():
        M = M + _little(K, vectors[:, idle])
    R = _rigid_modes(K, M)
    if R.shape[1]:
        P = np.eye(len(M)) - R @ (R.T @ M)  # R is M-orthonormal: takes out what printed digits leave of resistance
        K = _symmetric(P.T @ K @ P)
    return FreeMatrices(M, K, R)


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


def _with_mass_everywhere(M: Sparse, K: Sparse) -> Sparse:
    """Single coordinates of a sparse mass matrix that have none get so little that they vibrate above 30 MHz."""
    mass, stiff = M.diagonal(), K.diagonal()
    idle = mass <= _MASSLESS * mass.max()
    if (stiff[idle] <= 0.0).any():
        count = int(idle.sum())
        raise InputError(f"mass: {count} coordinates have no mass and some no stiffness either; take them out")
    return scipy.sparse.csc_array(M + scipy.sparse.diags_array(np.where(idle, stiff / _FAR, 0.0)))


def _rigid_modes(K: Real | Sparse, M: Real | Sparse) -> Real:
    """Motions without deformation, M-orthonormal, (n, r). Raises InputError where K is negative in some motion."""
    n = int(K.shape[0])
    if scipy.sparse.issparse(K):
        values, vectors = _lowest(K, M)
    else:
        values, vectors = scipy.linalg.eigh(K, M)
    limit = max(_RIGID, 1e3 * np.finfo(float).eps * float(abs(values).max()))
    if values[0] < -limit:
        raise InputError(
            f"stiffness: is negative in some motion (eigenvalue {values[0]:.3g} (rad/s)^2); give the stiffness of an "
            "unloaded structure"
        )
    R = np.asarray(vectors[:, values < limit])
    if R.shape[1] > min(_MOST - 1, n - 1):
        raise InputError(
            f"stiffness: {R.shape[1]} motions or more do not deform it; connect its parts, or mend the units"
        )
    if R.shape[1]:
        residual = float((abs(K @ R).max(axis=0) / (abs(K) @ abs(R)).max(axis=0)).max())
        if residual > _RESIDUAL:
            warnings.warn(
                f"stiffness: its rigid motions deform it, by {residual:.1g} of its largest forces", stacklevel=2
            )
    return R


def _lowest(K: Sparse, M: Sparse) -> tuple[Real, Real]:
    """The lowest modes of a sparse structure, ascending, by Lanczos about -1 Hz."""
    n = int(K.shape[0])
    count = min(_MOST, n - 2)
    start = np.cos(1.0 + np.arange(n) ** 2 % 7919)
    shifted = scipy.sparse.csc_array(K + _SHIFT * M)
    try:
        factor = scipy.sparse.linalg.splu(
            shifted, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True, "Equil": False}
        )
    except RuntimeError as error:
        raise InputError("mass, stiffness: some coordinates have neither; take them out") from error
    inverse = scipy.sparse.linalg.LinearOperator((n, n), matvec=factor.solve)
    values, vectors = scipy.sparse.linalg.eigsh(K, count, M=M, sigma=-_SHIFT, OPinv=inverse, v0=start, tol=1e-12)
    order = np.argsort(values)
    values, vectors = values[order], vectors[:, order]
    rigid = values < _RIGID
    for _ in range(2):  # inverse iteration: what is left of elastic modes shrinks by 1 Hz over theirs, squared
        sharper = np.column_stack([factor.solve(column) for column in (M @ vectors[:, rigid]).T] or [np.zeros((n, 0))])
        vectors[:, rigid] = (
            sharper @ scipy.linalg.inv(scipy.linalg.cholesky(sharper.T @ (M @ sharper))) if rigid.any() else sharper
        )
    return values, vectors
