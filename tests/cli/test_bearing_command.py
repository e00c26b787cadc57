"""`gearpath bearing`: what it prints and writes, judged by a sum over the balls, and its refusals."""

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from ball_sum import SHAPES, Balls, stiffness

import gearpath as gp
from gearpath import cli

DOFS = ("ux", "uy", "uz", "rx", "ry", "rz")
MODELS = Path(__file__).resolve().parents[2] / "models"
LOAD = ("--load", "ux=1000", "--load", "uz=1500")


@pytest.fixture
def run(monkeypatch, capsys):
    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["gearpath", "bearing", *map(str, arguments)])
        with pytest.raises(SystemExit) as stop:
            cli.main()
        captured = capsys.readouterr()
        return stop.value.code or 0, captured.out, captured.err

    return call


@pytest.fixture
def model(tmp_path):
    """The gearbox with ball bearings at 80 N m, as a file."""
    text = (MODELS / "gearbox.toml").read_text("utf-8")
    text = re.sub(r"stiffness = \[\[1.2e8.*", 'catalogue = "6205-like"', text)
    text = text.replace("points = 2000", "points = 20")
    path = tmp_path / "balls.toml"
    path.write_text(text + "\n[operation]\ntorque = 80.0\n", "utf-8")
    return path


def section(out, heading):
    """Lines below a heading, without their indent."""
    lines = out.splitlines()
    begin = next(k for k, line in enumerate(lines) if line.startswith(heading)) + 1
    end = next((k for k in range(begin, len(lines)) if not lines[k].strip()), len(lines))
    return [line[2:] for line in lines[begin:end]]


def printed_matrix(lines):
    """Numbers and units of the printed 6x6 matrix."""
    numbers = [[float(cell) for cell in re.findall(r"(?<=\s)-?\d[\d.e+-]*(?=\s)", line)] for line in lines[1:7]]
    units = [re.findall(r"N(?: m)?/(?:m|rad)", line) for line in lines[1:7]]
    return np.array(numbers), units


def test_printed_matrix_is_the_derivative_of_the_load(run):
    code, out, err = run("7210B-like", *LOAD)
    assert (code, err) == (0, "")
    shown = section(out, "Displacement of the inner ring")
    q = [float(line.split()[1]) for line in shown[1:6]]
    K, units = printed_matrix(section(out, "Stiffness K"))
    expected = stiffness([Balls(SHAPES["7210B-like"])], q)
    assert K.shape == (6, 6)
    size = np.sqrt(np.diag(expected))
    scale = np.where(np.outer(size, size) > 0, np.outer(size, size), 1.0)
    np.testing.assert_allclose(K / scale, expected / scale, atol=1e-3)  # four digits are printed
    assert units == [["N/m", "N/rad"]] * 3 + [["N m/m", "N m/rad"]] * 3
    assert ([line.split()[-1] for line in shown[1:6]]) == ["free", "held", "free", "held", "held"]


def test_printed_distribution_carries_the_load(run):
    _, out, _ = run("7210B-like", *LOAD)
    rows = [line.split() for line in section(out, "Load distribution")[1:]]
    psi, Q, a = np.array([[float(x) for x in row[1:4]] for row in rows]).T
    across = Q * np.cos(np.radians(a))
    np.testing.assert_allclose(across @ np.cos(np.radians(psi)), 1000.0, rtol=1e-3)
    np.testing.assert_allclose(across @ np.sin(np.radians(psi)), 0.0, atol=1.0)
    np.testing.assert_allclose(Q @ np.sin(np.radians(a)), 1500.0, rtol=1e-3)
    bars = [len(row[4]) if len(row) > 4 else 0 for row in rows]
    np.testing.assert_allclose(bars, np.ceil(32 * Q / Q.max()), atol=1)
    assert [b > 0 for b in bars] == (Q > 0).tolist()


def test_printed_table_has_the_tenth_root_of_rollers(run):
    code, out, _ = run("NU206-like", "--load", "ux=500")
    rows = [line.split() for line in section(out, "Stiffness against load")[2:]]
    values = np.array([[float(cell) for cell in row] for row in rows])
    assert code == 0
    assert len(values) == 8
    np.testing.assert_allclose(values[:, 1], 500.0 * values[:, 0])
    np.testing.assert_allclose(np.diff(np.log(values[:, 2])), 0.1 * np.diff(np.log(values[:, 1])), atol=1e-3)


def test_document_for_machines(run):
    code, out, _ = run("7210B-like", *LOAD, "--arrangement", "back_to_back", "--distance", 0.03, "--phases", "--json")
    document = json.loads(out)
    (found,) = document["bearings"]
    pair = gp.back_to_back(gp.catalogue_bearing("7210B-like"), 0.03)
    assert code == 0
    q = [found["displacement"][dof] for dof in DOFS]
    shape = SHAPES["7210B-like"]
    rows = [Balls(shape, 1.0, -0.015), Balls(shape, -1.0, 0.015)]
    expected = stiffness(rows, q)
    np.testing.assert_allclose(found["stiffness"], expected, atol=1e-8 * expected.max(), rtol=1e-7)
    assert document["units"]["stiffness"][0] == ["N/m"] * 3 + ["N/rad"] * 3
    assert [item["row"] for item in found["elements"]] == [1] * 15 + [2] * 15
    assert sum(item["load"] > 0 for item in found["elements"]) == found["loaded"]
    against = found["stiffness_against"]
    assert np.shape(against["stiffness"]) == (len(against["factors"]), 6, 6)
    with pytest.warns(UserWarning, match="carries no load"):
        average = pair.phase_average({"ux": 1000.0, "uz": 1500.0})
    np.testing.assert_allclose(found["phases"]["average"], average, rtol=1e-6, atol=1e-6 * average.max())
    assert all(np.array(found["phases"]["smallest_diagonal"]) <= found["phases"]["largest_diagonal"])


