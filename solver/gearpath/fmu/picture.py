"""Simple pictures drawn twice from the same numbers: as SVG, and as pixels without a drawing library.

A pixel at the signed distance d (in pixels, positive outside) from a shape is covered by clip(1/2 - d, 0, 1).
"""

import struct
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, floor, hypot, pi
from typing import Protocol

import numpy as np

from ..numerics.arrays import Real

SIZE = 200  # of a drawing, its own units; x to the right, y down


class Shape(Protocol):
    """A closed shape."""

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, top, right, bottom."""

    def distance(self, x: Real, y: Real) -> Real:
        """Signed distance of points from the outline."""

    def svg(self) -> str:
        """The element and its geometry, without its end."""


@dataclass(frozen=True)
class Circle:
    """Centre and radius."""

    x: float
    y: float
    r: float

    @property
    def extent(self) -> tuple[float, float, float, float]:
        return self.x - self.r, self.y - self.r, self.x + self.r, self.y + self.r

    def distance(self, x: Real, y: Real) -> Real:
        return np.asarray(np.hypot(x - self.x, y - self.y) - self.r)

    def svg(self) -> str:
        return f'<circle cx="{self.x:g}" cy="{self.y:g}" r="{self.r:g}"'


@dataclass(frozen=True)
class Box:
    """A rectangle with round corners."""

    left: float
    top: float
    right: float
    bottom: float
    r: float

    @property
    def extent(self) -> tuple[float, float, float, float]:
        return self.left, self.top, self.right, self.bottom

    def distance(self, x: Real, y: Real) -> Real:
        p = abs(x - (self.left + self.right) / 2) - (self.right - self.left) / 2 + self.r
        q = abs(y - (self.top + self.bottom) / 2) - (self.bottom - self.top) / 2 + self.r
        outside = np.hypot(np.maximum(p, 0.0), np.maximum(q, 0.0))
        return np.asarray(outside + np.minimum(np.maximum(p, q), 0.0) - self.r)

    def svg(self) -> str:
        size = f'width="{self.right - self.left:g}" height="{self.bottom - self.top:g}" rx="{self.r:g}"'
        return f'<rect x="{self.left:g}" y="{self.top:g}" {size}'


@dataclass(frozen=True)
class Polygon:
    """A convex polygon, its corners clockwise as seen."""

    corners: tuple[tuple[float, float], ...]

    @property
    def extent(self) -> tuple[float, float, float, float]:
        x, y = zip(*self.corners)
        return min(x), min(y), max(x), max(y)

    def distance(self, x: Real, y: Real) -> Real:
        sides = []
        for (x1, y1), (x2, y2) in zip(self.corners, (*self.corners[1:], self.corners[0])):
            length = hypot(x2 - x1, y2 - y1)
            sides.append(((x - x1) * (y2 - y1) - (y - y1) * (x2 - x1)) / length)
        return np.asarray(np.max(sides, axis=0))

    def svg(self) -> str:
        return f'<polygon points="{" ".join(f"{x:g},{y:g}" for x, y in self.corners)}"'


@dataclass(frozen=True)
class Gear:
    """Trapezoidal teeth of a module m = 2 pitch / teeth, one of them centred on the angle `phase`."""

    x: float
    y: float
    pitch: float
    teeth: int
    phase: float  # rad, from x to y

    # outline of a tooth: part of the pitch, and height in modules
    _ANGLES, _HEIGHTS = (-0.5, -0.32, -0.15, 0.15, 0.32, 0.5), (-1.15, -1.15, 1.0, 1.0, -1.15, -1.15)

    @property
    def extent(self) -> tuple[float, float, float, float]:
        return Circle(self.x, self.y, self.pitch * (1 + 2 / self.teeth)).extent

    def distance(self, x: Real, y: Real) -> Real:
        module, step = 2 * self.pitch / self.teeth, 2 * pi / self.teeth
        along = (np.arctan2(y - self.y, x - self.x) - self.phase) / step
        part = along - np.round(along)
        edge = self.pitch + module * np.interp(part, self._ANGLES, self._HEIGHTS)
        slope = module * (1.0 + 1.15) / (0.17 * step)
        steep = (abs(part) > 0.15) & (abs(part) < 0.32)
        tilt = np.hypot(1.0, np.where(steep, slope, 0.0) / np.maximum(edge, 1e-9))
        return np.asarray((np.hypot(x - self.x, y - self.y) - edge) / tilt)

    def svg(self) -> str:
        module, step = 2 * self.pitch / self.teeth, 2 * pi / self.teeth
        pieces = [np.linspace(a, b, 4, endpoint=False) for a, b in pairwise(self._ANGLES)]
        parts = np.concatenate(pieces)  # of the pitch, along one tooth
        r = np.tile(self.pitch + module * np.interp(parts, self._ANGLES, self._HEIGHTS), self.teeth)
        angles = self.phase + (np.arange(self.teeth)[:, None] + parts).ravel() * step
        points = [f"{x:.2f},{y:.2f}" for x, y in zip(self.x + r * np.cos(angles), self.y + r * np.sin(angles))]
        return f'<polygon points="{" ".join(points)}"'


@dataclass(frozen=True)
class Layer:
    """A shape with its paint; the stroke is centred on the outline."""

    shape: Shape
    fill: str | None = None
    stroke: str | None = None
    width: float = 0.0

    def svg(self) -> str:
        """The whole element."""
        stroke = f' stroke="{self.stroke}" stroke-width="{self.width:g}"' if self.stroke else ""
        return f'{self.shape.svg()} fill="{self.fill or "none"}"{stroke}/>'


def painted(layers: Sequence[Layer], pixels: int) -> Real:
    """Red, green, blue (premultiplied) and coverage, 0 ... 1, (pixels, pixels, 4)."""
    image, scale = np.zeros((pixels, pixels, 4)), pixels / SIZE
    centres: Real = (np.arange(pixels, dtype=float) + 0.5) / scale
    for layer in layers:
        reach = layer.width / 2 + 1 / scale
        low, high = layer.shape.extent[:2], layer.shape.extent[2:]
        columns, rows = (
            slice(max(0, floor((a - reach) * scale)), min(pixels, ceil((b + reach) * scale))) for a, b in zip(low, high)
        )
        d = layer.shape.distance(centres[None, columns], centres[rows, None])
        region = image[rows, columns]
        if layer.fill:
            _blend(region, layer.fill, -d * scale)
        if layer.stroke:
            _blend(region, layer.stroke, (layer.width / 2 - abs(d)) * scale)
    return image


def _blend(region: Real, colour: str, depth: Real) -> None:
    """Paint over a region; `depth`: pixels that a point lies within the shape."""
    cover = np.clip(0.5 + depth, 0.0, 1.0)[..., None]
    paint = np.array([*(int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)), 1.0])
    region += cover * (paint - region)


def png(image: Real) -> bytes:
    """A PNG file, 8 bits a channel, of an image (rows, columns, 4), premultiplied by its last channel, 0 ... 1."""
    cover = image[..., 3:]
    plain = np.concatenate([image[..., :3] / np.where(cover > 0, cover, 1.0), cover], axis=-1)
    pixels = np.clip(np.rint(255 * plain), 0, 255).astype(np.uint8)
    rows, columns = pixels.shape[:2]
    lines = np.concatenate([np.zeros((rows, 1), np.uint8), pixels.reshape(rows, -1)], axis=1)  # filter 0 each

    def chunk(kind: bytes, content: bytes) -> bytes:
        check = zlib.crc32(kind + content)
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", check)

    header = struct.pack(">IIBBBBB", columns, rows, 8, 6, 0, 0, 0)
    data = zlib.compress(lines.tobytes(), 6)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", data) + chunk(b"IEND", b"")
