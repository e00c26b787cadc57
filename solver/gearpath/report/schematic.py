"""A machine drawn in space from its own data: shafts, gears, bearings, casing, mounts, line of action.

Lengths and radii of shafts and gears are to scale; the model says nothing about the shape of a casing, so that one is
drawn as a tray with two walls, and mounts as springs below it. Rigid joints are not drawn.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from ..components import GearTrain
from ..joints import RIGID
from ..network.ports import joint_place
from ..numerics.arrays import Real
from .solids import INK, cylinder, disk, outline, polygon, to_page

if TYPE_CHECKING:
    from ..components import Shaft
    from ..modelfile import Model

FORCE, MOMENT, GREY = "#0072b2", "#d55e00", "#6b7783"
STEEL, BRASS, BEARING, CASING = "#c3ccd6", "#d9c08a", "#5aa2d0", "#e9edf1"
FACE = 0.024  # m, drawn width of a gear; the model has none
SLICES = 12  # of a tapered section


def draw(axes: Any, model: Model) -> None:
    """Draw the machine on matplotlib axes, far parts first."""
    places = [
        (name, "mount" if any(port.is_ground for port in joint.between) else "bearing", np.array(at))
        for name, joint in model.system.joints.items()
        if joint.kind != RIGID and (at := joint_place(model.system, joint)) is not None
    ]
    trains = [part for part in model.system.components.values() if isinstance(part, GearTrain)]
    tray = _Tray.around(places, trains)
    for name, kind, place in sorted(places, key=lambda item: -item[2][0]):
        if kind != "bearing":
            _spring(axes, place, tray, name)
    tray.draw(axes, near=False)
    for train in trains:
        for name, shaft in sorted(train.shafts.items(), key=lambda item: -item[1].origin[0]):
            _axle(axes, train, name, shaft, [p for _, kind, p in places if kind == "bearing"])
    tray.draw(axes, near=True)
    for name, kind, place in places:
        if kind == "bearing":
            _note_bearing(axes, name, place, tray)
    for train in trains:
        _note_meshes(axes, train)
    _triad(axes, tray)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.margins(0.03)
    axes.axis("off")


@dataclass(frozen=True)
class _Tray:
    """The casing: a floor and a wall at either end of the shafts, m."""

    low: Real  # (x, y, z)
    high: Real

    @classmethod
    def around(cls, places: Sequence[tuple[str, str, Real]], trains: Sequence[GearTrain]) -> _Tray:
        """Around all joints, deep enough for the largest gear."""
        points = np.array([place for _, _, place in places] or [np.zeros(3)])
        radii = [r for train in trains for mesh in train.meshes.values() for r in mesh.base_radii]
        walls = np.array([p for _, kind, p in places if kind == "bearing"] or points)
        depth = 1.35 * max(radii, default=0.05)
        low = np.array([points[:, 0].min() - 0.02, walls[:, 1].min() - depth, walls[:, 2].min()])
        high = np.array([points[:, 0].max() + 0.02, walls[:, 1].max() + 0.6 * depth, walls[:, 2].max()])
        return cls(low, high)

    def draw(self, axes: Any, near: bool) -> None:
        """Floor and far wall before the shafts, near wall (transparent) after them."""
        (x0, y0, z0), (x1, y1, z1) = self.low, self.high
        if near:
            wall = [(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)]
            polygon(axes, wall, "#b8c3ce", INK, alpha=0.28)
            return
        margin = 0.02
        floor = [(x0, y0, z0 - margin), (x1, y0, z0 - margin), (x1, y0, z1 + margin), (x0, y0, z1 + margin)]
        skirt = [(x0, y0, z0 - margin), (x0, y0, z1 + margin), (x0, y0 - 0.008, z1 + margin)]
        skirt.append((x0, y0 - 0.008, z0 - margin))
        side = [(x0, y0, z1 + margin), (x1, y0, z1 + margin), (x1, y0 - 0.008, z1 + margin)]
        side.append((x0, y0 - 0.008, z1 + margin))
        polygon(axes, floor, "#f3f5f7", INK)
        polygon(axes, skirt, "#cdd5dd", INK)
        polygon(axes, side, "#b8c3ce", INK)
        polygon(axes, [(x0, y0, z0), (x1, y0, z0), (x1, y1, z0), (x0, y1, z0)], CASING, INK)


def _axle(axes: Any, train: GearTrain, name: str, shaft: Shaft, bearings: Sequence[Real]) -> None:
    """A shaft with its bearings and gears, from its far end to its near one."""
    x, y, z0 = shaft.origin
    own = [place for place in bearings if np.allclose(place[:2], (x, y), atol=1e-9)]
    parts: list[tuple[float, float, float, str, int]] = []  # from z, to z, radius, colour, teeth
    at = z0
    for section in shaft.sections:
        count = SLICES if section.tapered else 1
        for piece in (section.part(k / count, (k + 1) / count) for k in range(count)):
            parts.append((at, at + piece.length, piece.diameters(0.5)[0] / 2.0, STEEL, 0))
            at += piece.length
    thickest = max(max(section.diameters(0.0)[0], section.diameters(1.0)[0]) for section in shaft.sections) / 2.0
    parts += [(place[2] - 0.006, place[2] + 0.006, 1.75 * thickest, BEARING, 0) for place in own]
    for gear, radius in _gears(train, name):
        z = z0 + shaft.disk(gear).z
        parts.append((z - FACE / 2, z + FACE / 2, radius, BRASS, 26))
    cuts = sorted({edge for part in parts for edge in part[:2]})
    for low, high in pairwise(cuts):
        there = [part for part in parts if part[0] <= low and part[1] >= high]
        if there:
            _, _, radius, colour, teeth = max(there, key=lambda part: part[2])
            cylinder(axes, (x, y), low, high, outline(radius, teeth), colour)
    disk(axes, (x, y), cuts[-1], outline(shaft.sections[-1].diameters(1.0)[0] / 2.0), STEEL)


def _gears(train: GearTrain, shaft: str) -> Iterator[tuple[str, float]]:
    """Disks of a shaft that mesh, with the radius to draw."""
    for mesh in train.meshes.values():
        for (name, gear), radius in zip(mesh.between, mesh.base_radii):
            if name == shaft:
                yield gear, radius


def _spring(axes: Any, place: Real, tray: _Tray, name: str) -> None:
    """A mount: a coil below the floor, and the ground under it; drawn first, so that the casing hides far ones."""
    top = to_page((place[0], tray.low[1] - 0.008, place[2]))
    turns, drop, half = 4, 40.0, 6.0
    steps = np.linspace(0.15, 0.85, 4 * turns + 1)
    coil = [(top[0] + half * np.sin(0.5 * np.pi * k), top[1] - drop * s) for k, s in enumerate(steps)]
    line = np.array([top, (top[0], top[1] - 0.15 * drop), *coil, (top[0], top[1] - drop)])
    axes.plot(*line.T, color=INK, lw=1.2, solid_joinstyle="round", zorder=1)
    ground = top[1] - drop
    axes.plot([top[0] - 9, top[0] + 9], [ground, ground], color=INK, lw=1.6, zorder=1)
    for k in range(5):
        axes.plot([top[0] - 8 + 4 * k, top[0] - 11 + 4 * k], [ground, ground - 4], color=INK, lw=0.8, zorder=1)
    axes.text(top[0], ground - 6, _spoken(name), ha="center", va="top", fontsize=8.5, color=GREY, zorder=1)


def _note_bearing(axes: Any, name: str, place: Real, tray: _Tray) -> None:
    """The bearing's name above its wall."""
    from matplotlib.patheffects import withStroke

    at = to_page(place)
    left = place[2] < (tray.low[2] + tray.high[2]) / 2.0
    foot = to_page((place[0], tray.high[1], place[2]))
    axes.annotate(
        _spoken(name),
        at,
        (foot[0] + (-10 if left else 10), foot[1] + 9),
        ha="center",
        fontsize=8.5,
        color=FORCE,
        arrowprops={"arrowstyle": "-", "color": FORCE, "lw": 0.8, "shrinkB": 3},
        path_effects=[withStroke(linewidth=2.5, foreground="white")],
    )


