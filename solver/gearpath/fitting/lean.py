"""A fit without the modes that it can do without: rigid ones of one rank, crowds, twins, weak ones."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from ..numerics.arrays import Real
from .misfit import is_noise, largest_error, worth
from .mode_lines import mode_lines
from .problem import Problem
from .refine import FINE, LAST, ROUGH, Refined, Trial, evaluated, refine

_SPARED = 1.1  # what a smaller fit may leave, in parts of the least misfit that is no noise and was found
_HOPELESS = 5.0  # a smaller fit whose largest error is yet so many times larger is given up
_FAILURES = 6  # trials of a smaller fit that may fail in a row
_MERGED = 3.0  # modes whose frequencies differ by less than this many half-power widths may be one


def lean(problem: Problem, best: Refined, tolerance: float) -> Refined:
    """The fit without the modes that it can do without: rigid ones of one rank, twins, weak ones."""
    best = merged_rigid(problem, best.modes)
    spared = 0.0 if is_noise(problem, best.residual) else _SPARED
    lowest = best.cost
    for trial in _sparse(best.modes):
        found = refine(problem, trial, *LAST)
        if len(found.modes) < len(best.modes) and _is_as_good(problem, found, best, tolerance, spared * lowest):
            best = found
            break
    failed = 0
    while failed < _FAILURES:
        tried = _next_smaller(problem, best, failed)
        if tried is None:
            break
        found = refine(problem, tried, *ROUGH)
        hopeless = largest_error(problem, found.residual) > _HOPELESS * max(
            tolerance, largest_error(problem, best.residual)
        )
        found = found if hopeless else refine(problem, found.modes, *FINE)
        if _is_as_good(problem, found, best, tolerance, spared * lowest):
            best, failed, lowest = found, 0, min(lowest, found.cost)
        else:
            failed += 1
    return best


def _is_as_good(problem: Problem, found: Refined, best: Refined, tolerance: float, most: float) -> bool:
    """Within the tolerance, or as near as what a mode must be worth; or within `most` where that is no noise."""
    if largest_error(problem, found.residual) <= tolerance:
        return True
    near = found.cost <= max(best.cost * (1.0 + worth(problem, best.residual)), most)
    return near and largest_error(problem, best.residual) > tolerance


def merged_rigid(problem: Problem, modes: Trial) -> Refined:
    """The same fit with at most m rigid-body modes."""
    rigid = modes.frequency == 0.0
    if not rigid.any():
        return evaluated(problem, modes)
    values, vectors = np.linalg.eigh(modes.shapes[rigid].T @ modes.shapes[rigid])
    kept = values > 1e-14 * values[-1]
    shapes = (vectors[:, kept] * np.sqrt(values[kept])).T
    merged = Trial(np.zeros(len(shapes)), np.zeros(len(shapes)), shapes)
    return evaluated(problem, merged.joined([modes.picked(~rigid)]))


def _next_smaller(problem: Problem, best: Refined, failed: int) -> Trial | None:
    """The smaller trial that costs least at once; after `failed` failures the one behind them."""
    modes = best.modes
    lines = _lines(problem, modes)
    products = problem.products(modes.shapes)
    trials: list[tuple[float, Trial]] = []
    everything = np.arange(len(modes))
    for r in range(len(modes)):
        removed = best.residual - np.outer(lines[r], products[r])
        trials.append((problem.cost(removed), modes.picked(everything != r)))
    for members in np.argwhere(np.triu(_near(modes), 1)):
        merged = _merged(modes, members, 1)
        change = _lines(problem, merged).T @ problem.products(merged.shapes) - lines[members].T @ products[members]
        rest = modes.picked(np.setdiff1d(everything, members))
        trials.append((problem.cost(best.residual + change), rest.joined([merged])))
    trials.sort(key=lambda item: item[0])
    return trials[failed][1] if failed < len(trials) else None


def _lines(problem: Problem, modes: Trial) -> Real:
    lines = mode_lines(problem.x, modes.frequency, modes.damping)
    return np.hstack([lines.real, lines.imag])


def _near(modes: Trial) -> NDArray[np.bool_]:
    """Which elastic modes stand within their widths of each other, (N, N)."""
    width = modes.damping * modes.frequency
    apart = abs(modes.frequency[:, None] - modes.frequency)
    return np.asarray((apart < _MERGED * np.maximum(width[:, None], width)) & (np.minimum.outer(width, width) > 0.0))


def _sparse(modes: Trial) -> list[Trial]:
    """Trials with few modes in place of each crowd of more than two: one direction, two, and so on."""
    trials = []
    count, label = connected_components(csr_array(_near(modes)))
    for members in (np.flatnonzero(label == k) for k in range(count)):
        for kept in range(1, min(len(members), modes.shapes.shape[1] + 1)) if len(members) > 2 else ():
            rest = modes.picked(np.setdiff1d(np.arange(len(modes)), members))
            trials.append(rest.joined([_merged(modes, members, kept)]))
    return trials


def _merged(modes: Trial, members: NDArray[np.intp], kept: int) -> Trial:
    """The first directions of some modes in their place, frequencies and damping by what each has of them."""
    group = modes.picked(members)
    _, size, directions = np.linalg.svd(group.shapes, full_matrices=False)
    share = (group.shapes @ directions[:kept].T).T ** 2
    share /= share.sum(axis=1, keepdims=True)
    return Trial(share @ group.frequency, share @ group.damping, size[:kept, None] * directions[:kept])
