"""The pictures: valid files, antialiased, areas as in geometry, SVG and PNG alike."""

import struct
import xml.etree.ElementTree as ET
import zlib
from math import pi

import numpy as np
import pytest

from gearpath.fmu.icon import icon_png, icon_svg, terminal_png
from gearpath.fmu.picture import SIZE, Box, Circle, Gear, Layer, Polygon, painted, png

SVG = "{http://www.w3.org/2000/svg}"


def decoded(content):
    """Pixels (rows, columns, 4) of a PNG file with 8-bit channels and unfiltered lines; every chunk is checked."""
    assert content[:8] == b"\x89PNG\r\n\x1a\n"
    at, chunks = 8, []
    while at < len(content):
        size, kind = struct.unpack_from(">I4s", content, at)
        body = content[at + 8 : at + 8 + size]
        assert struct.unpack_from(">I", content, at + 8 + size) == (zlib.crc32(kind + body),)
        chunks.append((kind, body))
        at += 12 + size
    assert [kind for kind, _ in chunks] == [b"IHDR", b"IDAT", b"IEND"]
    columns, rows, depth, colour, *rest = struct.unpack(">IIBBBBB", chunks[0][1])
    assert (depth, colour, rest) == (8, 6, [0, 0, 0])
    lines = np.frombuffer(zlib.decompress(chunks[1][1]), np.uint8).reshape(rows, 1 + 4 * columns)
    assert not lines[:, 0].any()
    return lines[:, 1:].reshape(rows, columns, 4)


def premultiplied(content):
    image = decoded(content) / 255.0
    return image * np.concatenate([np.repeat(image[..., 3:], 3, axis=-1), np.ones_like(image[..., 3:])], axis=-1)


@pytest.mark.parametrize("pixels", [64, 128, 200])
def test_icon_has_its_size_and_a_transparent_background(pixels):
    image = decoded(icon_png(pixels))
    assert image.shape == (pixels, pixels, 4)
    for corner in (image[0, 0], image[0, -1], image[-1, 0], image[-1, -1]):
        assert corner[3] == 0
    tip = image[round(112 / SIZE * pixels), round(177 / SIZE * pixels)]
    assert tip.tolist() == [0xD5, 0x5E, 0x00, 0xFF]  # the arrow ends outside the casing


def test_small_icons_are_the_large_one_averaged():
    """Antialiasing: a pixel is what the picture covers of it."""
    fine = premultiplied(icon_png(1024)).reshape(64, 16, 64, 16, 4).mean(axis=(1, 3))
    deviation = abs(premultiplied(icon_png(64)) - fine)
    assert deviation.mean() < 0.006
    jagged = premultiplied(icon_png(1024))[8::16, 8::16]  # what sampling at the centres would give
    assert abs(jagged - fine).mean() > 2 * deviation.mean()


def shoelace(points):
    x, y = np.array([pair.split(",") for pair in points.split()], float).T
    return abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


@pytest.mark.parametrize("pixels", [50, 130])
@pytest.mark.parametrize(
    ("shape", "area"),
    [
        (Circle(100, 93.3, 61), pi * 61**2),
        (Box(20, 30, 171.7, 120, 25), 151.7 * 90 - (4 - pi) * 25**2),
        (Polygon(((20, 20), (180, 100), (20, 150))), 0.5 * 130 * 160),
        (Gear(99, 101, 70, 14, 0.3), None),
        (Gear(99, 101, 70, 8, -2.0), None),
    ],
)
def test_pixels_cover_the_area_of_a_shape(shape, area, pixels):
    if area is None:
        area = shoelace(ET.fromstring(shape.svg() + "/>").get("points"))
    covered = painted([Layer(shape, "#000000")], pixels)[..., 3].sum() * (SIZE / pixels) ** 2
    assert covered == pytest.approx(area, rel=0.006)
    left, top, right, bottom = shape.extent
    assert 0 <= left < right <= SIZE
    assert 0 <= top < bottom <= SIZE


def test_strokes_cover_their_area():
    ring = painted([Layer(Circle(100, 100, 60), None, "#123456", 10)], 100)
    assert ring[..., 3].sum() * 4 == pytest.approx(2 * pi * 60 * 10, rel=0.005)


def test_gears_mesh_without_overlap():
    """Wheel and pinion of the icon, read from its SVG file: teeth of one stand in the gaps of the other."""
    gears = [e for e in ET.fromstring(icon_svg()).iter(f"{SVG}polygon") if len(e.get("points").split()) > 8]
    assert len(gears) == 2
    masks = []
    for gear in gears:
        points = np.array([pair.split(",") for pair in gear.get("points").split()], float)
        grid = np.stack(np.meshgrid(np.arange(0, SIZE, 0.5), np.arange(0, SIZE, 0.5)), axis=-1)
        inside = np.zeros(grid.shape[:2], bool)
        for (x1, y1), (x2, y2) in zip(points, np.roll(points, -1, axis=0)):  # even-odd rule
            crosses = (y1 > grid[..., 1]) != (y2 > grid[..., 1])
            with np.errstate(divide="ignore", invalid="ignore"):
                inside ^= crosses & (grid[..., 0] < (x2 - x1) * (grid[..., 1] - y1) / (y2 - y1) + x1)
        masks.append(inside)
    assert (masks[0] & masks[1]).sum() < 0.002 * min(mask.sum() for mask in masks)


def test_svg_is_plain():
    root = ET.fromstring(icon_svg())
    assert root.tag == f"{SVG}svg"
    assert root.get("viewBox") == f"0 0 {SIZE} {SIZE}"
    assert {e.tag.removeprefix(SVG) for e in root.iter()} == {"svg", "title", "rect", "circle", "polygon"}
    assert not {name for e in root.iter() for name in e.attrib if "href" in name or name == "style"}


@pytest.mark.parametrize("kind", ["joint", "excitation"])
def test_terminals_have_pictures(kind):
    image = decoded(terminal_png(kind))
    assert image.shape == (32, 32, 4)
    assert image[16, 16, 3] == 255
    assert image[0, 0, 3] == 0


def test_any_image_survives_the_file():
    image = np.zeros((3, 5, 4))
    image[..., 3] = np.linspace(0, 1, 15).reshape(3, 5)
    image[..., 0] = image[..., 3]
    back = decoded(png(image))
    assert back.shape == (3, 5, 4)
    assert np.array_equal(back[..., 3], np.rint(255 * image[..., 3]))
    assert set(np.unique(back[..., 0])) == {0, 255}
