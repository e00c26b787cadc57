"""Band sums: how much of the input power each bearing passes, and the order of the bearings."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..numerics.arrays import Real
from .results import Results

EDGES = (0.0, 1000.0, 2000.0, 3000.0, 5000.0)  # Hz; the bands of the study


@dataclass(frozen=True)
class Band:
    """A frequency band and its lines; the lower edge belongs to it, the upper one to the next."""

    low: float  # Hz
    high: float
    lines: NDArray[np.bool_]  # (F,)

    @property
    def label(self) -> str:
        """Such as `1–2 kHz`."""
        return f"{self.low / 1000.0:g}–{self.high / 1000.0:g} kHz"


@dataclass(frozen=True)
class Share:
    """Net power through some paths in a band, summed over its lines; NaN where the reference power is zero."""

    name: str
    ratio: float  # to the input power
    share: float  # of the net power through all paths
    exchange: float  # of the sum of the absolute net powers of all bearings, from -1 to 1
    force: float  # part of the force paths in `ratio`
    moment: float  # part of the moment paths in `ratio`
    mean_level: float  # mean over the lines of 10 lg |P / P_input|, lines without any power left out, dB
    returned: float  # fraction of the lines on which power goes back into the source


def bands(frequency: Real) -> tuple[Band, ...]:
    """0-1, 1-2, 2-3, 3-5 kHz (and what lies above), clipped to the lines that there are."""
    top = float(frequency.max())
    edges = [edge for edge in EDGES if edge < top] + [top]
    found = []
    for low, high in zip(edges[:-1], edges[1:]):
        lines = (frequency >= low) & ((frequency < high) | ((high == top) & (frequency == top)))
        if lines.any():
            found.append(Band(max(low, float(frequency.min())), high, lines))
    return tuple(found)


def whole_band(frequency: Real) -> Band:
    """All lines."""
    return Band(float(frequency.min()), float(frequency.max()), np.ones(len(frequency), bool))


def share(results: Results, band: Band, name: str, chosen: NDArray[np.bool_]) -> Share:
    """What the chosen paths (p,) pass in a band, together."""
    lines = band.lines
    power = results.path_power[:, lines]
    entering = float(results.input_power[lines].sum())
    alpha = results.path_alpha[chosen][:, lines].sum(axis=0)
    exchanged = sum(abs(power[results.of_bearing(bearing)].sum()) for bearing in results.bearings)
    carried = alpha[alpha != 0.0]
    return Share(
        name,
        ratio=_over(power[chosen].sum(), entering),
        share=_over(power[chosen].sum(), power.sum()),
        exchange=_over(power[chosen].sum(), exchanged),
        force=_over(power[chosen & ~results.moment].sum(), entering),
        moment=_over(power[chosen & results.moment].sum(), entering),
        mean_level=float(np.mean(10.0 * np.log10(abs(carried)))) if len(carried) else float("-inf"),
        returned=float(np.mean(alpha < 0.0)),
    )


def total(results: Results, band: Band) -> Share:
    """What all paths pass in a band."""
    return share(results, band, "all bearings", np.ones(len(results.paths), bool))


def ranking(results: Results, band: Band) -> tuple[Share, ...]:
    """All bearings, the one that passes most of the band's power first."""
    shares = [share(results, band, name, results.of_bearing(name)) for name in results.bearings]
    return tuple(sorted(shares, key=lambda item: (-item.ratio, item.name)))


def dissipation(results: Results, band: Band) -> Real:
    """Share of every element in the power dissipated in a band, (e,); NaN where nothing is dissipated."""
    lost = results.dissipated_power[:, band.lines].sum(axis=1)
    return np.array([_over(value, lost.sum()) for value in lost])


def _over(part: float, whole: float) -> float:
    return float(part / whole) if whole else float("nan")
