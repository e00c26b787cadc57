"""Nonlinear least squares of all modes together, by Levenberg and Marquardt's method.

The unknowns of a mode are ln x_r, ln zeta_r and its real shape psi_r. Because every FRF has one weight on all lines,
the normal matrix factors: with S_rp = psi_ra psi_rb and its slope V_rpc = d S_rp / d psi_rc

    <q r, q' s> = G_qq'(r, s) sum_p W_p S_rp S_sp,    G_qq'(r, s) = Re sum_f conj(b_q,r) b_q',s

and likewise with V, so that one step costs a product (3 N, 2 F) (2 F, 3 N) whatever the number of FRFs.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ..numerics.arrays import Real
from .mode_lines import mode_lines_and_slopes
from .problem import Problem

ROUGH, FINE, LAST = (15, 1e-2), (40, 1e-3), (100, 1e-4)  # steps at most, and what part of J counts as progress
_LARGEST_STEP = np.array([0.1, 1.0])  # of ln x_r and ln zeta_r in one step
HIGHEST, LARGEST, SMALLEST = 30.0, 0.95, 1e-7  # of x_r and zeta_r
_RIGID = 3e-3  # of the lowest line: a mode below moves like a rigid body, and becomes one
_GIVE_UP = 1e12  # of the Marquardt parameter


@dataclass(frozen=True)
class Trial:
    """N real modes in scaled units: frequencies x_r (0: rigid), damping ratios and shapes psi (N, m)."""

    frequency: Real
    damping: Real
    shapes: Real

    def __len__(self) -> int:
        return len(self.frequency)

    def joined(self, others: Sequence["Trial"]) -> "Trial":
        """These modes and those of the others."""
        parts = [self, *others]
        return Trial(
            np.concatenate([part.frequency for part in parts]),
            np.concatenate([part.damping for part in parts]),
            np.vstack([part.shapes for part in parts]),
        )

    def picked(self, which: NDArray[Any]) -> "Trial":
        """Some of the modes."""
        return Trial(self.frequency[which], self.damping[which], self.shapes[which])


@dataclass(frozen=True)
class Refined:
    """The modes after refinement, with the misfit J and the stacked residual fit - target (2 F, P)."""

    modes: Trial
    cost: float
    residual: Real


def refine(problem: Problem, modes: Trial, steps: int, enough: float) -> Refined:
    """At most `steps` steps, until the misfit falls by less than the part `enough` of itself in each of two."""
    lines = mode_lines_and_slopes(problem.x, modes.frequency, modes.damping)
    best = _of(problem, modes, lines)
    strength, slow = 1e-3, 0
    for _ in range(steps):
        if not len(best.modes) or best.cost == 0.0:
            break
        H, gradient = _normal_equations(problem, best, lines)
        improved = False
        while strength < _GIVE_UP:
            moved = _moved(best.modes, _step(H, gradient, strength), _RIGID * float(problem.x[0]))
            tried_lines = mode_lines_and_slopes(problem.x, moved.frequency, moved.damping)
            tried = _of(problem, moved, tried_lines)
            if tried.cost < best.cost:
                improved = True
                break
            strength *= 8.0
        if not improved:
            break
        slow = slow + 1 if tried.cost > (1.0 - enough) * best.cost else 0
        best, lines, strength = tried, tried_lines, max(strength / 10.0, 1e-12)
        if slow == 2:
            break
    return best


def evaluated(problem: Problem, modes: Trial) -> Refined:
    """The modes with their misfit, as they are."""
    return _of(problem, modes, mode_lines_and_slopes(problem.x, modes.frequency, modes.damping))


def _of(problem: Problem, modes: Trial, lines: Real) -> Refined:
    residual = lines[: len(modes)].T @ problem.products(modes.shapes) - problem.stacked
    return Refined(modes, problem.cost(residual), residual)


def _normal_equations(problem: Problem, at: Refined, lines: Real) -> tuple[Real, Real]:
    """Gauss and Newton's matrix and half the gradient in [ln x, ln zeta, psi], sizes N, N and N m."""
    modes, W = at.modes, problem.weight
    N, m = modes.shapes.shape
    G = (lines @ lines.T).reshape(3, N, 3, N)
    T = (lines @ at.residual).reshape(3, N, -1) * W
    S, V = problem.products(modes.shapes), _shape_slopes(problem, modes.shapes)
    SS = (S * W) @ S.T
    weighted = V * W[:, None]
    SV = np.tensordot(S, weighted, (1, 1))  # (N, N, m)
    VV = np.tensordot(weighted, V, (1, 1)).transpose(0, 2, 1, 3)  # (N, N, m, m)
    H = np.empty((2 * N + N * m,) * 2)
    for q in (1, 2):
        rows = slice((q - 1) * N, q * N)
        for k in (1, 2):
            H[rows, (k - 1) * N : k * N] = G[q, :, k] * SS
        H[rows, 2 * N :] = (G[q, :, 0][:, :, None] * SV).reshape(N, N * m)
        H[2 * N :, rows] = H[rows, 2 * N :].T
    H[2 * N :, 2 * N :] = (G[0, :, 0][:, :, None, None] * VV).transpose(0, 2, 1, 3).reshape(N * m, N * m)
    shape_gradient = np.einsum("rp,rpc->rc", T[0], V)
    return H, np.concatenate([(T[1] * S).sum(axis=1), (T[2] * S).sum(axis=1), shape_gradient.ravel()])


def _shape_slopes(problem: Problem, shapes: Real) -> Real:
    """V, d (psi_a psi_b) / d psi_c, (N, P, m)."""
    pairs = np.arange(len(problem.first))
    V = np.zeros((len(shapes), len(pairs), problem.channels))
    V[:, pairs, problem.first] = shapes[:, problem.second]
    V[:, pairs, problem.second] += shapes[:, problem.first]
    return V


def _step(H: Real, gradient: Real, strength: float) -> Real:
    """The damped step; what has no influence (the frequency of a rigid-body mode) stays."""
    diagonal = np.diag(H).copy()
    size = np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    scaled = H / size / size[:, None]
    np.fill_diagonal(scaled, 1.0 + strength)
    try:
        factor = scipy.linalg.cho_factor(scaled, check_finite=False, overwrite_a=True)
    except scipy.linalg.LinAlgError:
        return np.zeros_like(gradient)
    return np.asarray(-scipy.linalg.cho_solve(factor, gradient / size, check_finite=False) / size)


def _moved(modes: Trial, step: Real, lowest: float) -> Trial:
    N = len(modes)
    frequency_step, damping_step = step[:N], step[N : 2 * N]
    # one factor for a mode keeps the direction of its step where frequency or damping would move too far
    largest = np.maximum(abs(frequency_step) / _LARGEST_STEP[0], abs(damping_step) / _LARGEST_STEP[1])
    short = 1.0 / np.maximum(largest, 1.0)
    frequency = modes.frequency * np.exp(short * frequency_step)
    return Trial(
        np.where(frequency < lowest, 0.0, np.minimum(frequency, HIGHEST)),
        np.clip(modes.damping * np.exp(short * damping_step), SMALLEST, LARGEST),
        modes.shapes + short[:, None] * step[2 * N :].reshape(modes.shapes.shape),
    )
