"""`gearpath paper`: the page, what it prints, its exit codes."""

import json
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from gearpath import cli
from gearpath.errors import InputError
from gearpath.fmu.checks import Check
from gearpath.study.paper import fig09, fig11, gallery

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "report"))
from report_reader import Reader, plain

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "paper"


@pytest.fixture
def run(monkeypatch, capsys):
    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["gearpath", *map(str, arguments)])
        with pytest.raises(SystemExit) as stop:
            cli.main()
        captured = capsys.readouterr()
        return stop.value.code or 0, captured.out, captured.err

    return call


def test_the_whole_gallery(run, tmp_path):
    code, out, _ = run("paper", "-o", tmp_path / "deep" / "paper.html", "--json")
    data = json.loads(out)
    assert code == 0
    assert [p.name for p in (tmp_path / "deep").iterdir()] == ["paper.html"]
    page = Reader((tmp_path / "deep" / "paper.html").read_text(encoding="utf-8"))
    for study in data["studies"]:
        text = page.of(study["key"])
        assert all(check["passed"] for check in study["checks"])
        for claim in study["claims"]:
            assert plain(claim["says"]) in text
            assert plain(claim["verdict"]) in text
            assert claim["verdict"] == "holds" or not all(item["holds"] for item in claim["found"])
    every = [claim for study in data["studies"] for claim in study["claims"]]
    assert f"{len(every)} statements" in page.of("summary")
    boxes = {attrs["id"] for tag, attrs in page.tags if attrs.get("class") == "plot"}
    assert boxes == set(page.figures)
    assert not [attrs for tag, attrs in page.tags if "src" in attrs or tag == "link"]  # nothing to fetch
    vanished = data["studies"][[s["key"] for s in data["studies"]].index("fig08")]["effects"][0]["moment"]
    assert vanished["vanishes"] is True
    assert vanished["mean_by_band"] == [None] * 4


def test_every_study_is_an_example_and_the_reverse():
    studies = {study.__module__.rsplit(".", 1)[1] for study in gallery.STUDIES}
    assert {path.stem for path in EXAMPLES.glob("*.py")} == studies


def test_one_study_prints_its_tables(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    gallery.show(fig11.study)
    out = capsys.readouterr().out
    assert "10.78" in out
    assert "moment paths" in out
    assert [p.name for p in (tmp_path / "build" / "paper").iterdir()] == ["fig11.html"]


def test_a_failed_check_is_told(capsys, tmp_path):
    def spoilt():
        return replace(fig09.study(), own_checks=(Check("spoilt", 2.0, 1.0, ""),))

    assert gallery.run(tmp_path / "page.html", studies=[spoilt]) is False
    assert "FAILED spoilt" in capsys.readouterr().out
    assert "FAILED" in (tmp_path / "page.html").read_text(encoding="utf-8")


def test_plain_terminals_get_plain_signs(monkeypatch):
    monkeypatch.setattr(gallery.console, "out", type("Out", (), {"encoding": "ascii"}))
    assert gallery._printable("0–1 kHz: −2.0 × α → ∞ dB ⁻") == "0-1 kHz: -2.0 x alpha -> infinite dB ?"


def test_a_place_that_cannot_be_written_is_refused_before_the_work(run):
    def work():
        raise AssertionError("computed before the place was checked")

    with pytest.raises(InputError):
        gallery.run(Path("/"), studies=[work])
    code, _, error = run("paper", "-o", "/")
    assert code == 2
    assert "is a directory" in error
    assert "Traceback" not in error
