"""A derivative by differences of ever smaller steps, extrapolated to the step 0, with an estimate of its error.

    d(h) = (f(h) - f(-h)) / 2h = f' + c_2 h^2 + c_4 h^4 + ...        two sides
    d(h) = (f(h) - f(0)) / h   = f' + c_1 h + c_2 h^2 + ...          one side, at a bound

Each step is a quarter of the one before. Neville's scheme removes the powers one by one; of all entries of the scheme
each element takes the one that differs least from its neighbours (Ridders 1982, Adv. Eng. Software 4, 75-76), so that
no step size has to be known: a linear function is exact to rounding at the first step, a strongly curved one at a
small one.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...numerics.arrays import Real

RATIO = 4.0  # of two steps that follow each other
LEVELS = 16  # the last step is 1e-9 of the first
_EPS = float(np.finfo(float).eps)

Function = Callable[[float], Real | None]


def derivative(function: Function, largest: float, low: float, high: float) -> tuple[Real, Real] | None:
    """f'(0) and the estimate of its error, element by element, of f(h) with steps up to `largest`.

    low <= 0 <= high bound h. `function` returns None where it has no value: such steps are left out. None where nothing
    is left.
    """
    sides, largest = _sides(largest, low, high)
    power = 2.0 if len(sides) == 2 else 1.0
    base = None if len(sides) == 2 else function(0.0)
    best: tuple[Real, Real] | None = None
    previous: list[Real] = []
    for level in range(LEVELS):
        h = largest / RATIO**level
        found = _quotient(function, h, sides, base)
        if found is None:
            previous = []
            continue
        quotient, noise = found
        row = [quotient]
        for m, above in enumerate(previous, 1):
            factor = RATIO ** (power * m)
            row.append((factor * row[-1] - above) / (factor - 1.0))
        best = _better(best, row, previous, noise)
        if previous and best is not None and bool(np.all(noise >= best[1])):
            break  # smaller steps only lose digits
        previous = row
    return best


def _sides(largest: float, low: float, high: float) -> tuple[tuple[float, ...], float]:
    """Both sides where the bounds leave room for a hundredth of the step, or the side that has more."""
    room = min(-low, high)
    if room >= 0.01 * largest or low == high:
        return (1.0, -1.0), min(largest, room) if room > 0.0 else largest
    return ((1.0,), min(largest, high)) if high > -low else ((-1.0,), min(largest, -low))


def _quotient(function: Function, h: float, sides: tuple[float, ...], base: Real | None) -> tuple[Real, Real] | None:
    values = [function(side * h) for side in sides]
    ends = values if len(sides) == 2 else [values[0], base]
    if ends[0] is None or ends[1] is None:
        return None
    width = 2.0 * h if len(sides) == 2 else sides[0] * h
    noise = 2.0 * _EPS * np.maximum(abs(ends[0]), abs(ends[1])) / abs(width)
    return (ends[0] - ends[1]) / width, noise


def _better(
    best: tuple[Real, Real] | None, row: list[Real], previous: list[Real], noise: Real
) -> tuple[Real, Real] | None:
    """The best of old and new entries, element by element; the first row has nothing to be compared with."""
    if not previous:
        return best if best is not None else (row[0], np.full_like(row[0], np.inf))
    assert best is not None
    value, error = best
    for m, entry in enumerate(row[1:], 1):
        apart = np.maximum(abs(entry - row[m - 1]), abs(entry - previous[m - 1])) + noise
        value, error = np.where(apart < error, entry, value), np.minimum(apart, error)
    return value, error