def _note_meshes(axes: Any, train: GearTrain) -> None:
    """Names of the gears on their faces, and the transmission error along the line of action."""
    for mesh in train.meshes.values():
        first, second = (train.shafts[s].position(train.shafts[s].disk(d).z) for s, d in mesh.between)
        a, b = np.array(first), np.array(second)
        contact = a + (b - a) * mesh.base_radii[0] / sum(mesh.base_radii)
        near_first = np.sign(b[0] - a[0])
        for (_, gear), centre, radius, side in zip(mesh.between, (a, b), mesh.base_radii, (-near_first, near_first)):
            at = to_page(centre + np.array([0.25 * side * radius, 0.66 * side * radius, FACE / 2]))
            axes.annotate(_spoken(gear), at, ha="center", va="center", fontsize=8)
        reach = 1.9 * max(mesh.base_radii)
        n = mesh.line_of_action(first, second)
        front = np.array([0.0, 0.0, FACE / 2])
        low, high = (to_page(contact + h * n + front) for h in (-0.2 * reach, reach))
        axes.annotate("", high, low, arrowprops={"arrowstyle": "<->", "color": MOMENT, "lw": 1.8})
        axes.update_datalim([high + np.array([0.0, 44.0])])
        words = "transmission error\nalong the line\nof action"
        axes.annotate(words, high + np.array([0.0, 2.0]), ha="center", va="bottom", fontsize=8.5, color=MOMENT)


def _triad(axes: Any, tray: _Tray) -> None:
    """The frame, below the front edge of the casing, and the casing's name on its floor."""
    front = to_page((tray.low[0], tray.low[1], (tray.low[2] + tray.high[2]) / 2.0))
    origin = front - np.array([45.0, 62.0])
    for name, direction in ("x", (0.035, 0.0, 0.0)), ("y", (0.0, 0.028, 0.0)), ("z", (0.0, 0.0, 0.03)):
        tip = origin + to_page(direction)
        axes.annotate("", tip, origin, arrowprops={"arrowstyle": "->", "color": GREY, "lw": 1.0, "shrinkA": 0})
        axes.annotate(name, origin + 1.25 * (tip - origin), ha="center", va="center", fontsize=8.5, color=GREY)
    axes.update_datalim([origin - np.array([6.0, 26.0])])
    at = to_page((tray.low[0] + 0.02, tray.low[1], tray.high[2] - 0.045))
    axes.annotate("casing", at, ha="center", va="center", fontsize=8.5, color=GREY)


def _spoken(name: str) -> str:
    return name.replace("_", " ")
