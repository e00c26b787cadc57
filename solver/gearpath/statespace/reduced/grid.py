"""Frequencies that resolve every resonance of a band, and the places between them where a maximum hides."""

import numpy as np

from ...numerics.arrays import Complex, Real

_BACKGROUND = 400
_STEPS = 12  # to each side of a resonance
_SHARPEST = 1e-7  # half width of an undamped resonance that the grid assumes, relative to its frequency


def resonant_grid(poles: Complex, band: tuple[float, float], thinned: int = 1) -> Real:
    """Angular frequencies of a band (rad/s): evenly spaced, and around every pole (rad/s) in steps of its width.

    `thinned` times fewer for a first look.
    """
    low, high = band
    steps = np.geomspace(0.2, 60.0, _STEPS // thinned)  # half widths
    widths = np.concatenate([-steps[::-1], [0.0], steps])
    near = poles[(poles.imag > 0.5 * low) & (poles.imag < 2.0 * high)]
    width = np.maximum(-near.real, _SHARPEST * near.imag)
    around = (near.imag[:, None] + width[:, None] * widths).ravel()
    even = np.concatenate(
        [np.linspace(low, high, _BACKGROUND // thinned), np.geomspace(low, high, _BACKGROUND // (2 * thinned))]
    )
    return np.unique(np.concatenate([even, around[(around > low) & (around < high)]]))


def between(grid: Real, places: np.ndarray[tuple[int], np.dtype[np.intp]], points: int = 8) -> Real:
    """New points on both sides of some places of the grid, `points` in each gap."""
    gaps = np.unique(np.concatenate([places - 1, places]))
    gaps = gaps[(gaps >= 0) & (gaps < len(grid) - 1)]
    parts = np.arange(1, points + 1) / (points + 1)
    return np.unique((grid[gaps, None] * (1.0 - parts) + grid[gaps + 1, None] * parts).ravel())
