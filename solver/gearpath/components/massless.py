"""Motions without mass: they follow the others statically, and move beside that where forces act on them."""

from collections.abc import Sequence

import numpy as np
import scipy.linalg

from ..errors import InputError
from ..numerics.arrays import Real

STATIC_HZ = 3e6  # natural frequency that the own flexibility of a motion without mass is given
_NOTHING = 1e-10  # of the largest root of an own flexibility: what rounding leaves of none


def condensed(K: Real, massive: Real, idle: Real, loaded: Sequence[int]) -> tuple[Real, Real]:
    """Stiffness (N, N) in N coordinates x, and the motion q = T x, (n, N), of K (n, n).

    The first of x are the motions U = `massive`, (n, m); those without mass, Z = `idle`, (n, k), follow them,
    Z^T K q = 0. A force on the coordinates `loaded`, rows L, moves Z by (Z^T K Z)^-1 Z^T L^T beside that. As many more
    x as that compliance L Z (Z^T K Z)^-1 Z^T L^T has ranks bear it, of unit mass and STATIC_HZ, uncoupled; at 5 kHz it
    is 3e-6 too large. Guyan, Reduction of stiffness and mass matrices, AIAA Journal 3 (1965).
    Raises InputError where Z has neither mass nor stiffness in some motion.
    """
    try:
        factor = scipy.linalg.cholesky(idle.T @ K @ idle, lower=True)
    except np.linalg.LinAlgError as error:
        raise InputError(
            f"mass: {idle.shape[1]} motions have no mass and some no stiffness either; take those coordinates out"
        ) from error
    following = massive - idle @ scipy.linalg.cho_solve((factor, True), idle.T @ (K @ massive))
    half = scipy.linalg.solve_triangular(factor, idle[sorted(set(loaded))].T, lower=True)
    left, sizes, _ = scipy.linalg.svd(half, full_matrices=False)
    left = left[:, sizes > _NOTHING * max(sizes, default=0.0)]
    w = 2.0 * np.pi * STATIC_HZ
    own = w * idle @ scipy.linalg.solve_triangular(factor.T, left)
    stiffness = following.T @ K @ following
    return scipy.linalg.block_diag((stiffness + stiffness.T) / 2.0, w**2 * np.eye(left.shape[1])), np.hstack(
        [following, own]
    )
