"""Which mode to add next: the one that takes most from the misfit, among trial frequencies and damping ratios.

For a mode of shape sqrt(a) v, |v| = 1, with the line b the misfit falls by (v^T C v)^2 / (|b|^2 sum_p W_p (v_a v_b)^2)
at the best a, with C the weighted correlation of b with what is still missing. v is the first eigenvector of C, so that
a > 0: only passive modes are offered.
"""

import numpy as np

from ..numerics.arrays import Real
from .mode_lines import mode_lines
from .problem import Problem
from .refine import Trial

_DAMPING = np.geomspace(3e-4, 0.5, 9)
_PEAKS, _SPREAD = 12, 30  # trial frequencies: at peaks of what is missing, and all over the band
_BEYOND = np.array([1.01, 1.03, 1.07, 1.15, 1.3, 1.6, 2.2, 4.0, 10.0])
_BEFORE = np.array([0.9, 0.6, 0.3])  # of the lowest line
_WORTH = 0.2  # of the best one's gain: what is added beside it at once


def promising(problem: Problem, residual: Real, most: int) -> list[Trial]:
    """Up to `most` modes to start from, the best first; none where no passive mode lessens the misfit."""
    frequency, damping = _candidates(problem, residual)
    lines = mode_lines(problem.x, frequency, damping)
    lines = np.hstack([lines.real, lines.imag])
    power = (lines**2).sum(axis=1)
    missing, found, best = -residual, [], 0.0
    for _ in range(most):
        C = problem.unpacked(problem.weight / (1.0 + (problem.first != problem.second)) * (lines @ missing))
        values, vectors = np.linalg.eigh(C)
        v = vectors[:, :, -1]
        products = problem.products(v)
        size = power * (products**2 @ problem.weight)
        gain = np.where(values[:, -1] > 0.0, values[:, -1] ** 2 / size, 0.0)
        k = int(np.argmax(gain))
        if gain[k] <= _WORTH * best or gain[k] == 0.0:
            break
        best = max(best, float(gain[k]))
        amplitude = values[k, -1] / size[k]
        found.append(Trial(frequency[k : k + 1], damping[k : k + 1], np.sqrt(amplitude) * v[k : k + 1]))
        missing = missing - np.outer(lines[k], amplitude * products[k])
    return found


def _candidates(problem: Problem, residual: Real) -> tuple[Real, Real]:
    """Trial frequencies and damping ratios, (c,) each."""
    x = problem.x
    real = problem.unpacked(-residual[: len(x)] * np.sqrt(problem.weight))
    strongest = np.linalg.eigvalsh(real)[:, -1]
    padded = np.concatenate([[-np.inf], strongest, [-np.inf]])
    peaks = np.flatnonzero((strongest >= padded[:-2]) & (strongest >= padded[2:]))
    peaks = peaks[np.argsort(strongest[peaks])[::-1][:_PEAKS]]
    inside = np.unique(np.concatenate([x[peaks], x[np.linspace(0, len(x) - 1, _SPREAD).astype(int)]]))
    frequency, damping = (grid.ravel() for grid in np.meshgrid(inside, _DAMPING))
    outside = np.concatenate([[0.0], x.min() * _BEFORE, _BEYOND])
    return np.concatenate([outside, frequency]), np.concatenate([np.full(len(outside), 0.01), damping])
