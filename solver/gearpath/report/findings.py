"""The main findings in plain sentences, every number computed from the results."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..fmu.checks import ValidationReport
from .model_tables import excitation_words
from .ranking import bands, ranking, total, whole_band
from .results import Results
from .wording import decibel, given, level, listed, number, percent, plural

EVEN = 0.01  # shares of the bearings that differ by less than this count as equal


@dataclass(frozen=True)
class KeyFigure:
    """One figure for the strip below the title."""

    label: str
    value: str
    detail: str


def summary(results: Results, validations: Sequence[ValidationReport]) -> str:
    """What was computed and what came out: one paragraph."""
    sentences = [_what(results)]
    if results.paths and results.input_power.any():
        sentences += [_how_much(results), _by_band(results), _which_bearing(results), _moments(results)]
    else:
        sentences.append("No power passes through bearings: the model has no joint of kind bearing, or is at rest.")
    sentences.append(
        f"Input power and the sum of all dissipated powers agree within {number(results.residual.max(), 2)} "
        "of the input power on every line."
    )
    if validations:
        sentences.append(_checked(validations))
    return " ".join(sentences)


def key_figures(results: Results, validations: Sequence[ValidationReport]) -> list[KeyFigure]:
    """The same findings as a strip of figures."""
    band = whole_band(results.frequency)
    sums, order = total(results, band), ranking(results, band)
    figures = []
    if order and np.isfinite(sums.share):
        figures = [
            KeyFigure("transmitted / input power", decibel(level(sums.ratio)), f"{percent(sums.ratio)}, {band.label}"),
            KeyFigure("bearing that passes most", order[0].name, f"{percent(order[0].share)} of the net power through all"),
            KeyFigure("moment paths", percent(sums.moment / sums.ratio), "of the transmitted power"),
        ]
    residual = number(results.residual.max(), 2)
    figures.append(KeyFigure("power balance", residual, "largest relative residual"))
    if validations:
        passed = sum(report.passed for report in validations)
        verdict = "all checks passed" if passed == len(validations) else "CHECKS FAILED, see below"
        figures.append(KeyFigure("FMUs validated", f"{passed} of {len(validations)}", verdict))
    return figures


def _what(results: Results) -> str:
    f = results.frequency
    system = results.system
    return (
        f"Structure-borne noise power flow of the machine “{system.name}” "
        f"({plural(len(system.components), 'component')}, {plural(len(system.joints), 'joint')}, active degrees of "
        f"freedom {listed(list(system.dofs))}), computed by mobility synthesis on {plural(len(f), 'frequency line')} "
        f"from {given(f.min())} to {given(f.max())} Hz; the excitation is {excitation_words(system)}."
    )


def _how_much(results: Results) -> str:
    sums = total(results, whole_band(results.frequency))
    peak = int(np.argmax(results.alpha))
    return (
        f"Summed over the band, {percent(sums.ratio)} of the input power leaves through the "
        f"{plural(len(results.bearings), 'bearing')} ({decibel(level(sums.ratio))}); the power ratio is largest at "
        f"{number(results.frequency[peak], 4)} Hz, where it reaches {percent(results.alpha[peak])}."
    )


def _by_band(results: Results) -> str:
    means = [
        f"{decibel(total(results, band).mean_level)} ({band.label})" for band in bands(results.frequency)
    ]
    return f"The mean level of the power ratio is {listed(means)}."


def _which_bearing(results: Results) -> str:
    order = ranking(results, whole_band(results.frequency))
    if len(order) == 1:
        return f"All of it passes through {order[0].name}."
    first, last = order[0], order[-1]
    back = [f"{item.name} ({percent(item.share)})" for item in order if item.ratio < 0.0]
    if back:
        verb = "returns" if len(back) == 1 else "return"
        return (
            f"Most power passes through {first.name}: {percent(first.share)} of the net transmitted power, while "
            f"{listed(back)} {verb} power to the source."
        )
    span = f"{percent(first.share)}; {last.name} passes least, {percent(last.share)}"
    if first.share - last.share < EVEN:
        return f"The bearings share the power almost equally: {first.name} passes most, {span}."
    return f"Most of the transmitted power passes through {first.name}, {span}."


def _moments(results: Results) -> str:
    sums = total(results, whole_band(results.frequency))
    if not results.moment.any():
        return "The bearings have no moment paths."
    if not results.alpha_moment.any():
        return "The moment paths carry no power (nothing above rounding)."
    back = float(np.mean(results.alpha_moment < 0.0))
    returned = f", and return power to the source on {percent(back)} of the lines" if back else ""
    single = float(np.mean((results.path_alpha < 0.0).any(axis=0)))
    return (
        f"Moment paths carry {percent(sums.moment / sums.ratio)} of the transmitted power{returned}; at least one "
        f"single path returns power on {percent(single)} of the lines."
    )


def _checked(validations: Sequence[ValidationReport]) -> str:
    checks = [check for report in validations for check in report.checks]
    failed = sum(not check.passed for check in checks)
    names = listed([report.fmu.name for report in validations])
    verdict = "all of them passed" if not failed else f"{failed} of them FAILED"
    return f"{plural(len(validations), 'FMU')} ({names}) went through {plural(len(checks), 'check')}; {verdict}."
