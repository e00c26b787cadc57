"""Grid lines along one axis of a plate: on every footprint edge, finer towards the footprints."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from ..numerics.arrays import Real

_SAME = 1e-9  # edges closer than this part of the length are one
_SNAP = 0.1  # a point closer than this part of the spacing to an edge gets no line of its own
_REACH = 2.0  # widths of a footprint over which the spacing grows from its own to that of the plate
_SAMPLES = 256  # of the spacing in each span


def grid_lines(
    length: float, elements: int, edges: Sequence[tuple[float, float]], points: Sequence[float], across: int
) -> Real:
    """Coordinates of the grid lines from -length/2 to length/2, m.

    The spacing is length / elements, and width / across within a footprint with the edges (a, b), from where it grows
    linearly over two widths. Each edge gets a line; so does each of the points that is not next to a line anyway.
    Doubling `elements` and `across` halves the spacing everywhere.
    """
    stops = _distinct([-length / 2.0, length / 2.0, *(x for edge in edges for x in edge)], _SAME * length)
    coarse = length / elements
    for point in points:
        if abs(stops - point).min() > _SNAP * float(_spacing(np.array([point]), coarse, edges, across)[0]):
            stops = np.sort([*stops, point])
    lines = [stops[:1]]
    for start, end in pairwise(stops):
        x = np.linspace(start, end, _SAMPLES + 1)
        middles = (x[:-1] + x[1:]) / 2.0
        filled = np.concatenate([[0.0], np.cumsum(np.diff(x) / _spacing(middles, coarse, edges, across))])
        count = max(1, int(np.ceil(filled[-1] - 1e-6)))
        lines.append(np.interp(np.arange(1, count + 1) * filled[-1] / count, filled, x))
        lines[-1][-1] = end
    return np.concatenate(lines)


def _spacing(x: Real, coarse: float, edges: Sequence[tuple[float, float]], across: int) -> Real:
    """Wanted spacing of the lines at x."""
    wanted = np.full(x.shape, coarse)
    for low, high in edges:
        width = high - low
        if width > 0.0:
            fine = min(coarse, width / across)
            away = np.maximum(np.maximum(low - x, x - high), 0.0)
            wanted = np.minimum(wanted, fine + (coarse - fine) * np.minimum(1.0, away / (_REACH * width)))
    return wanted


def _distinct(values: Sequence[float], tolerance: float) -> Real:
    ordered = np.sort(values)
    return np.asarray(ordered[np.concatenate([[True], np.diff(ordered) > tolerance])])
