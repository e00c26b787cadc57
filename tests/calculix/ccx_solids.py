"""Solid parts of 20-node bricks: plates on a grid and round bars."""

from itertools import pairwise

import numpy as np

# corners of the lower face, of the upper face, then the middles of the lower, upper and upright edges (C3D20)
_CORNERS = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
_MIDDLES = [(0, -1), (1, 0), (0, 1), (-1, 0)]
_HEIGHTS = np.repeat([-1, 1, -1, 1, 0], 4)
_QUAD_NODES = np.concatenate([np.arange(4), np.arange(4), np.arange(4, 8), np.arange(4, 8), np.arange(4)])


def plate(x, y, z, thickness, layers=1):
    """Bricks (e, 20, 3) of a plate normal to z between the grid lines x and y, its middle surface at z."""
    middle = np.array([[(a + b) / 2, (c + d) / 2] for a, b in _spans(x) for c, d in _spans(y)])
    half = np.array([[(b - a) / 2, (d - c) / 2] for a, b in _spans(x) for c, d in _spans(y)])
    quads = middle[:, None] + half[:, None] * np.array(_CORNERS + _MIDDLES)
    return _extrude(quads, z + thickness * np.linspace(-0.5, 0.5, layers + 1))


def round_bar(diameter, start, length, elements):
    """Bricks of a solid cylinder along +z from the point start; 12 across the section, curved at the rim.

    The rim of eight parabolas holds 0.08 % less area than the circle.
    """
    quads = _disc(diameter / 2) + np.array(start[:2])
    return _extrude(quads, start[2] + length * np.linspace(0.0, 1.0, elements + 1))


def _disc(radius):
    """Eight-node quadrilaterals (12, 8, 2): four about the centre, eight around them."""
    angles = np.pi / 4 * np.arange(8)
    rays = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    rim, core = radius * rays, radius * rays * np.where(np.arange(8) % 2, 0.56, 0.5)[:, None]
    bulge = radius * np.stack([np.cos(angles + np.pi / 8), np.sin(angles + np.pi / 8)], axis=1)
    quads = [_quad([(0.0, 0.0), core[k], core[k + 1], core[(k + 2) % 8]]) for k in range(0, 8, 2)]
    for k in range(8):
        ring = _quad([core[k], rim[k], rim[(k + 1) % 8], core[(k + 1) % 8]])
        ring[5] = bulge[k]  # the middle of the outer edge lies on the circle
        quads.append(ring)
    return np.array(quads)


def _quad(corners):
    corners = np.array(corners)
    return np.concatenate([corners, (corners + np.roll(corners, -1, axis=0)) / 2])


def _extrude(quads, levels):
    bricks = []
    for low, high in _spans(levels):
        z = (low + high) / 2 + _HEIGHTS * (high - low) / 2
        bricks += [np.column_stack([quad[_QUAD_NODES], z]) for quad in quads]
    return np.array(bricks)


def _spans(lines):
    return list(pairwise(lines))
