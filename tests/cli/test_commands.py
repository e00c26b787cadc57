"""The commands: what they print and write, their exit codes, one sentence for every mistake."""

import csv
import json
import sys
from pathlib import Path

import numpy as np
import pytest

import gearpath as gp
from gearpath import cli

MODEL = str(Path(__file__).resolve().parents[2] / "models" / "gearbox.toml")


@pytest.fixture
def run(monkeypatch, capsys):
    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["gearpath", *map(str, arguments)])
        with pytest.raises(SystemExit) as stop:
            cli.main()
        captured = capsys.readouterr()
        return stop.value.code or 0, captured.out, captured.err

    return call


def test_sweep_prints_bands_and_checks(run):
    code, out, _ = run("sweep", MODEL, "--set", "frequency.points=50", "--check")
    assert code == 0
    assert "moment paths" in out
    assert "bearing_4.rx" in out
    assert out.count("passed") == 8


def test_sweep_and_report_say_that_a_rigid_joint_leaves_no_paths(run, tmp_path):
    before, after = Path(MODEL).read_text(encoding="utf-8").split("[joints.bearing_1]")
    weld = '[joints.bearing_1]\nkind = "rigid"\nbetween = ["gear_train.input@0.0", "casing"]\n'
    welded = tmp_path / "welded.toml"
    welded.write_text(before + weld + after[after.index("[joints.bearing_2]") :], encoding="utf-8")
    code, out, err = run("sweep", welded, "--set", "frequency.points=50", "--check")
    assert code == 0
    assert err.count("note: joints.bearing_1: gear_train and casing move as one") == 1
    assert "no joint is a power flow path" in out
    assert "alpha (all)" not in out
    _, _, err = run("report", welded, "--set", "frequency.points=20", "-o", tmp_path / "page.html")
    assert err.count("note: joints.bearing_1") == 1
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert "Rigid joints hold both ends of every bearing together" in page
    assert "no joint of kind bearing" not in page


def test_sweep_for_machines_equals_the_power_flow(run):
    code, out, _ = run("sweep", MODEL, "--set", "frequency.points=7", "--json")
    data = json.loads(out)
    expected = gp.power_flow(gp.load(MODEL), np.linspace(20.0, 5000.0, 7))
    assert code == 0
    np.testing.assert_allclose(data["alpha"], expected.alpha, rtol=1e-12)
    np.testing.assert_allclose(data["path_alpha"]["bearing_2.uy"], expected.path_alpha.sel(path="bearing_2.uy"))


def test_sweep_writes_every_line(run, tmp_path):
    code, _, _ = run("sweep", MODEL, "--set", "frequency.points=9", "-o", tmp_path / "lines.csv")
    rows = list(csv.reader((tmp_path / "lines.csv").open()))
    assert code == 0
    assert len(rows) == 10
    assert rows[0][0] == "frequency_Hz"
    assert float(rows[-1][0]) == 5000.0
    assert [p.name for p in tmp_path.iterdir()] == ["lines.csv"]


def test_set_replaces_values(run):
    _, plain, _ = run("sweep", MODEL, "--set", "frequency.points=3", "--json")
    _, changed, _ = run(
        "sweep", MODEL, "--set", "frequency.points=3", "--set", "joints.mount_1.damping=900.0", "--json"
    )
    assert json.loads(plain)["alpha"] != json.loads(changed)["alpha"]


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["sweep", "nowhere.toml"], "nowhere.toml"),
        (["sweep", MODEL, "--set", "joints.bearing_9.damping=1"], "did you mean"),
        (["sweep", MODEL, "--set", "components.casing.mass"], "is not KEY=VALUE"),
        (["sweep", MODEL, "-o", "lines.xlsx"], "is not a .csv file"),
        (["fmu", MODEL, "-o", "x.fmu", "--kind", "matlab"], "use one of: native, python"),
        (["fmu", MODEL, "-o", "x.fmu", "--fmi", "1.0"], "use one of: 2.0"),
        (["fmu", MODEL, "-o", "/proc/x/y.fmu"], "choose another place"),
        (["fmu", MODEL, "-o", "/"], "is a folder"),
        (["validate", MODEL, MODEL], "is not an FMU"),
        (["validate", "nowhere.fmu", MODEL], "cannot be read"),
        (["report", MODEL, "-o", "/proc/x/y.html"], "/proc/x/y.html"),
    ],
)
def test_mistakes_are_one_sentence_and_exit_code_2(run, arguments, sentence, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, _, error = run(*arguments)
    assert code == 2
    assert sentence in error
    assert "Traceback" not in error
    assert list(tmp_path.iterdir()) == []


def test_an_fmu_is_written_and_described(run, tmp_path):
    code, out, _ = run("fmu", MODEL, "-o", tmp_path / "deep" / "it.fmu", "--json")
    assert code == 0
    assert json.loads(out)["bytes"] == (tmp_path / "deep" / "it.fmu").stat().st_size


def test_a_reduced_fmu_says_how_far_it_is_off(run, tmp_path):
    code, out, _ = run("fmu", MODEL, "-o", tmp_path / "it.fmu", "--tolerance", "1e-2")
    assert code == 0
    assert "order 24 of 72" in out
    code, out, _ = run("fmu", MODEL, "-o", tmp_path / "it.fmu", "--order", "30", "--json")
    assert json.loads(out)["reduction"]["order"] == 30
    code, _, err = run("fmu", MODEL, "-o", tmp_path / "it.fmu", "--order", "30", "--tolerance", "0.01")
    assert code == 2
    assert "give one of the two" in err


def test_schema_is_printed(run):
    code, out, _ = run("schema")
    assert code == 0
    assert "gear_train" in json.dumps(json.loads(out))


def test_version_and_help(run):
    assert gp.__version__ in run("--version")[1]
    assert "validate" in run("--help")[1]


@pytest.mark.slow
def test_a_validation_that_fails_exits_with_1(run, tmp_path):
    """The FMU of one machine against the model of another: the figures say so."""
    run("fmu", MODEL, "-o", tmp_path / "it.fmu")
    code, out, _ = run("validate", tmp_path / "it.fmu", MODEL, "--set", "components.casing.mass=13.0", "--json")
    report = json.loads(out)
    failed = {check["name"] for check in report["checks"] if not check["passed"]}
    assert code == 1
    assert report["passed"] is False
    assert {"frequency-domain outputs against the power flow", "swept sine against python-control"} <= failed
    assert not [name for name in failed if name.startswith("conformance to FMI")]


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["native", "python"])
def test_a_validation_passes(run, tmp_path, kind):
    run("fmu", MODEL, "-o", tmp_path / "it.fmu", "--kind", kind)
    code, out, _ = run("validate", tmp_path / "it.fmu", MODEL, "--json")
    report = json.loads(out)
    assert code == 0, report
    assert len(report["checks"]) == 13
