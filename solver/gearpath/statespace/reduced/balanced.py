"""Balanced truncation of the coupled machine (Moore 1981): small errors, but no structure and no passivity.

With the Gramians P and Q, A P + P A^T + B B^T = 0 and A^T Q + Q A + C^T C = 0, the states are changed to those in which
both are the same diagonal, and the small ones left out. Inputs and outputs are first scaled to unit largest gain, for
metres of transmission error and newtons do not compare otherwise.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy.linalg

from ...errors import InputError
from ...numerics.arrays import Real

if TYPE_CHECKING:
    import control

_DRIFTING = 1e-9  # of the largest pole: a real part above minus this cannot be balanced


def balanced(system: control.StateSpace, states: int, gains: Real) -> tuple[Real, Real, Real, Real]:
    """A, B, C, D of the stable system truncated to `states`; `gains` (outputs, inputs) are its largest ones.

    Raises InputError for a machine that drifts or has undamped modes.
    """
    import control

    A, D = np.asarray(system.A), np.asarray(system.D)
    poles = scipy.linalg.eigvals(A)
    if (poles.real > -_DRIFTING * abs(poles).max()).any():
        raise InputError(
            "method: balanced truncation needs a machine whose every motion dies away; hold it by damped mounts, or "
            "use rational_krylov"
        )
    given = np.where(gains.max(axis=0) > 0.0, 1.0 / np.where(gains.max(axis=0) > 0.0, gains.max(axis=0), 1.0), 1.0)
    largest = (gains * given).max(axis=1)
    taken = np.where(largest > 0.0, 1.0 / np.where(largest > 0.0, largest, 1.0), 1.0)
    B, C = np.asarray(system.B) * given, taken[:, None] * np.asarray(system.C)
    try:
        small = control.balred(control.StateSpace(A, B, C, taken[:, None] * D * given), states)
        found = tuple(np.asarray(matrix) for matrix in (small.A, small.B, small.C))
    except control.exception.ControlSlycot:
        found = _square_root(A, B, C, states)
    return found[0], found[1] / given, found[2] / taken[:, None], D


def _square_root(A: Real, B: Real, C: Real, states: int) -> tuple[Real, Real, Real]:
    """The square-root method, where python-control has no slycot."""
    S, R = (_factor(scipy.linalg.solve_continuous_lyapunov(F, -G @ G.T)) for F, G in ((A, B), (A.T, C.T)))
    U, values, V = scipy.linalg.svd(R.T @ S)
    root = np.sqrt(values[:states])
    T, W = S @ V[:states].T / root, R @ U[:, :states] / root
    return W.T @ A @ T, W.T @ B, C @ T


def _factor(gramian: Real) -> Real:
    """G = F F^T of a matrix that is semidefinite but for rounding."""
    values, vectors = scipy.linalg.eigh(0.5 * (gramian + gramian.T))
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))
