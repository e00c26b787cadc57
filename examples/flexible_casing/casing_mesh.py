"""The casing as 20-node bricks: a plan of quadrilaterals round the bores, stretched along z, layer by layer.

A box of cast walls on a base plate whose corners are the feet, with a boss round the bore of each bearing.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import skfem

# x, y, z as in models/helical_gearbox.toml, m
PLATE = ((-0.125, 0.145), (-0.100, -0.085), (-0.105, 0.115))
OUTER = ((-0.105, 0.135), (-0.085, 0.090), (-0.056, 0.076))  # of the box, which stands on the plate
INNER = ((-0.095, 0.125), (-0.085, 0.080), (-0.044, 0.064))
BOSSES = ((-0.060, -0.040), (0.060, 0.080))  # along z, in both end walls
FOOT_SIZE = 0.030  # square pads under the plate
FEET = {  # centres of the pads, where models/helical_gearbox.toml has its mounts
    "foot_1": (-0.11, -0.10, -0.09),
    "foot_2": (0.13, -0.10, -0.09),
    "foot_3": (-0.11, -0.10, 0.10),
    "foot_4": (0.13, -0.10, 0.10),
}


@dataclass(frozen=True)
class Bore:
    """Along z at x, y = 0: radii of the bore and of its boss, and the rectangle of the plan about both (m)."""

    x: float
    radius: float
    boss: float
    block: tuple[tuple[float, float], tuple[float, float]]


BORES = (  # outer rings of 7206 and 7207
    Bore(-0.05, 0.031, 0.041, ((-0.095, 0.0), (-0.055, 0.055))),
    Bore(0.05, 0.036, 0.045, ((0.0, 0.1), (-0.055, 0.055))),
)
SEATS = {
    f"seat_{2 * i + k + 1}": (bore, (low + high) / 2.0)
    for i, bore in enumerate(BORES)
    for k, (low, high) in enumerate(BOSSES)
}


def corners(size: float) -> int:
    """Corners of the polygons that stand for circles, for elements up to `size` (m) long."""
    return 4 * max(2, int(np.ceil(0.1 / size)))


def casing_mesh(size: float) -> skfem.MeshHex:
    """Hexahedra up to about `size` (m) long, one through each wall."""
    places, quads, is_ring = plan(size)
    bosses = [z for boss in BOSSES for z in boss]
    pads = [z + half for _, _, z in FEET.values() for half in (-FOOT_SIZE / 2, FOOT_SIZE / 2)]
    heights = divided([*PLATE[2], *OUTER[2], *INNER[2], *bosses, *pads], size)
    x, y = places[:, quads].mean(axis=1)
    count, elements = places.shape[1], []
    for layer, (low, high) in enumerate(pairwise(heights)):
        z = (low + high) / 2.0
        a, b, c, d = quads[:, filled(x, y, z, is_ring)] + layer * count
        elements.append([a, a + count, d, b, d + count, b + count, c, c + count])
    points = np.vstack([np.tile(places, len(heights)), np.repeat(heights, count)])
    used, numbers = np.unique(np.hstack(elements), return_inverse=True)
    return skfem.MeshHex(np.ascontiguousarray(points[:, used]), np.ascontiguousarray(numbers.reshape(8, -1)))


def filled(x: np.ndarray, y: np.ndarray, z: float, is_ring: np.ndarray) -> np.ndarray:
    """Which quadrilaterals with these centres are cast iron at the height z."""
    box = inside(OUTER[0], x) & inside(OUTER[1], y) & inside(OUTER[2], z)
    cavity = inside(INNER[0], x) & inside(INNER[1], y) & inside(INNER[2], z)
    boss = is_ring & any(inside(part, z) for part in BOSSES)
    return np.asarray((y < PLATE[1][1]) | (box & ~cavity) | boss)


def inside(limits: tuple[float, float], values: np.ndarray | float) -> np.ndarray:
    """Whether values lie between the limits."""
    return np.asarray((limits[0] < values) & (values < limits[1]))


def plan(size: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points (2, N), quadrilaterals (4, M) anticlockwise, and which of them form the bosses (M,)."""
    sides = corners(size) // 4
    blocks = [np.linspace(*bore.block[0], sides + 1) for bore in BORES]
    pads = [x + half for x, _, _ in FEET.values() for half in (-FOOT_SIZE / 2, FOOT_SIZE / 2)]
    outside = [x for x in (*PLATE[0], *OUTER[0], *INNER[0], *pads) if not inside((-0.095, 0.1), x)]
    left, right = ([x for x in outside if (x < 0.0) == is_left] for is_left in (True, False))
    xs = np.unique(np.round([*divided([*left, -0.095], size), *np.hstack(blocks), *divided([0.1, *right], size)], 9))
    side = BORES[0].block[1]
    ys = np.unique(
        np.round(
            [
                *divided([*PLATE[1], side[0]], size),
                *np.linspace(*side, sides + 1),
                *divided([side[1], INNER[1][1], OUTER[1][1]], size),
            ],
            9,
        )
    )
    shapes = [grid(xs, ys)]
    rings = [np.zeros(shapes[0].shape[2], bool)]
    for bore in BORES:
        bore_line, boss_line, edge = lines(bore, sides)
        for inner, outer, is_boss in ((bore_line, boss_line, True), (boss_line, edge, False)):
            shapes.append(ring(inner, outer))
            rings.append(np.full(shapes[-1].shape[2], is_boss))
    every = np.concatenate(shapes, axis=2)  # (2, 4, M)
    _, first, numbers = np.unique(np.round(every.reshape(2, -1), 7), axis=1, return_index=True, return_inverse=True)
    return every.reshape(2, -1)[:, first], numbers.reshape(4, -1), np.concatenate(rings)


