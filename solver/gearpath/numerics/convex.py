"""Minimum of a smooth convex energy: Newton's method with Levenberg's damping."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from .arrays import Real

_STEPS = 200
_LEAST, _STUCK = 1e-13, 1e12  # damping: what keeps directions without stiffness in place, and where to give up


class Look(NamedTuple):
    """An energy at one place."""

    energy: float
    rest: Real  # minus its gradient, (n,)
    residual: float  # the size of the rest, in whatever measure the caller stops by


class Minimum(NamedTuple):
    """Where the search ended: judge it by `residual`."""

    place: Real
    solves: int  # linear solves
    residual: float


def minimise(
    look: Callable[[Real], Look],
    hessian: Callable[[Real], Real],
    place: Real,
    *,
    tolerance: float,
    slack: float,
    lost: Callable[[Real], bool],
) -> Minimum:
    """Minimise from `place` until the residual is at most `tolerance`, no step helps or a place is `lost`.

    Coordinates are to be scaled so that a Hessian of 1 is usual: the damping, a multiple of the unit matrix, begins
    there and vanishes as steps succeed. A step must reduce the energy or, where that is flat to within `slack` of it
    (its rounding, in its unit), the residual.
    """
    damping, solves, unity = 1.0, 0, np.eye(len(place))
    energy, rest, residual = look(place)
    while solves < _STEPS and residual > tolerance:
        H = hessian(place)
        while damping < _STUCK:
            moved = place + np.linalg.solve(H + damping * unity, rest)
            new, solves = look(moved), solves + 1
            flat = 1e-14 * abs(energy) + slack
            if new.energy < energy - flat or (new.energy <= energy + flat and new.residual < residual):
                break
            damping *= 8.0
        else:
            break
        place, (energy, rest, residual) = moved, new
        damping = max(0.02 * damping, _LEAST)
        if lost(place):
            break
    return Minimum(place, solves, residual)