def test_mirrored_bearing_carries_the_other_way(run):
    code, out, _ = run("30206-like", "--load", "uz=-500", "--mirrored", "--json")
    (found,) = json.loads(out)["bearings"]
    assert code == 0
    assert found["load"]["uz"] == pytest.approx(-500.0)
    assert found["elements"][0]["contact_angle_deg"] < 0


def test_notes_are_printed_once_and_are_no_warnings(run):
    code, out, err = run("7210B-like", "--load", "uz=100", "--speed", 9000)
    assert (code, err) == (0, "")
    assert out.count("9000 rev/min") == 1
    assert "note: at 9000 rev/min" in out
    assert "\x1b" not in out


def test_catalogue_is_listed_with_sources(run, tmp_path):
    own = tmp_path / "own.toml"
    entry = {"type": '"roller"', "rollers": 10, "roller_length": 0.01, "pitch_radius": 0.03, "contact_angle": 0.0}
    own.write_text('[mine]\nsource = "measured"\n' + "".join(f"{k} = {v}\n" for k, v in entry.items()))
    code, out, _ = run("--list", "--catalogue-file", own)
    assert code == 0
    assert re.search(r"^mine +measured$", out, re.M)
    assert re.search(r"^218-like +Harris", out, re.M)
    assert run()[1] == run("--list")[1]
    listed = json.loads(run("--list", "--json")[1])["catalogue"]
    assert listed == gp.designations()
    code, out, _ = run("mine", "--load", "ux=100", "--catalogue-file", own, "--json")
    assert code == 0
    assert json.loads(out)["bearings"][0]["source"] == "measured"
    assert run("6205-like", "--load", "ux=100", "--catalogue-file", own)[0] == 0


def test_bearings_of_a_model_at_its_operating_point(run, model):
    code, out, err = run(model, "--json")
    found = {item["name"]: item for item in json.loads(out)["bearings"]}
    assert (code, err) == (0, "")
    assert list(found) == [f"bearing_{k}" for k in (1, 2, 3, 4)]
    force = found["bearing_1"]["load"]["uy"] + found["bearing_2"]["load"]["uy"]
    assert force == pytest.approx(-80.0 / 0.04975, rel=1e-6)
    assert found["bearing_1"]["stiffness_against"]["over"] == "torque"
    code, out, _ = run(model, "--joint", "bearing_3", "--set", "operation.torque=40.0")
    assert code == 0
    assert "bearing_3: at the operating point of the machine, torque 40 N m" in out
    assert "bearing_1" not in out


def test_page_is_written_beside_the_text(run, tmp_path):
    pytest.importorskip("plotly")
    page = tmp_path / "page.html"
    code, out, _ = run("6205-like", "--load", "ux=1000", "-o", page)
    assert code == 0
    assert out.endswith(f"wrote {page}\n")
    assert [item.name for item in tmp_path.iterdir()] == ["page.html"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["6205", "--load", "ux=1"], "did you mean '6205-like'"),
        (["unknown", "--load", "ux=1"], "known: 6205-like"),
        (["6205-like", "--load", "foo=1"], "no degree of freedom 'foo'"),
        (["6205-like", "--load", "rz=1"], "turns freely"),
        (["6205-like", "--load", "ux"], "NAME=NUMBER"),
        (["6205-like", "--load", "ux=one"], "NAME=NUMBER"),
        (["6205-like", "--load", "ux=1,ux=2"], "given twice"),
        (["6205-like", "--load", "ux=nan"], "finite number"),
        (["30206-like", "--load", "uz=-500"], "cannot carry uz = -500"),
        (["6205-like", "--load", "ux=1", "--displacement", "uz=1e-6"], "both given"),
        (["--load", "ux=1"], "no target"),
        (["6205-like"], "no rolling element carries load"),
        (["6205-like", "--list"], "leave 6205-like out"),
        (["7210B-like", "--load", "uz=1", "--distance", "0.1"], "give arrangement"),
        (["7210B-like", "--load", "uz=1", "--arrangement", "tandem"], "give distance"),
        (["7210B-like", "--load", "uz=1", "--arrangement", "x", "--distance", "0.1"], "'x' is none of"),
        (["6205-like", "--load", "ux=1", "--joint", "a"], "belong to a model file"),
        ([MODELS / "gearbox.toml"], "no bearing given by geometry"),
        ([MODELS / "gearbox.toml", "--load", "ux=1"], "--set"),
        (["none.toml"], "no such file"),
        (["6205-like", "--load", "ux=1", "--catalogue-file", "none.toml"], "cannot be read"),
        (["6205-like", "--load", "ux=1", "-o", "."], "it is a directory"),
    ],
)
def test_mistakes_are_one_sentence(run, arguments, words):
    code, out, err = run(*arguments)
    assert (code, out) == (2, "")
    assert words in err
    assert len(err.splitlines()) == 1


def test_help_starts_without_the_solver():
    code = (
        "import sys; sys.argv = ['gearpath', '--help']\nfrom gearpath import cli\n"
        "try: cli.main()\nexcept SystemExit: print([m for m in ('scipy', 'pydantic', 'plotly') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.endswith("[]\n")
    assert "bearing" in done.stdout
