"""What the moment paths do, in sentences."""

from __future__ import annotations

import numpy as np

from .ranking import over, total, whole_band
from .results import Results
from .wording import number, percent, plural


def moments(results: Results) -> str:
    """The share of the moment paths, where they weigh most, and whether single paths return power."""
    if not results.moment.any():
        return "The bearings have no moment paths."
    if not results.alpha_moment.any():
        return "The moment paths carry no net power (nothing above rounding)."
    band = whole_band(results.frequency)
    sums = total(results, band)
    back = float(np.mean(results.alpha_moment < 0.0))
    force, moment = percent(over(sums.force, sums.ratio)), percent(abs(over(sums.moment, sums.ratio)))
    often = f"on {percent(back)} of the lines" if back < 1.0 else "on every line"
    if sums.moment < 0.0:
        text = (
            f"Summed over {band.label}, the moment paths together return power to the source, {moment} of the net "
            f"transmitted power (they do so {often}); the force paths carry {force} of it."
        )
    else:
        also = f" (on balance; they return power {often})" if back else ""
        text = (
            f"Summed over {band.label}, the moment paths together carry {moment} of the net transmitted power{also}, "
            f"the force paths {force}."
        )
    return text + _heaviest_moment(results) + _single_paths(results)


def _heaviest_moment(results: Results) -> str:
    """Where moments matter most beside forces."""
    force, moment = abs(results.alpha_force), abs(results.alpha_moment)
    weight = np.divide(moment, force + moment, out=np.zeros_like(moment), where=moment > 0.0)
    at = int(np.argmax(weight))
    minus = " (minus: back into the source)" if min(results.alpha_moment[at], results.alpha_force[at]) < 0.0 else ""
    return (
        f" Moment paths weigh most at {number(results.frequency[at], 4)} Hz, where they pass "
        f"{percent(results.alpha_moment[at])} of the input power and the force paths "
        f"{percent(results.alpha_force[at])}{minus}."
    )


def _single_paths(results: Results) -> str:
    single = float(np.mean((results.path_alpha < 0.0).any(axis=0)))
    if not single:
        return " No single path returns power to the source."
    where = "every line" if single == 1.0 else f"{percent(single)} of the lines"
    return (
        f" At least one of the {plural(len(results.paths), 'path')} returns power on {where}, so that levels of "
        "single paths cannot be added without their directions."
    )
