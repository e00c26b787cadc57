"""Mass and inertia of the casing in closed form: prisms on rectangles and regular polygons, added and cut out."""

from dataclasses import dataclass

import numpy as np
from casing_mesh import BORES, BOSSES, INNER, OUTER, PLATE, corners


@dataclass(frozen=True)
class MassProperties:
    """Mass (kg), centre of gravity (3,) in m, and inertia (3, 3) about it in kg m^2, products with their signs."""

    mass: float
    centre: np.ndarray
    inertia: np.ndarray


def of_moments(moments: np.ndarray) -> MassProperties:
    """From the integrals of rho (1, x, y, z) times (1, x, y, z), (4, 4)."""
    mass, centre = moments[0, 0], moments[0, 1:] / moments[0, 0]
    second = moments[1:, 1:] - mass * np.outer(centre, centre)
    return MassProperties(float(mass), centre, np.trace(second) * np.eye(3) - second)


def closed_form(density: float, size: float) -> MassProperties:
    """Of the casing whose circles are polygons with `corners(size)` corners."""
    count = corners(size)
    total = box(*PLATE) + box(*OUTER) - box(*INNER)
    for k, boss in enumerate(BOSSES):
        wall = sorted((OUTER[2][k], INNER[2][k]))
        for bore in BORES:
            for low, high in ((boss[0], wall[0]), (wall[1], boss[1])):
                total += polygon(bore.x, bore.boss, count, low, high)
                total -= polygon(bore.x, bore.radius, count, low, high)
            total -= polygon(bore.x, bore.radius, count, wall[0], wall[1])
    return of_moments(density * total)


def box(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> np.ndarray:
    """Integrals of (1, x, y, z) times (1, x, y, z) over a cuboid."""
    lengths, centre = np.array([b - a for a, b in (x, y, z)]), np.array([(a + b) / 2 for a, b in (x, y, z)])
    return moved(float(np.prod(lengths)), centre, lengths**2 / 12.0)


def polygon(x: float, radius: float, count: int, low: float, high: float) -> np.ndarray:
    """The same over a prism along z on a regular polygon about (x, 0), `radius` that of its corners."""
    area = 0.5 * count * radius**2 * np.sin(2.0 * np.pi / count)
    edge = 2.0 * radius * np.sin(np.pi / count)
    own = (6.0 * radius**2 - edge**2) / 24.0
    centre = np.array([x, 0.0, (low + high) / 2.0])
    return moved(area * (high - low), centre, np.array([own, own, (high - low) ** 2 / 12.0]))


def moved(volume: float, centre: np.ndarray, own: np.ndarray) -> np.ndarray:
    """From mean squares about its own centre (3,)."""
    place = np.append(1.0, centre)
    return volume * (np.outer(place, place) + np.diag(np.append(0.0, own)))
