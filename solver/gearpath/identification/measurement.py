"""Measured mobilities on both sides of joints: the numbers, how uncertain they are, what reciprocity says."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..numerics.arrays import Complex, Real

_FLOOR = 1e-4  # of sqrt(|Y_ii Y_jj|): a smaller FRF is not known to a fraction of itself
_ACROSS = 1e-2  # of the least direct FRF across a joint: what soft joints transfer stays above the floor
_NOT_NOISE = 0.3  # |Y_ij - Y_ji| in parts of |Y_ij|: below it, a direct FRF is more than a noise floor
_ROUNDING = 1e-12  # of sqrt(|Y_ii Y_jj|): the least floor
_LEAST = 1e-12  # relative noise that rounding makes
_GUESS = 0.01  # relative noise to begin with, where nothing tells it


@dataclass(frozen=True)
class Measurement:
    """Reciprocity-averaged mobilities on F lines of N = 2 n ports: all source sides, then all receiver sides.

    The noise of every measured FRF is independent, complex, circular and Gaussian; `deviation` sqrt(E|e|^2) is that of
    the average of Y_ij and Y_ji.
    """

    omega: Real  # (F,), rad/s
    mobility: Complex  # (F, N, N), symmetric
    deviation: Real | None  # (F, N, N), where it is known absolutely, else relative to the FRFs
    share: Real  # (N, N): of one FRF's deviation, 1 / sqrt(2) where two were averaged
    noise: float | None  # relative, where it is given
    floor: float  # of sqrt(|Y_ii Y_jj|): FRFs below it have its noise
    skew_noise: float | None  # relative noise that Y_ij - Y_ji shows; None where one half mirrors the other

    @classmethod
    def of(cls, omega: Real, mobility: Complex, noise: float | Real | None) -> Measurement:
        """The average of both halves of `mobility` (F, N, N), which need not be symmetric."""
        mean = (mobility + mobility.swapaxes(1, 2)) / 2.0
        mirrored = bool((mobility == mobility.swapaxes(1, 2)).all())
        N = mobility.shape[1]
        floor = _floor(mobility)
        share = np.where(np.eye(N, dtype=bool) | mirrored, 1.0, np.sqrt(0.5))
        skew = None
        if not mirrored:
            i, j = np.triu_indices(N, 1)
            apart = np.abs(mobility[:, i, j] - mobility[:, j, i]) / _size(mean, floor)[:, i, j]
            skew = float(np.sqrt(np.mean(apart**2) / 2.0))
        if noise is None or isinstance(noise, float):
            return cls(omega, mean, None, share, noise, floor, skew)
        both = np.sqrt((noise**2 + noise.swapaxes(1, 2) ** 2) / 2.0)
        return cls(omega, mean, np.asarray(share * both), share, None, floor, skew)

    @property
    def lines(self) -> int:
        """F."""
        return len(self.omega)

    @property
    def size(self) -> Real:
        """Typical sqrt(|Y_ii|) of every port, (N,)."""
        return np.asarray(np.median(np.sqrt(np.abs(np.einsum("fii->fi", self.mobility))), axis=0))

    @property
    def known_noise(self) -> float | None:
        """Relative noise that was given or that reciprocity shows, None where only the fit can tell it."""
        if self.deviation is not None:
            return 1.0
        return self.noise if self.skew_noise is None or self.noise is not None else max(self.skew_noise, _LEAST)

    @property
    def first_noise(self) -> float:
        """Relative noise before anything is fitted; 1 where deviations are known absolutely."""
        return _GUESS if self.known_noise is None else self.known_noise

    def unit_deviation(self, mobility: Complex) -> Real:
        """Deviations for a relative noise of 1 of FRFs of that size, (F, N, N); the known ones where they are."""
        return np.asarray(self.share * _size(mobility, self.floor)) if self.deviation is None else self.deviation

    def on(self, lines: slice | NDArray[Any]) -> Measurement:
        """Some lines only."""
        chosen = None if self.deviation is None else self.deviation[lines]
        omega, mobility = self.omega[lines], self.mobility[lines]
        return Measurement(omega, mobility, chosen, self.share, self.noise, self.floor, self.skew_noise)


def _own(mobility: Complex) -> Real:
    """sqrt(|Y_ii Y_jj|), (F, N, N)."""
    own = np.sqrt(np.abs(np.einsum("fii->fi", mobility)))
    return np.asarray(own[:, :, None] * own[:, None, :])


def _size(mobility: Complex, floor: float) -> Real:
    return np.asarray(np.maximum(np.abs(mobility), floor * _own(mobility)))


def _floor(mobility: Complex) -> float:
    """The usual floor, or less where joints are so soft that little crosses them, unless that is noise."""
    n = mobility.shape[1] // 2
    relative = mobility / _own(mobility)
    across = np.median(np.abs(np.einsum("fii->fi", relative[:, :n, n:])), axis=0)
    skew = np.median(np.abs(np.einsum("fii->fi", (relative - relative.swapaxes(1, 2))[:, :n, n:])), axis=0)
    told = across[skew <= _NOT_NOISE * across]
    return float(np.clip(_ACROSS * told.min(initial=1.0), _ROUNDING, _FLOOR))
