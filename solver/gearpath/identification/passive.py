"""The nearest matrices without negative stiffness or damping."""

from __future__ import annotations

import numpy as np
import scipy.optimize

from ..numerics.arrays import Real


def nearest_passive(matrix: Real, covariance: Real) -> Real:
    """The positive semidefinite X (d, d) that is likeliest for an estimate of that covariance of its upper triangle.

    minimise (x - x0)^T covariance^-1 (x - x0) over X = G G^T, from the matrix with its negative eigenvalues cut off.
    The matrix itself where it is positive semidefinite already.
    """
    d = len(matrix)
    size = np.sqrt(np.maximum(np.abs(np.diagonal(matrix)), np.sqrt(np.diagonal(covariance))[_diagonal(d)]))
    scaled = matrix / np.outer(size, size)
    values, vectors = np.linalg.eigh(scaled)
    if values[0] >= 0.0:
        return matrix
    i, j = np.triu_indices(d)
    scale = size[i] * size[j]
    weight = np.linalg.inv(np.linalg.cholesky(covariance / np.outer(scale, scale)))

    def misfit(G: Real) -> Real:
        X = G.reshape(d, d) @ G.reshape(d, d).T
        return np.asarray(weight @ (X - scaled)[i, j])

    start = vectors * np.sqrt(np.maximum(values, 1e-6 * abs(values).max()))
    G = scipy.optimize.least_squares(misfit, start.ravel(), xtol=1e-12, ftol=1e-12, gtol=1e-12).x.reshape(d, d)
    return np.asarray(G @ G.T * np.outer(size, size))


def _diagonal(d: int) -> list[int]:
    """Places of the diagonal in the upper triangle of a (d, d) matrix."""
    return [k * d - k * (k - 1) // 2 for k in range(d)]
