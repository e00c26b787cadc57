"""Motions that a stiffness matrix does not resist, told from those that it resists a little."""

from typing import Any

import numpy as np
import scipy.linalg
import scipy.sparse
import scipy.sparse.linalg

from ..errors import InputError
from ..numerics.arrays import Real, Sparse

ROUNDING = 1e-15  # part of an entry by which an assembled matrix kept in double precision is rounded
_SINGLE = 3e-8  # the same, of one kept in single precision
_PRINTED = range(6, 15)  # significant digits of matrices that were printed; fewer are round numbers, and exact
_CLEAR = 3.0  # a motion is certainly resisted beyond so many times what rounding makes
_SHIFT = 1e-9  # of the diagonal, that keeps the factors of a singular matrix finite
_SMALL = 200  # coordinates of a sparse matrix that is treated as dense
_MOST = 48  # motions looked for in a sparse matrix


def rigid_motions(stiffness: Real | Sparse, given: int | None = None) -> Real:
    """A basis (n, r) of the null space of K (n, n), dense or sparse, as far as the digits of its entries tell.

    Where the number of rigid motions is `given`, all that may be rigid: `given` of them and what the digits hide.

    With a unit diagonal, v^T K v = nu of an eigenvector. Entries rounded by the part d of themselves make a resistance
    up to d |v|^T |K| |v| where there is none: a motion that meets no more is rigid. d is that of double or single
    precision, or of the digits that all entries were printed with. No mass is needed, and a structure that is held
    softly keeps its resistance. Raises InputError where K is negative in some motion, where motions lie between rigid
    and resisted and no number is given, where more are given, and where 48 and more of a sparse structure are rigid.
    """
    diagonal = stiffness.diagonal()
    if diagonal.min() < 0.0:
        k = int(np.argmin(diagonal))
        raise InputError(
            f"stiffness: is negative in some motion (entry [{k},{k}] is {diagonal[k]:.3g}); give the stiffness of an "
            "unloaded structure"
        )
    scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    scaled, precision = _scaled(stiffness, scale), rounding_of(stiffness)
    values, vectors = _softest(scaled, max(_SHIFT, 10.0 * precision))
    limit = rounding_resistance(scaled, vectors, precision)
    soft = values < 10.0 * _CLEAR * limit
    values[soft] = resistance(stiffness, scale[:, None] * vectors[:, soft])
    if (values < -_CLEAR * limit).any():
        raise InputError(
            f"stiffness: is negative in some motion (eigenvalue {values.min():.2g} with a unit diagonal); "
            "give the stiffness of an unloaded structure"
        )
    rigid, doubtful = values <= limit, values <= _CLEAR * limit
    if given is not None:
        rigid = doubtful
        if rigid.sum() < given:
            raise InputError(
                f"rigid_motions: {given} is given, but the stiffness resists all but {int(rigid.sum())} motions; "
                "give this number"
            )
    elif (doubtful & ~rigid).any():
        raise InputError(
            f"stiffness: {int((doubtful & ~rigid).sum())} motions beside {int(rigid.sum())} rigid ones meet hardly "
            f"more resistance than entries rounded by {precision:.1g} of themselves make; give the number of motions "
            "that nothing resists as rigid_motions (6 of a free body, 0 of a held one), or export it with more digits"
        )
    if rigid.all() and len(values) < int(stiffness.shape[0]):
        raise InputError(f"stiffness: {len(values)} motions or more do not deform it; connect its parts")
    return np.asarray(scale[:, None] * vectors[:, rigid])


def resistance(K: Real | Sparse, motions: Real) -> Real:
    """v^T K v of each motion, (k,), without the rounding of the eigensolver, which may exceed that of the entries."""
    V = motions.astype(np.longdouble)
    return np.asarray((V * np.asarray(K @ V)).sum(axis=0), dtype=float)


def rounding_resistance(K: Real | Sparse, motions: Real, precision: float = ROUNDING) -> Real:
    """The most v^T K v, (k,), that entries rounded by the part `precision` of themselves make of nothing."""
    V = abs(motions)
    return np.asarray(precision * (V * np.asarray(abs(K) @ V)).sum(axis=0))


def rounding_of(matrix: Real | Sparse) -> float:
    """By which part of itself an entry may be rounded: printed in 6 to 14 digits, in single or in double precision."""
    entries = np.asarray(matrix.data if scipy.sparse.issparse(matrix) else matrix).ravel()
    entries = entries[entries != 0.0]
    mantissa = entries / 10.0 ** np.floor(np.log10(abs(entries)))
    digits = next((d for d in range(1, 15) if (abs(mantissa - np.round(mantissa, d - 1)) <= 1e-14).all()), 15)
    printed = 0.3 * 10.0 ** (1 - digits) if digits in _PRINTED else ROUNDING
    return max(printed, _SINGLE) if digits >= _PRINTED[0] and _is_single(entries) else printed


def _is_single(entries: Real) -> bool:
    """Whether single precision holds every entry, or held it before mm and N became m and N."""
    moved = entries[:, None] * np.array([1.0, 1e3, 1e-3])
    return bool((abs(moved - moved.astype(np.float32)) <= 1e-15 * abs(moved)).any(axis=1).all())


def _scaled(K: Real | Sparse, scale: Real) -> Real | Sparse:
    """K with a unit diagonal."""
    if not scipy.sparse.issparse(K):
        return np.asarray(scale[:, None] * K * scale)
    D = scipy.sparse.diags_array(scale)
    return scipy.sparse.csc_array(D @ K @ D)


def _softest(scaled: Real | Sparse, shift: float) -> tuple[Real, Real]:
    """Eigenvalues and vectors of K with a unit diagonal: all of a dense one, the lowest of a sparse one."""
    n = int(scaled.shape[0])
    if not scipy.sparse.issparse(scaled) or n <= _SMALL:
        full: Real = scipy.sparse.csc_array(scaled).toarray() if scipy.sparse.issparse(scaled) else scaled
        values, vectors = scipy.linalg.eigh(full)
        return values, vectors
    factor = _factor(scaled, shift)
    inverse = scipy.sparse.linalg.LinearOperator((n, n), matvec=factor.solve, dtype=float)
    start = np.cos(1.0 + np.arange(n) ** 2 % 7919)
    count = min(12, n - 1)
    while True:
        try:
            _, vectors = scipy.sparse.linalg.eigsh(scaled, count, sigma=-shift, OPinv=inverse, v0=start)
        except scipy.sparse.linalg.ArpackError as error:
            raise InputError("stiffness: many motions do not deform it; connect its parts") from error
        vectors = np.linalg.qr(factor.solve(vectors))[0]
        values, turn = scipy.linalg.eigh(vectors.T @ (scaled @ vectors))
        if values[-1] > shift or count >= min(_MOST, n - 1):
            return values, vectors @ turn
        count = min(2 * count, n - 1)


def _factor(scaled: Sparse, shift: float) -> Any:
    """LU of K + shift I without pivoting, where a negative pivot is a negative eigenvalue (Sylvester)."""
    shifted = scipy.sparse.csc_array(scaled + shift * scipy.sparse.eye_array(scaled.shape[0]))
    options = {"SymmetricMode": True, "Equil": False}
    factor = scipy.sparse.linalg.splu(shifted, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
    negative = int(np.count_nonzero(factor.U.diagonal() < 0.0))
    if negative and np.array_equal(factor.perm_r, factor.perm_c):
        raise InputError(f"stiffness: is negative in {negative} motions; give the stiffness of an unloaded structure")
    return factor
