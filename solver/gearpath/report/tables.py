"""The tables of results: bands, ranking of the bearings, balance, natural frequencies, validation."""

from __future__ import annotations

import numpy as np

from ..fmu.checks import ValidationReport
from .ranking import Share, dissipation, every_band, over, ranking, receiver_names, total
from .results import Results
from .table import Group, Table, table
from .wording import decibel, level, number, percent, plural

LISTED = 60  # natural frequencies printed at most
_RATIO = "ratio of summed powers, dB"


def _level(ratio: float) -> str:
    return decibel(level(ratio), unit=False)


def band_table(results: Results) -> Table:
    """Power ratio and its parts by band."""
    rows = []
    for label, band in every_band(results.frequency):
        sums = total(results, band)
        rows.append(
            [
                label,
                str(int(band.lines.sum())),
                percent(sums.ratio),
                _level(sums.ratio),
                decibel(sums.mean_level, unit=False),
                percent(over(sums.force, sums.ratio)),
                percent(over(sums.moment, sums.ratio)),
            ]
        )
    head = ["band", "lines", "transmitted / input", _RATIO, "mean level, dB", "by force paths", "by moment paths"]
    note = (
        "Powers are summed over the lines of a band, so that lines with much input power weigh more; the mean level is "
        "the mean of 10 lg |α| over the lines, all with the same weight. The two parts are shares of the net "
        "transmitted power and sum to 100 %; a negative part returns power to the source."
    )
    return table("Power ratio by band", head, rows, note=note)


def ranking_words(results: Results) -> str:
    """How the ranking is made."""
    receivers = receiver_names(results)
    return (
        f"In every band the bearings are ranked by net power into {receivers}: the powers of all force and moment "
        "paths of a bearing, summed with their signs over the lines of the band. The bearing that passes most is "
        f"first, the one that returns most last. Shares refer to the power that enters {receivers} in the band, "
        "the sum over the bearings with positive net power; what other bearings return is a negative share of it, and "
        "all shares together are what remains as net transmitted power. Lines with much input power weigh more in the "
        "sums; the mean level weighs all lines alike and may give another order."
    )


def ranking_table(results: Results) -> Table:
    """Bearings by band, the one that passes most power first."""
    head = [
        "",
        "bearing",
        "share of entering power",
        "of input power",
        "|ratio|, dB",
        "by moment",
        "mean level, dB",
        "returns",
    ]
    note = (
        "Negative shares and ratios: net power back into the source. By moment: part of the bearing's net power "
        "carried by its moment paths, negative where they work against it. Mean level: mean of 10 lg |P/P_in| over the "
        "lines. Returns: fraction of the lines on which the bearing carries net power back into the source."
    )
    groups = [
        Group([_rank(k, item) for k, item in enumerate(ranking(results, band), 1)], label)
        for label, band in every_band(results.frequency)
    ]
    return Table("Ranking of the bearings by band power", head, groups, 2, note)


def _rank(k: int, item: Share) -> list[str]:
    return [
        f"{k}.",
        item.name,
        percent(item.share),
        percent(item.ratio),
        _level(item.ratio),
        percent(over(item.moment, item.ratio)),
        decibel(item.mean_level, unit=False),
        percent(item.returned),
    ]


def balance_table(results: Results) -> Table:
    """Share of every element in the dissipated power, by band."""
    labels, every = zip(*every_band(results.frequency))
    shares = np.array([dissipation(results, band) for band in every]).T
    rows = [[name, *(percent(value) for value in row)] for name, row in zip(results.elements, shares)]
    rows.append(["largest residual", *(number(results.residual[band.lines].max(), 2) for band in every)])
    return table("Share of every element in the dissipated power", ["element", *labels], rows)


def natural_table(results: Results) -> Table:
    """Natural frequencies of the assembly within the band, and the power ratio there."""
    inside = results.natural_in_band
    rows = [
        [str(k), number(f, 5), *([number(ratio), _level(ratio)] if results.paths else [])]
        for k, (f, ratio) in enumerate(zip(inside[:LISTED], results.natural_alpha), 1)
    ]
    rigid = int((results.natural == 0.0).sum())
    note = f"The assembly has {plural(len(results.natural), 'mode')}, {rigid} of them at 0 Hz."
    if len(inside) > LISTED:
        note += f" The first {LISTED} of {len(inside)} within the band are listed."
    head = ["no.", "natural frequency, Hz", *(["α there", "α, dB"] if results.paths else [])]
    return table("Assembled machine, undamped natural frequencies within the band", head, rows, note=note)


def free_table(results: Results) -> Table:
    """Free-free natural frequencies of the components."""
    rows = []
    for name, frequencies in results.free.items():
        elastic = frequencies[frequencies > 0.0]
        inside = elastic[elastic <= results.frequency.max()]
        rows.append(
            [
                name,
                ", ".join(number(f, 5) for f in inside[:LISTED]) or ("above the band" if len(elastic) else "none"),
                str(len(frequencies) - len(elastic)),
                str(len(elastic)),
                percent(results.network.modal_damping[name]) if name in results.network.modal_damping else "–",
            ]
        )
    head = ["component", "elastic natural frequencies within the band, Hz", "rigid-body", "elastic", "modal damping"]
    return table("Components alone, free-free", head, rows, text=2, note="All modes are used; none is truncated.")


def validation_table(report: ValidationReport) -> Table:
    """Every check with its figure, its limit and whether it passed."""
    rows = [
        [
            "✓\u00a0passed" if check.passed else "✗\u00a0FAILED",
            check.name,
            check.what,
            number(check.figure),
            number(check.limit),
        ]
        for check in report.checks
    ]
    head = ["result", "check", "what the figure is", "figure", "limit"]
    return table(f"Checks of {report.fmu.name}", head, rows, text=3)
