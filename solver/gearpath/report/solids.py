"""Solids in space as shaded polygons on matplotlib axes, and the view that they are drawn from.

Orthographic, from above: z runs to the right, y upwards, x away from the viewer.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..numerics.arrays import Real

INK = "#1d2733"
TURN, TILT = np.radians(33.0), np.radians(27.0)  # of the view, about the vertical and downwards
LIGHT = np.array([-0.45, 0.8, 0.4]) / np.linalg.norm([-0.45, 0.8, 0.4])  # towards the light, in (z, y, -x)
_END = (1.0, 0.0, 0.0)  # normal of the near end of a shaft, in (z, y, -x)


def to_page(points: Any) -> Real:
    """Points (x, y, z) in m, (..., 3), as page coordinates (..., 2) in mm."""
    x, y, z = np.moveaxis(np.asarray(points, float), -1, 0)
    across = z * np.cos(TURN) + x * np.sin(TURN)
    towards = z * np.sin(TURN) - x * np.cos(TURN)
    return 1e3 * np.stack([across, y * np.cos(TILT) - towards * np.sin(TILT)], axis=-1)


def outline(radius: float, teeth: int = 0) -> Real:
    """A circle, or a gear's outline, (n, 2)."""
    if not teeth:
        angle, r = np.linspace(0.0, 2.0 * np.pi, 49)[:-1], np.full(48, radius)
    else:
        pitch = 2.0 * np.pi / teeth
        angle = (np.arange(teeth)[:, None] * pitch + pitch * np.array([0.0, 0.28, 0.42, 0.86])).ravel()
        r = radius + np.tile([0.0028, 0.0028, -0.0032, -0.0032], teeth)
    return np.stack([r * np.cos(angle), r * np.sin(angle)], axis=1)


def cylinder(axes: Any, centre: tuple[float, float], low: float, high: float, profile: Real, colour: str) -> None:
    """A prism along z: the sides that face the viewer, then its near end."""
    ring = profile + np.array(centre)
    ends = [np.column_stack([ring, np.full(len(ring), z)]) for z in (low, high)]
    following = np.roll(np.arange(len(ring)), -1)
    step = ring[following] - ring
    normals = np.stack([step[:, 1], -step[:, 0]], axis=1) / np.linalg.norm(step, axis=1)[:, None]
    facing = -normals[:, 0] * np.cos(TURN) * np.cos(TILT) + normals[:, 1] * np.sin(TILT)
    for k in sorted(np.flatnonzero(facing > 0.0), key=lambda k: facing[k]):
        j = following[k]
        shade = _lit(colour, (0.0, normals[k, 1], -normals[k, 0]))
        polygon(axes, [ends[0][k], ends[0][j], ends[1][j], ends[1][k]], shade, shade, width=0.35)
    disk(axes, centre, high, profile, colour)


def _lit(colour: str, normal: Sequence[float], extra: float = 0.0) -> str:
    """A colour under the light: 60 to 108 %."""
    share = min(1.08, 0.6 + 0.48 * max(0.0, float(np.dot(normal, LIGHT))) + extra)
    return "#" + "".join(f"{min(255, round(share * int(colour[i : i + 2], 16))):02x}" for i in (1, 3, 5))


def disk(axes: Any, centre: tuple[float, float], z: float, ring: Real, colour: str) -> None:
    """The near end of a prism along z."""
    face = np.column_stack([ring + np.array(centre), np.full(len(ring), z)])
    polygon(axes, face, _lit(colour, _END, 0.38), INK, width=0.7)


def polygon(axes: Any, points: Any, face: str, edge: str, width: float = 0.8, alpha: float = 1.0) -> None:
    from matplotlib.colors import to_rgba
    from matplotlib.patches import Polygon

    page = to_page(points)
    axes.add_patch(Polygon(page, facecolor=to_rgba(face, alpha), edgecolor=edge, linewidth=width, joinstyle="round"))
    axes.update_datalim(page)
