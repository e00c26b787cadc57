"""The overview picture of the README."""

from pathlib import Path

import gearpath as gp
from gearpath.report import picture

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
