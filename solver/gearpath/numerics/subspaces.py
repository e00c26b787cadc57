"""Row space and null space of constraint rows whose units differ, some of which may repeat others."""

import numpy as np
import scipy.linalg

from .arrays import Real

_RANK = 1e-9  # singular values below this part of the largest belong to rows that repeat others


def unit_rows(rows: Real) -> Real:
    """The rows (c, n) with unit length, so that m and rad count alike; without those that are zero."""
    size = np.linalg.norm(rows, axis=1)
    return np.asarray(rows[size > 0.0] / size[size > 0.0, None])


def row_space(rows: Real) -> Real:
    """Orthonormal rows (rank, n) that span those given, (c, n)."""
    right, rank = _right(rows, full=False)
    return right[:rank]


def null_space(rows: Real) -> Real:
    """Orthonormal columns (n, n - rank) of all q with rows @ q = 0."""
    right, rank = _right(rows, full=True)
    return right[rank:].T


def _right(rows: Real, full: bool) -> tuple[Real, int]:
    """Right singular vectors, the first `rank` of which span the rows."""
    if not rows.any():
        return np.eye(rows.shape[1]), 0
    _, values, right = scipy.linalg.svd(rows, full_matrices=full)
    return right, int((values > _RANK * values[0]).sum())