def divided(places: list[float], size: float) -> np.ndarray:
    """The places in order, and between them points no more than `size` apart."""
    ends = np.unique(np.round(places, 9))
    parts = [np.linspace(a, b, int(np.ceil((b - a) / size - 1e-6)), endpoint=False) for a, b in pairwise(ends)]
    return np.append(np.hstack(parts), ends[-1])


def grid(xs: np.ndarray, ys: np.ndarray) -> np.ndarray:
    """Corners (2, 4, M) of the rectangles between lines, but for those of the blocks."""
    x0, y0 = (lines.ravel() for lines in np.meshgrid(xs[:-1], ys[:-1]))
    x1, y1 = (lines.ravel() for lines in np.meshgrid(xs[1:], ys[1:]))
    x, y = (x0 + x1) / 2, (y0 + y1) / 2
    free = ~np.any([inside(bore.block[0], x) & inside(bore.block[1], y) for bore in BORES], axis=0)
    return np.array([[x0, x1, x1, x0], [y0, y0, y1, y1]])[:, :, free]


def lines(bore: Bore, sides: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Closed lines (2, 4 sides) anticlockwise from the lower left: bore, boss, and the edge of the block."""
    angle = -0.75 * np.pi + 0.5 * np.pi / sides * np.arange(4 * sides)
    circle = np.array([np.cos(angle), np.sin(angle)])
    (x0, x1), (y0, y1) = bore.block
    part, along = np.arange(sides) / sides, np.ones(sides)
    edge = np.array(
        [
            np.hstack([x0 + (x1 - x0) * part, x1 * along, x1 + (x0 - x1) * part, x0 * along]),
            np.hstack([y0 * along, y0 + (y1 - y0) * part, y1 * along, y1 + (y0 - y1) * part]),
        ]
    )
    centre = np.array([[bore.x], [0.0]])
    return centre + bore.radius * circle, centre + bore.boss * circle, edge


def ring(inner: np.ndarray, outer: np.ndarray) -> np.ndarray:
    """Corners (2, 4, M) of the quadrilaterals between two closed lines."""
    return np.stack([inner, outer, np.roll(outer, -1, axis=1), np.roll(inner, -1, axis=1)], axis=1)
