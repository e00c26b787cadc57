"""The icon of a Gearpath FMU: two gears in a casing, and an arrow through the bearing in its wall."""

from functools import cache
from math import cos, pi, radians, sin

from .picture import SIZE, Box, Circle, Gear, Layer, Polygon, Shape, painted, png

PIXELS = 200  # of icon.png and model.png
INK, PALE, BLUE, LIGHT, WHITE, ORANGE = "#2f3e4e", "#e9eff5", "#0072b2", "#56a3d0", "#ffffff", "#d55e00"


def _arrow(start: float, end: float, y: float, width: float) -> list[Shape]:
    head = 2.9 * width
    tip: Shape = Polygon(((end - 0.9 * head, y - head / 2), (end, y), (end - 0.9 * head, y + head / 2)))
    return [Box(start, y - width / 2, end - 0.8 * head, y + width / 2, width / 4), tip]


def _layers() -> list[Layer]:
    """The picture, from behind to the front."""
    x, y, towards = 61.0, 112.0, radians(-60.0)
    wheel = Gear(x, y, 35.0, 14, towards)
    centre = x + 55.0 * cos(towards), y + 55.0 * sin(towards)
    pinion = Gear(*centre, 20.0, 8, towards + pi + pi / 8)  # a gap where the wheel has a tooth
    casing = Box(11, 22, 138, 178, 20)
    arrow = _arrow(x, 193, y, 10)
    balls = [Circle(138 + 20 * cos(a), y + 20 * sin(a), 5.4) for a in (k * pi / 4 + pi / 8 for k in range(8))]
    return [
        Layer(casing, PALE, INK, 9),
        Layer(pinion, LIGHT),
        Layer(Circle(*centre, 6.5), PALE),
        Layer(wheel, BLUE),
        Layer(Circle(x, y, 14), LIGHT),
        Layer(Circle(138, y, 29), WHITE, INK, 7),
        *(Layer(ball, INK) for ball in balls),
        Layer(Circle(138, y, 12.5), WHITE, INK, 4),
        *(Layer(part, None, WHITE, 5) for part in arrow),  # parts the arrow from what it crosses
        *(Layer(part, ORANGE) for part in arrow),
    ]


_TERMINALS = {
    "joint": [Layer(Circle(100, 100, 78), WHITE, INK, 32), Layer(Circle(100, 100, 36), ORANGE)],
    "excitation": [Layer(Polygon(((24, 24), (176, 100), (24, 176))), BLUE, INK, 20)],
}


def icon_svg() -> bytes:
    """The icon as an SVG file."""
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SIZE} {SIZE}" width="{SIZE}" height="{SIZE}">'
    body = "\n".join(f" {layer.svg()}" for layer in _layers())
    title = "<title>Power flow from a gear pair through a bearing into the casing</title>"
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{head}\n {title}\n{body}\n</svg>\n'.encode()


@cache
def icon_png(pixels: int = PIXELS) -> bytes:
    """The icon as a square PNG file with a transparent background."""
    return png(painted(_layers(), pixels))


@cache
def terminal_png(kind: str, pixels: int = 32) -> bytes:
    """The picture of a terminal, "joint" or "excitation"."""
    return png(painted(_TERMINALS[kind], pixels))
