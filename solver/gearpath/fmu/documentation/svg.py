"""Line plots over logarithmic frequency as inline SVG: no script, no style sheet, colours from the page if it has any.

A curve is a path with its name as `title`; gaps are values that are not finite. Coordinates are pixels of the view box.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from ...numerics.arrays import Real

# Okabe and Ito's palette, safe for the common kinds of colour blindness; the page lightens it on dark backgrounds.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#a3527e", "#8a6a00", "#3f97c9", "#555555", "#7b3294")
INK = "#1f2933"
DASHES = ("", "7 3", "2 2", "9 3 2 3", "4 2", "12 3", "6 2 2 2 2 2", "3 3")
_WIDTH, _HEIGHT = 760, 300
_LEFT, _RIGHT, _TOP, _BOTTOM = 58, 20, 10, 46


@dataclass(frozen=True)
class Curve:
    """Levels over the frequencies of the plot."""

    name: str
    level: Real  # (F,), NaN where there is a gap
    colour: int = 0  # place in the palette; -1: the ink of the page
    dash: str = ""
    width: float = 1.6


@dataclass(frozen=True)
class Frame:
    """Ranges of both axes and what they map to."""

    low: float  # Hz
    high: float
    bottom: float  # dB
    top: float
    step: float  # of the grid

    def x(self, frequency: Real) -> Real:
        """Pixels from the left."""
        part = np.log(frequency / self.low) / np.log(self.high / self.low)
        return np.asarray(_LEFT + part * (_WIDTH - _LEFT - _RIGHT))

    def y(self, level: Real) -> Real:
        """Pixels from the top."""
        return np.asarray(_TOP + (self.top - level) / (self.top - self.bottom) * (_HEIGHT - _TOP - _BOTTOM))


def plot(key: str, frequency: Real, curves: Sequence[Curve], unit: str, words: str, marks: Real, depth: float) -> str:
    """An svg element; `key` is unique on the page, `words` describe it, `marks` are frequencies to tick.

    The axis shows at most `depth` dB below the highest level.
    """
    frame = _frame(frequency, curves, depth)
    size = f'viewBox="0 0 {_WIDTH} {_HEIGHT}" width="{_WIDTH}" height="{_HEIGHT}"'
    parts = [
        f'<svg {size} role="img" aria-labelledby="{key}-title">',
        f'<title id="{key}-title">{escape(words)}</title>',
        _clip(key),
        *_grid(frame, unit),
        _marks(frame, marks),
        f'<g clip-path="url(#{key}-clip)" fill="none" stroke-linejoin="round" stroke-linecap="butt">',
        *(_curve(frame, frequency, curve) for curve in curves),
        "</g>",
        "</svg>",
    ]
    return "\n".join(part for part in parts if part)


def legend(curves: Sequence[Curve]) -> str:
    """A list of the curves with a piece of each line."""
    items = []
    for curve in curves:
        line = f'<path d="M1 5H29" fill="none"{_style(curve)}/>'
        swatch = f'<svg width="30" height="10" viewBox="0 0 30 10" aria-hidden="true">{line}</svg>'
        items.append(f"<li>{swatch} {escape(curve.name)}</li>")
    return f'<ul class="legend">\n{"".join(items)}\n</ul>'


def nice_step(span: float, most: int) -> float:
    """The smallest of 1, 2, 5, 10 ... that parts a span into at most so many pieces."""
    step = 10.0 ** np.floor(np.log10(span / most))
    return float(next(step * k for k in (1, 2, 5, 10) if span / (step * k) <= most))


def _frame(frequency: Real, curves: Sequence[Curve], depth: float) -> Frame:
    levels = [curve.level[np.isfinite(curve.level)] for curve in curves]
    every = np.concatenate([np.zeros(0), *levels])
    if not every.size:
        every = np.zeros(1)
    high, low = float(every.max()), float(max(every.min(), every.max() - depth))
    step = nice_step(max(high - low, 1.0), 7)
    bottom, top = step * np.floor(low / step), step * np.ceil(high / step)
    top = max(top, bottom + step)
    return Frame(float(frequency.min()), float(frequency.max()), float(bottom), float(top), step)


def _clip(key: str) -> str:
    width, height = _WIDTH - _LEFT - _RIGHT, _HEIGHT - _TOP - _BOTTOM
    rectangle = f'<rect x="{_LEFT}" y="{_TOP - 2}" width="{width}" height="{height + 2}"/>'
    return f'<clipPath id="{key}-clip">{rectangle}</clipPath>'


def _grid(frame: Frame, unit: str) -> list[str]:
    """Lines, numbers and titles of both axes."""
    decades = range(int(np.floor(np.log10(frame.low))), int(np.ceil(np.log10(frame.high))) + 1)
    hertz = [k * 10.0**d for d in decades for k in (1, 2, 5) if frame.low <= k * 10.0**d <= frame.high * (1 + 1e-12)]
    steps = round((frame.top - frame.bottom) / frame.step)
    levels: Real = frame.bottom + frame.step * np.arange(steps + 1, dtype=float)
    xs, ys = frame.x(np.array(hertz)), frame.y(levels)
    right, bottom = _WIDTH - _RIGHT, _HEIGHT - _BOTTOM
    lines = [f"M{x:.2f} {_TOP}V{bottom}" for x in xs] + [f"M{_LEFT} {y:.2f}H{right}" for y in ys]
    middle_x, middle_y = (_LEFT + right) / 2, (_TOP + bottom) / 2
    return [
        f'<path class="grid" d="{"".join(lines)}" fill="none" stroke="#9aa5b1" stroke-opacity="0.4"/>',
        f'<path d="M{_LEFT} {_TOP}V{bottom}H{right}" fill="none" stroke="currentColor"/>',
        '<g class="x" font-size="12" fill="currentColor" text-anchor="middle">',
        *(f'<text x="{x:.2f}" y="{bottom + 16}">{f:g}</text>' for x, f in zip(xs, hertz)),
        "</g>",
        '<g class="y" font-size="12" fill="currentColor" text-anchor="end">',
        *(f'<text x="{_LEFT - 6}" y="{y + 4:.2f}">{level + 0.0:g}</text>' for y, level in zip(ys, levels)),
        "</g>",
        '<g font-size="12" fill="currentColor" text-anchor="middle">',
        f'<text x="{middle_x:g}" y="{bottom + 36}">frequency, Hz</text>',
        f'<text transform="translate(14 {middle_y:g}) rotate(-90)">{escape(unit)}</text>',
        "</g>",
    ]


def _marks(frame: Frame, frequencies: Real) -> str:
    inside = frequencies[(frequencies >= frame.low) & (frequencies <= frame.high)]
    foot = _HEIGHT - _BOTTOM
    lines = "".join(f"M{x:.2f} {foot}v-7" for x in frame.x(inside)) if inside.size else ""
    return f'<path class="marks" d="{lines}" fill="none" stroke="currentColor" stroke-width="1.4"/>' if lines else ""


def _curve(frame: Frame, frequency: Real, curve: Curve) -> str:
    shown = np.isfinite(curve.level)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], shown, [False]]).astype(int)))
    pieces = []
    for begin, end in edges.reshape(-1, 2):
        points = np.column_stack([frame.x(frequency[begin:end]), frame.y(curve.level[begin:end])])
        if len(points) == 1:  # a dash of a pixel, so that nothing is lost
            points = np.repeat(points, 2, axis=0)
            points[:, 0] += [-0.5, 0.5]
        pieces.append(("M%.2f %.2fL" + "%.2f %.2f " * (len(points) - 1)).rstrip() % tuple(points.ravel()))
    return f'<path d="{"".join(pieces)}"{_style(curve)}><title>{escape(curve.name)}</title></path>'


def _style(curve: Curve) -> str:
    dash = f' stroke-dasharray="{curve.dash}"' if curve.dash else ""
    line = f' stroke-width="{curve.width:g}"{dash}'
    if curve.colour < 0:
        return f' stroke="currentColor"{line}'
    place = curve.colour % len(COLOURS)
    return f' class="c{place}" stroke="{COLOURS[place]}"{line}'
