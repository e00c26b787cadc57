"""How many modes: added while they are worth it, then taken out again while the fit is as good without them.

A mode has m + 2 unknowns. By Schwarz's criterion it is worth them where the misfit J over n independent numbers falls
by more than the part (m + 2) ln(n) / n; white noise makes it fall by less. Where the misfit is no noise (it goes on
from line to line), such as damping that no viscous mode has, the last sixteen modes must have taken a quarter of it, or
there would be no end of them. A fit whose largest error is within the tolerance needs no more modes.
"""

from collections.abc import Callable, Sequence

import numpy as np

from .lean import lean, merged_rigid
from .misfit import is_noise, largest_error, worth
from .problem import Problem
from .pursuit import promising
from .refine import FINE, LAST, ROUGH, Refined, Trial, refine

_PATIENCE, _PROGRESS = 16, 0.75  # after so many modes a misfit that is no noise must have fallen to this part
_AIM = 0.7  # of the tolerance: the last refinement lessens the squares, and may raise the largest error a little
_ROUNDS = 2
_AT_ONCE = 4  # modes added in one step, or a quarter of those there are

Told = Callable[[int, float], None]  # modes so far, and the largest error that they leave


def grow(problem: Problem, most: int, tolerance: float, progress: Told) -> Refined:
    """As few modes as meet the tolerance, or as the misfit pays for; never more than `most`.

    Where several modes at a time lead into a poor minimum, they are tried again one by one.
    """
    best = _tried(problem, most, tolerance, _AT_ONCE, progress)
    if largest_error(problem, best.residual) > tolerance and not is_noise(problem, best.residual):
        other = _tried(problem, most, tolerance, 1, progress)
        best = min(best, other, key=lambda one: largest_error(problem, one.residual))
    return best


def _tried(problem: Problem, most: int, tolerance: float, at_once: int, progress: Told) -> Refined:
    """Modes added and taken out: that leads away from poor minima and can lessen the misfit, so it is done again."""
    aim = _AIM * tolerance
    empty = Trial(np.zeros(0), np.zeros(0), np.zeros((0, problem.channels)))
    best = Refined(empty, problem.cost(problem.stacked), -problem.stacked)
    for _ in range(_ROUNDS):
        grown = _grown(problem, best, most, aim, at_once, progress)
        found = lean(problem, refine(problem, grown.modes, *FINE), aim)
        gained, best = found.cost < _PROGRESS * best.cost, found
        if not gained or largest_error(problem, best.residual) <= aim or is_noise(problem, best.residual):
            break
    last = refine(problem, best.modes, *LAST)
    met = largest_error(problem, best.residual) <= tolerance < largest_error(problem, last.residual)
    return merged_rigid(problem, (best if met else last).modes)


def _grown(problem: Problem, best: Refined, most: int, aim: float, at_once: int, progress: Told) -> Refined:
    """More modes, until the aim, noise, or where they bring little."""
    trail, batch = [best], at_once
    while len(best.modes) < most and largest_error(problem, best.residual) > aim:
        new = promising(problem, best.residual, min(batch, most - len(best.modes)))
        if not new:
            break
        tried = refine(problem, best.modes.joined(new), *ROUGH)
        enough = best.cost * (1.0 - min(len(new) * worth(problem, best.residual), 0.5))
        if tried.cost > enough:
            tried = refine(problem, tried.modes, *FINE)
        if tried.cost > enough:
            if batch == 1:
                break
            batch = 1
            continue
        best = tried
        trail.append(best)
        progress(len(best.modes), largest_error(problem, best.residual))
        if _stands(problem, trail):
            break
        near = largest_error(problem, best.residual) < 10.0 * aim
        batch = 1 if near or batch == 1 else max(at_once, len(best.modes) // 4)
    if _stands(problem, trail):
        return next(one for one in trail if one.cost <= best.cost / _PROGRESS)
    return best


def _stands(problem: Problem, trail: Sequence[Refined]) -> bool:
    """Whether the last modes brought little, and not because noise is reached."""
    last = trail[-1]
    before = [one for one in trail if len(one.modes) <= len(last.modes) - _PATIENCE]
    met = before and last.cost > _PROGRESS * before[-1].cost
    return bool(met) and not is_noise(problem, last.residual)
