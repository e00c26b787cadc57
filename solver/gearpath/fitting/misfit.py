"""How good a fit is: its errors, whether what is left is noise, and what a mode must be worth."""

import math

import numpy as np

from ..numerics.arrays import Real
from .problem import Problem

SYSTEMATIC = 0.3  # correlation of the misfit from line to line above which it is more than noise


def largest_error(problem: Problem, residual: Real) -> float:
    """Largest |fit - Y| of any FRF and line, relative to that FRF's largest gain."""
    return float(errors(problem, residual).max(initial=0.0))


def errors(problem: Problem, residual: Real) -> Real:
    """|fit - Y| of every line and pair relative to the FRF's largest gain, (F, P)."""
    half = len(problem.x)
    doubled = 2.0 - (problem.first == problem.second)
    return np.asarray(np.hypot(residual[:half], residual[half:]) * np.sqrt(problem.weight / doubled))


def correlation(problem: Problem, residual: Real) -> float:
    """Correlation of the weighted misfit with that of the next line: near 0 it is noise."""
    half = len(problem.x)
    E = (residual[:half] + 1j * residual[half:]) * np.sqrt(problem.weight)
    power = float((abs(E) ** 2).sum())
    return float((E[:-1].conj() * E[1:]).real.sum() / power) if power else 0.0


def is_noise(problem: Problem, residual: Real) -> bool:
    return correlation(problem, residual) <= SYSTEMATIC


def worth(problem: Problem, residual: Real) -> float:
    """Part of the misfit that a mode must take: (m + 2) ln(n) / n of n independent numbers of equal size.

    Noise that is larger at resonances is that of fewer numbers, 3 (sum e^2)^2 / sum e^4.
    """
    n = problem.stacked.size
    if not is_noise(problem, residual):
        return (problem.channels + 2) * math.log(n) / n
    squares = residual**2 * problem.weight
    total = float(squares.sum())
    equal = min(float(n), 3.0 * total**2 / float((squares**2).sum())) if total else float(n)
    return (problem.channels + 2) * math.log(n) / equal
