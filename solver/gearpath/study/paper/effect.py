"""What a change of the machine does to the power ratio: differences of levels, their means over the bands.

D = 10 lg |changed| - 10 lg |original|     of alpha, its force part and its moment part, on the casing side
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, Literal

import numpy as np
import xarray as xr

from ... import api
from ...modelfile import Model
from ...numerics.arrays import Real
from ...report.results import NOTHING

Part = Literal["alpha", "force", "moment"]
PARTS: tuple[Part, ...] = ("alpha", "force", "moment")
PATHS: tuple[Part, ...] = ("force", "moment")
GRID: Real = np.arange(10.0, 5001.0, 10.0)  # Hz
EDGES = (0.0, 1000.0, 2000.0, 3000.0, 5000.0)  # Hz; the lower edge belongs to the band, the last band holds both
BANDS = tuple(f"{low / 1e3:g}–{high / 1e3:g} kHz" for low, high in pairwise(EDGES))


@dataclass(frozen=True)
class Ratios:
    """Power ratios of one machine over the grid; a part that is only rounding is zero."""

    flow: xr.Dataset

    @property
    def frequency(self) -> Real:
        """Hz, (F,)."""
        return np.asarray(self.flow.frequency.values)

    def level(self, part: Part) -> Real:
        """10 lg |ratio|, dB, (F,); minus infinity where no power flows."""
        with np.errstate(divide="ignore"):
            return np.asarray(10.0 * np.log10(abs(self.ratio(part))))

    def ratio(self, part: Part) -> Real:
        """The ratio to the input power, (F,), with its sign; zero where it nowhere exceeds 1e-9 of all path powers."""
        values = np.asarray(self.flow["alpha" if part == "alpha" else f"alpha_{part}"].values)
        gross = abs(self.flow.path_alpha.values).sum(axis=0)
        return values if (abs(values) > NOTHING * gross).any() else np.zeros_like(values)

    @cached_property
    def imbalance(self) -> float:
        """Largest deviation of the dissipated powers' sum from the input power, relative to it."""
        return float(abs(self.flow.dissipated_power.sum("element") / self.flow.input_power - 1.0).max())


def ratios(model: Model, frequency: Real = GRID) -> Ratios:
    """Power ratios of a model at the frequencies, Hz."""
    return Ratios(api.power_flow(model, frequency))


@dataclass(frozen=True)
class Effect:
    """A changed machine beside the original one, on the same frequencies."""

    name: str
    original: Ratios
    changed: Ratios

    def difference(self, part: Part) -> Real:
        """D, dB, (F,); minus infinity where the change ends the flow, NaN where there never was any."""
        with np.errstate(invalid="ignore"):
            return self.changed.level(part) - self.original.level(part)

    def power_difference(self) -> Real:
        """The same of the transmitted power in W, at the same transmission error, dB, (F,)."""
        return np.asarray(10.0 * np.log10(self.changed.flow.transmitted_power / self.original.flow.transmitted_power))

    def means(self, part: Part) -> tuple[float, ...]:
        """Mean of D in every band, dB."""
        return band_means(self.difference(part), self.original.frequency)

    def medians(self, part: Part) -> tuple[float, ...]:
        """Median of |D| in every band, dB."""
        return tuple(float(np.median(abs(d))) for d in by_band(self.difference(part), self.original.frequency))

    def mean(self, part: Part) -> float:
        """Mean of D over all lines, dB."""
        return float(np.mean(self.difference(part)))

    def median(self, part: Part) -> float:
        """Median of |D| over all lines, dB."""
        return float(np.median(abs(self.difference(part))))

    def as_dict(self) -> dict[str, Any]:
        """All figures for machines, dB."""
        return {
            "change": self.name,
            **{
                part: {
                    "mean_by_band": self.means(part),
                    "median_by_band": self.medians(part),
                    "mean": self.mean(part),
                    "median": self.median(part),
                    "vanishes": not self.changed.ratio(part).any(),
                }
                for part in PARTS
            },
            "transmitted_power": {"mean_by_band": band_means(self.power_difference(), self.original.frequency)},
        }


def effects(model: Model, changes: Mapping[str, Mapping[str, Any]]) -> tuple[Ratios, tuple[Effect, ...]]:
    """The original and the effect of every named change on it."""
    original = ratios(model)
    return original, tuple(Effect(name, original, ratios(model.replace(change))) for name, change in changes.items())


def by_band(values: Real, frequency: Real) -> tuple[Real, ...]:
    """The values (..., F) of each band."""
    last = EDGES[-1]
    return tuple(
        values[..., (frequency >= low) & ((frequency < high) | ((high == last) & (frequency == last)))]
        for low, high in pairwise(EDGES)
    )


def band_means(values: Real, frequency: Real) -> tuple[float, ...]:
    """Mean over the lines of each band."""
    return tuple(float(np.mean(part)) for part in by_band(values, frequency))
