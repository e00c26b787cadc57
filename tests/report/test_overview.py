"""The overview picture of the README."""

from pathlib import Path

import numpy as np
import pytest
from report_reader import mounts_only, single, translating

import gearpath as gp
from gearpath.report import picture
from gearpath.report.solids import to_page

ROOT = Path(__file__).resolve().parents[2]


def test_picture_is_one_deterministic_svg(tmp_path):
    model = gp.load(ROOT / "models" / "gearbox.toml").replace({"frequency.points": 50})
    first, second = (picture(model, tmp_path / f"{k}.svg").read_bytes() for k in (1, 2))
    assert first == second
    assert first.startswith(b"<?xml")
    assert len(first) < 300_000
    assert sorted(p.name for p in tmp_path.iterdir()) == ["1.svg", "2.svg"]


def test_readme_picture_is_an_svg_without_dates():
    text = (ROOT / "docs" / "overview.svg").read_text()
    assert "<svg" in text
    assert "dc:date" not in text


@pytest.mark.parametrize("machine", [mounts_only, single, translating])
def test_picture_of_machines_with_few_paths(machine, tmp_path):
    text = picture(machine(), tmp_path / "picture.svg").read_text()
    assert text.count("<path") > 200
    assert "nan" not in text.lower()


def test_the_view_keeps_verticals_and_shows_far_things_higher():
    up, far, right = (to_page(point) for point in ((0.0, 0.1, 0.0), (0.1, 0.0, 0.0), (0.0, 0.0, 0.1)))
    assert up[0] == 0.0
    assert up[1] > 0.0
    assert far[1] > 0.0
    assert right[0] > 0.0
    assert all(np.hypot(*point) <= 100.0 for point in (up, far, right))  # mm: a projection lengthens nothing
