"""The main findings in plain sentences, every number computed from the results."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..fmu.checks import ValidationReport
from .model_tables import excitation_words
from .moments import moments
from .ranking import Share, bands, leaders, over, ranking, receiver_names, supplied, total, whole_band
from .results import Results
from .wording import decibel, given, level, listed, number, percent, plural

EVEN = 0.01  # shares of the bearings that differ by less than this count as equal
LISTED = 6  # bearings named at most in one sentence
MOST = 0.5  # a band with more than this part of the input power decides what a sum over all bands says


@dataclass(frozen=True)
class Finding:
    """One finding: what it is about, and what came out."""

    label: str
    text: str


@dataclass(frozen=True)
class KeyFigure:
    """One figure for the strip below the findings."""

    label: str
    value: str
    detail: str


def computed(results: Results) -> str:
    """What was computed, in one sentence."""
    f = results.frequency
    system = results.system
    return (
        f"Structure-borne noise power flow of the machine “{system.name}” "
        f"({plural(len(system.components), 'component')}, {plural(len(system.joints), 'joint')}, active degrees of "
        f"freedom {listed(list(system.dofs))}), computed by mobility synthesis on {plural(len(f), 'frequency line')} "
        f"from {given(f.min())} to {given(f.max())} Hz; the excitation is {excitation_words(system)}."
    )


def _why_none(results: Results) -> str:
    """Why there is no path: there is no bearing, or rigid joints hold both ends of every one together."""
    if any(joint.kind in ("bearing", "beam_joint") for joint in results.system.joints.values()):
        return "Rigid joints hold both ends of every bearing together, so that no power passes through paths."
    return "The model has no joint of kind bearing, so that no power passes through paths."


def findings(results: Results, validations: Sequence[ValidationReport]) -> list[Finding]:
    """What came out, one paragraph for each question."""
    found = []
    if not results.paths:
        found.append(Finding("Paths", _why_none(results)))
    elif not results.input_power.any():
        found.append(Finding("Paths", "The excitation puts no power in, so that none passes through the bearings."))
    else:
        found = [
            Finding("Power ratio", _how_much(results)),
            Finding("Bearings", _which_bearings(results)),
            Finding("Moments", moments(results)),
        ]
    balance = (
        f"Input power and the sum of all dissipated powers agree within {number(results.residual.max(), 2)} "
        "of the input power on every line."
    )
    found.append(Finding("Balance", balance))
    if validations:
        found.append(Finding("FMUs", _checked(validations)))
    return found


def key_figures(results: Results, validations: Sequence[ValidationReport]) -> list[KeyFigure]:
    """The same findings as a strip of figures."""
    band = whole_band(results.frequency)
    sums, order = total(results, band), ranking(results, band)
    figures = []
    if order and np.isfinite(sums.ratio):
        detail = f"{percent(sums.ratio)} in powers summed over {band.label}; mean level {decibel(sums.mean_level)}"
        figures.append(KeyFigure("transmitted / input power", decibel(level(sums.ratio)), detail))
        if first := leaders(order):
            each = " each" if len(first) > 1 else ""
            detail = f"{percent(first[0].share)}{each} of the power that enters {receiver_names(results)}"
            figures.append(KeyFigure("bearing that passes most", listed([item.name for item in first]), detail))
        moment = percent(over(sums.moment, sums.ratio)) if results.moment.any() else "none"
        figures.append(KeyFigure("moment paths", moment, "of the net transmitted power"))
    residual = number(results.residual.max(), 2)
    figures.append(KeyFigure("power balance", residual, "largest relative residual"))
    if validations:
        passed = sum(report.passed for report in validations)
        verdict = "all checks passed" if passed == len(validations) else "CHECKS FAILED, see below"
        figures.append(KeyFigure("FMUs validated", f"{passed} of {len(validations)}", verdict))
    return figures


def _how_much(results: Results) -> str:
    band = whole_band(results.frequency)
    sums, parts = total(results, band), bands(results.frequency)
    through = "the bearing" if len(results.bearings) == 1 else f"the {len(results.bearings)} bearings"
    text = (
        f"Summed over {band.label}, {percent(sums.ratio)} of the input power leaves the source through {through} "
        f"({decibel(level(sums.ratio))})."
    )
    heaviest = max(parts, key=lambda part: supplied(results, part))
    if len(parts) > 1 and supplied(results, heaviest) > MOST:
        text += (
            f" Such a sum weighs every line by its input power, of which {percent(supplied(results, heaviest))} "
            f"enters in {heaviest.label}: it describes mainly that band."
        )
    means = [f"{decibel(total(results, part).mean_level)} in {part.label}" for part in parts]
    text += f" With equal weight for every line, the mean level of the power ratio is {listed(means)}."
    peak = int(np.argmax(results.alpha))
    return (
        f"{text} The ratio is largest at {number(results.frequency[peak], 4)} Hz, where "
        f"{percent(results.alpha[peak])} of the input power is transmitted."
    )


def _which_bearings(results: Results) -> str:
    band = whole_band(results.frequency)
    order = ranking(results, band)
    if len(order) == 1:
        return f"All of it passes through {order[0].name}."
    entering = [item for item in order if item.ratio > 0.0]
    back = [item for item in reversed(order) if item.ratio < 0.0]
    receivers = receiver_names(results)
    if not entering:
        return f"Summed over {band.label}, no bearing passes power into {receivers}."
    even = entering[0].share - entering[-1].share < EVEN and len(entering) == len(order)
    text = (
        f"Summed over {band.label}, the power that enters {receivers} comes "
        f"{'almost equally ' if even else ''}through {_named(entering)}."
    )
    if back:
        returned = -sum(item.share for item in back)
        text += (
            f" Of this power, {percent(returned)} flows back into the source through {_named(back)}; the remaining "
            f"{percent(total(results, band).share)} is the net transmitted power."
        )
    return text + _leaders(results)


def _leaders(results: Results) -> str:
    """Who passes most, band by band."""
    where: dict[str, list[str]] = {}
    for part in bands(results.frequency):
        first = [item.name for item in leaders(ranking(results, part))]
        if first:
            where.setdefault(f"{listed(first)}{' alike' if len(first) > 1 else ''}", []).append(part.label)
    if len(where) > 1:
        return f" Band by band, most passes {'; '.join(f'through {k} in {listed(v)}' for k, v in where.items())}."
    if sum(len(labels) for labels in where.values()) > 1:
        return f" In every band most passes through {next(iter(where))}."
    return ""


def _named(items: Sequence[Share]) -> str:
    """Bearings with their shares; the smallest of many together."""
    words = [f"{item.name} ({percent(abs(item.share))})" for item in items]
    if len(words) > LISTED:
        rest = items[LISTED - 1 :]
        words[LISTED - 1 :] = [f"{len(rest)} more ({percent(sum(abs(item.share) for item in rest))})"]
    return listed(words)


def _checked(validations: Sequence[ValidationReport]) -> str:
    checks = [check for report in validations for check in report.checks]
    failed = [
        f"“{check.name}” of {report.fmu.name}" for report in validations for check in report.checks if not check.passed
    ]
    names = listed([report.fmu.name for report in validations])
    verdict = f"{len(failed)} FAILED: {listed(failed)}" if failed else "all of them passed"
    return f"{plural(len(validations), 'FMU')} ({names}) went through {plural(len(checks), 'check')}; {verdict}."
