"""A damping matrix in modes: what each mode damps alone, and dashpots for what couples them.

    X = diag(x) + D^T D,    x = alpha + beta L of elastic modes, 0 of rigid ones

Rayleigh damping has no dashpots at all, one dashpot of a finite element model has one row. alpha and beta are the
largest that leave a positive semidefinite rest; where the rest has few rows, they are those that the file was made
with: alpha + beta t, t any eigenvalue between the modes, is largest there (a concave function of beta).
"""

from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.optimize

from ..errors import InputError
from ..numerics.arrays import Real

_COUPLED = 1e-6  # largest coupling of modes that printed digits may leave, of the geometric mean of their own damping
_NEGATIVE = 1e-6  # of a mode's own damping
_ROUNDING = 1e-7  # of a mode's own damping: a dashpot below this is rounding of the file
_ALONE = 1e-5  # of a mode's own damping: what rough alpha and beta leave of modes that no dashpot sees
_TRIED = 300  # modes that alpha and beta are chosen from
_MOST = 600  # dashpots


@dataclass(frozen=True)
class ModalDamping:
    """x (N,), rad/s, and D (k, N)."""

    own: Real
    dashpots: Real


def split_damping(X: Real, eigenvalues: Real) -> ModalDamping:
    """Splits a damping matrix X (N, N) in mass-normalised modes of these eigenvalues (N,), rigid ones exactly 0.

    Raises InputError for a matrix that is not positive semidefinite, and for one that needs more than 600 dashpots.
    """
    elastic, size = eigenvalues > 0.0, _size(X)
    if not size.any():
        return ModalDamping(np.zeros(len(X)), np.zeros((0, len(X))))
    if _rest(X, size)[0][0] < -_NEGATIVE:
        raise InputError("damping: feeds energy in, in some motion; give a positive semidefinite matrix")
    diagonal = np.where(elastic, np.maximum(np.diag(X), 0.0), 0.0)
    if (abs(X - np.diag(diagonal)) <= _COUPLED * np.outer(size, size)).all():
        return ModalDamping(diagonal, np.zeros((0, len(X))))
    own = np.where(elastic, _rayleigh(X, eigenvalues, elastic) @ [np.ones(len(X)), eigenvalues], 0.0)
    values, vectors = _rest(X - np.diag(own), size)
    if values[0] < -_NEGATIVE:
        own = np.zeros(len(X))
        values, vectors = _rest(X, size)
    kept = values > _ROUNDING
    if kept.sum() > _MOST:
        raise InputError(
            f"damping: couples modes in {kept.sum()} ways, of which {_MOST} can be kept; give modal_damping or "
            "loss_factor for the structure and single dashpots as joints"
        )
    return ModalDamping(own, (vectors[:, kept] * np.sqrt(values[kept])).T * size)


def _size(X: Real) -> Real:
    """Square root of every mode's own damping, (N,); a floor keeps undamped ones from division."""
    own = np.diag(X)
    return np.asarray(np.sqrt(np.maximum(own, 1e-12 * own.max(initial=0.0))))


def _rest(X: Real, size: Real) -> tuple[Real, Real]:
    """Eigenvalues and vectors of X, relative to every mode's own damping."""
    values, vectors = scipy.linalg.eigh(X / np.outer(size, size))
    return values, vectors


def _rayleigh(X: Real, eigenvalues: Real, elastic: np.ndarray) -> Real:
    """alpha and beta, (2,), neither negative, with X - alpha - beta L positive semidefinite on the first modes."""
    chosen = np.flatnonzero(elastic)[:_TRIED]
    if not chosen.size:
        return np.zeros(2)
    X, L = X[np.ix_(chosen, chosen)], eigenvalues[chosen]
    unit = float(np.sqrt(L[0] * L[-1]))

    def least(beta: float) -> float:
        return float(scipy.linalg.eigvalsh(X - np.diag(beta / unit * L), subset_by_index=[0, 0])[0])

    scale = np.sqrt(L / unit)
    largest = max(float(scipy.linalg.eigvalsh(X / np.outer(scale, scale), subset_by_index=[0, 0])[0]), 0.0)
    if largest == 0.0:
        return np.array([max(least(0.0), 0.0), 0.0])
    found = scipy.optimize.minimize_scalar(
        lambda beta: -(least(beta) + beta), bounds=(0.0, largest), method="bounded", options={"xatol": 1e-15 * largest}
    )
    beta = max((0.0, largest, float(found.x)), key=lambda b: least(b) + b)
    return _sharpened(X, L, np.array([max(least(beta), 0.0), beta / unit]))


def _sharpened(X: Real, L: Real, rough: Real) -> Real:
    """alpha and beta that damp all of what the modes V alone feel: V^T X V = alpha + beta V^T L V, by least squares."""
    size = _size(X)
    values, vectors = _rest(X - np.diag(rough @ [np.ones(len(L)), L]), size)
    V = vectors[:, abs(values) < _ALONE] / size[:, None]
    if V.shape[1] < 2:
        return rough
    felt = np.column_stack([(V.T @ (m[:, None] * V)).ravel() for m in (np.ones(len(L)), L)])
    weight = np.linalg.norm(felt, axis=0)
    solved = np.linalg.lstsq(felt / weight, (V.T @ X @ V).ravel(), rcond=None)[0] / weight
    return np.asarray(np.maximum(solved, 0.0))
