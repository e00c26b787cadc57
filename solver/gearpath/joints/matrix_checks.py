"""Stiffness and damping matrices of joints: symmetric, positive semidefinite, on the model's `dofs`."""

import numpy as np

from ..errors import ModelError
from ..numerics.arrays import Real
from .joint import Matrix

ROUNDING = 1e-9  # relative to the matrix with a unit diagonal, since units mix


def check_matrix(matrix: Matrix, dofs: tuple[str, ...], key: str) -> None:
    """Refuse a matrix of the wrong size, an unsymmetric or an indefinite one; singular ones pass."""
    size, count = len(matrix), len(dofs)
    if size != count:
        raise ModelError(
            key,
            f"the matrix is {size} x {size}, but dofs has {count}: {', '.join(dofs)}",
            f"give a {count} x {count} matrix on them",
        )
    K = np.array(matrix)
    for i, dof in enumerate(dofs):
        if K[i, i] < 0.0:
            raise ModelError(key, f"entry [{i + 1},{i + 1}], {K[i, i]:g}, on {dof} is negative", "give at least 0")
    root = np.sqrt(np.diag(K))
    _check_symmetry(K, root, key)
    _check_definite(K, root, dofs, key)


def _check_symmetry(
    K: Real,
    root: Real,
    key: str,
) -> None:
    with np.errstate(over="ignore"):
        size = np.maximum(np.maximum(abs(K), abs(K.T)), root[:, None] * root)
        broken = abs(K - K.T) > ROUNDING * size
    if not broken.any():
        return
    i, k = (int(index) for index in np.argwhere(broken)[0])
    raise ModelError(
        key,
        f"the matrix is not symmetric: [{i + 1},{k + 1}] is {K[i, k]:g}, [{k + 1},{i + 1}] is {K[k, i]:g}",
        "give both the same value",
    )


def _check_definite(
    K: Real,
    root: Real,
    dofs: tuple[str, ...],
    key: str,
) -> None:
    remedy = "check units and signs: a passive joint has k_ij^2 <= k_ii k_jj for every pair"
    for i, k in np.argwhere(np.triu(abs(K), 1) > (1.0 + ROUNDING) * (root[:, None] * root)):
        raise ModelError(
            key,
            f"the matrix is indefinite: the coupling of {dofs[i]} and {dofs[k]}, {K[i, k]:g}, "
            f"exceeds {root[i] * root[k]:.6g}",
            remedy,
        )
    safe = np.where(root > 0.0, root, 1.0)
    low = float(np.linalg.eigvalsh(K / safe[:, None] / safe)[0])
    if low < -ROUNDING:
        raise ModelError(
            key,
            f"the matrix is indefinite: scaled to a unit diagonal its smallest eigenvalue is {low:.3g}",
            "check units and signs of the couplings: a passive joint has none below zero",
        )
