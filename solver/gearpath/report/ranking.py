"""Band sums: how much of the input power each bearing passes, and the order of the bearings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..numerics.arrays import Real
from .results import NOISE, Results
from .wording import listed

EDGES = (0.0, 1000.0, 2000.0, 3000.0, 5000.0)  # Hz; the bands of the study
TIE = 1e-9  # shares that differ by less are equal but for rounding


@dataclass(frozen=True)
class Band:
    """A frequency band and its lines; the lower edge belongs to it, the upper one to the next."""

    low: float  # Hz
    high: float
    lines: NDArray[np.bool_]  # (F,)

    @property
    def label(self) -> str:
        """Such as `20–1000 Hz`, `1–2 kHz` or `20 Hz–5 kHz`."""
        if self.high <= 1000.0:
            return f"{self.low:g}–{self.high:g}\u00a0Hz"
        low = f"{self.low / 1000.0:g}" if self.low >= 1000.0 else f"{self.low:g}\u00a0Hz"
        return f"{low}–{self.high / 1000.0:g}\u00a0kHz"


@dataclass(frozen=True)
class Share:
    """Net power through some paths in a band, summed over its lines; NaN where the reference power is zero."""

    name: str
    ratio: float  # to the input power
    share: float  # of the power that enters the receivers: the sum over the bearings whose net power is positive
    force: float  # part of the force paths in `ratio`
    moment: float  # part of the moment paths in `ratio`
    mean_level: float  # mean over the lines of 10 lg |P / P_input|, lines without any power left out, dB
    returned: float  # fraction of the lines on which power goes back into the source


def bands(frequency: Real) -> tuple[Band, ...]:
    """0-1, 1-2, 2-3, 3-5 kHz (and what lies above), clipped to the lines that there are."""
    top = float(frequency.max())
    edges = [edge for edge in EDGES if edge < top] + [top]
    found = []
    for low, high in pairwise(edges):
        lines = (frequency >= low) & ((frequency < high) | ((high == top) & (frequency == top)))
        if lines.any():
            found.append(Band(max(low, float(frequency.min())), high, lines))
    return tuple(found)


def whole_band(frequency: Real) -> Band:
    """All lines."""
    return Band(float(frequency.min()), float(frequency.max()), np.ones(len(frequency), bool))


def every_band(frequency: Real) -> list[tuple[str, Band]]:
    """All bands with what to call them, the whole band last if there are several."""
    found = bands(frequency)
    whole = [("whole band", whole_band(frequency))] if len(found) > 1 else []
    return [*((band.label, band) for band in found), *whole]


def share(results: Results, band: Band, name: str, chosen: NDArray[np.bool_]) -> Share:
    """What the chosen paths (p,) pass in a band, together."""
    lines = band.lines
    power = results.path_power[:, lines]
    threshold = NOISE * abs(power).sum()
    alpha = results.path_alpha[chosen][:, lines].sum(axis=0)
    carried = alpha[alpha != 0.0]

    def net(rows: NDArray[np.bool_]) -> float:
        passed = float(power[rows].sum())
        return passed if abs(passed) > threshold else 0.0

    supplied = float(results.input_power[lines].sum())
    entering = sum(max(net(results.of_bearing(bearing)), 0.0) for bearing in results.bearings)
    return Share(
        name,
        ratio=over(net(chosen), supplied),
        share=over(net(chosen), entering),
        force=over(net(chosen & ~results.moment), supplied),
        moment=over(net(chosen & results.moment), supplied),
        mean_level=float(np.mean(10.0 * np.log10(abs(carried)))) if len(carried) else float("-inf"),
        returned=float(np.mean(alpha < 0.0)),
    )


def total(results: Results, band: Band) -> Share:
    """What all paths pass in a band."""
    return share(results, band, "all bearings", np.ones(len(results.paths), bool))


def ranking(results: Results, band: Band) -> tuple[Share, ...]:
    """All bearings, the one that passes most of the band's power first, the one that returns most last.

    Bearings that differ by rounding alone, as those of a symmetric machine do, stand in the order of their names.
    """
    shares = [share(results, band, name, results.of_bearing(name)) for name in results.bearings]
    groups: list[list[Share]] = []
    for item in sorted(shares, key=lambda item: -item.ratio):
        if groups and alike(groups[-1][0], item):
            groups[-1].append(item)
        else:
            groups.append([item])
    return tuple(item for group in groups for item in sorted(group, key=lambda item: item.name))


def leaders(order: Sequence[Share]) -> list[Share]:
    """The bearing that passes most, or all that pass as much; none if no bearing passes power on."""
    return [item for item in order if item.ratio > 0.0 and alike(order[0], item)]


def alike(one: Share, other: Share) -> bool:
    """Whether two shares of a band differ by rounding alone."""
    return one.ratio == other.ratio or abs(one.share - other.share) <= TIE


def supplied(results: Results, band: Band) -> float:
    """Part of the whole input power that enters in a band."""
    return over(float(results.input_power[band.lines].sum()), float(results.input_power.sum()))


def dissipation(results: Results, band: Band) -> Real:
    """Share of every element in the power dissipated in a band, (e,); NaN where nothing is dissipated."""
    lost = results.dissipated_power[:, band.lines].sum(axis=1)
    return np.array([over(float(value), float(lost.sum())) for value in lost])


def receiver_names(results: Results) -> str:
    """The components that the bearings pass power into: `the receiver casing`."""
    ends = (results.system.joints[bearing].between[1].component for bearing in results.bearings)
    names = list(dict.fromkeys(ends))
    return f"the receiver{'s' if len(names) > 1 else ''} {listed(names)}"


def over(part: float, whole: float) -> float:
    """part / whole; NaN where there is no whole."""
    return part / whole if whole else float("nan")
