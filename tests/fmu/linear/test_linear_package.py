"""The FMU of a linear system as a file: valid, with its signals, dependencies, reference results and page."""

import re
import zipfile
from html.parser import HTMLParser

import control
import fmpy
import numpy as np
import pytest
from fmpy.util import read_csv
from fmpy.validation import validate_fmu
from fmu_driver import Fmu
from linear_cases import random_system, run

import gearpath as gp
from gearpath.fmu import runtime_files
from gearpath.fmu.conformance import check_conformance

FMIS = ["2.0", "3.0"]
SYSTEMS = {
    "odd": lambda: random_system(5),
    "gain": lambda: random_system(0),
    "one": lambda: control.tf([1.0], [1.0, 0.0], name="integrator"),
    "growing": lambda: random_system(4, growth=1e5),
    "undamped": lambda: control.ss([[0, 100], [-100, 0]], [[1], [0]], [[0, 1]], [[0]], name="2 é-<&>"),
}


@pytest.fixture(scope="module", params=[(name, fmi) for name in SYSTEMS for fmi in FMIS], ids="-".join)
def exported(request, tmp_path_factory):
    name, fmi = request.param
    system = SYSTEMS[name]()
    return system, fmi, gp.export_fmu(system, tmp_path_factory.mktemp("linear") / f"{name}.fmu", fmi=fmi)


def test_every_validator_is_content(exported):
    _, _, path = exported
    assert validate_fmu(str(path)) == []
    assert [str(finding) for finding in check_conformance(path)] == []


def test_all_platforms_and_sources(exported):
    system, fmi, path = exported
    with zipfile.ZipFile(path) as archive:
        names = set(archive.namelist())
    libraries = {name.split("/")[1] for name in names if name.startswith("binaries/")}
    assert libraries == {folder for folder, _ in runtime_files.binaries(fmi)}
    assert "sources/gp_given.c" in names
    assert ("sources/buildDescription.xml" in names) == (fmi == "3.0")
    assert {"documentation/index.html", "terminalsAndIcons/icon.png", "resources/model.bin"} <= names
    description = fmpy.read_model_description(str(path))
    assert description.modelName == (system.name or "")
    assert description.modelExchange
    assert description.coSimulation


@pytest.mark.parametrize("fmi", FMIS)
def test_signals_units_and_dependencies(fmi, tmp_path):
    """A structure with zeros: exactly the non-zero entries are dependencies."""
    A, B = np.array([[-1.0, 2.0, 0.0], [0.0, -3.0, 0.0], [0.5, 0.0, 0.0]]), np.array([[0, 1], [1, 0], [0, 0.0]])
    C, D = np.array([[1.0, 0, 0], [0, 0, 0], [0, 2.0, 0]]), np.array([[0, 0.0], [0, 3.0], [0, 0]])
    system = control.StateSpace(
        A, B, C, D, name="sparse", remove_useless_states=False, inputs=["mount_1/force_uy", "e"],
        outputs=["act/force", "u", "w"], states=["x1", "filter/x2", "x3"],
    )  # fmt: skip
    units = {"mount_1/force_uy": "N", "act.force": "N", "x1": "m", "filter/x2": "N.m"}
    path = gp.export_fmu(system, tmp_path / "it.fmu", fmi=fmi, units=units, description="Words", step_size=1e-4)
    description = fmpy.read_model_description(str(path))
    variables = {v.name: v for v in description.modelVariables}
    assert {n: v.unit for n, v in variables.items() if v.unit and n != "time"} == {
        "mount_1.force_uy": "N", "act.force": "N", "x1": "m", "filter.x2": "N.m", "der(x1)": "m/s",
        "der(filter.x2)": "(N.m)/s",
    }  # fmt: skip
    causality = {"input": ["mount_1.force_uy", "e"], "output": ["act.force", "u", "w"]}
    for kind, names in causality.items():
        assert [v.name for v in description.modelVariables if v.causality == kind] == names
    found = {u.variable.name: {d.name for d in u.dependencies} for u in description.outputs + description.derivatives}
    assert found == {
        "act.force": {"x1"}, "u": {"e"}, "w": {"filter.x2"},
        "der(x1)": {"x1", "filter.x2", "e"}, "der(filter.x2)": {"filter.x2", "mount_1.force_uy"}, "der(x3)": {"x1"},
    }  # fmt: skip
    initial = {u.variable.name: {d.name for d in u.dependencies} for u in description.initialUnknowns}
    matrices = {f"system.{letter}": set() for letter in "ABCD"} if fmi == "3.0" else {}
    assert initial == found | matrices
    assert (description.modelName, description.description) == ("sparse", "Words")
    experiment = description.defaultExperiment
    assert [float(v) for v in (experiment.startTime, experiment.stopTime, experiment.stepSize)] == [0.0, 1.0, 1e-4]


def test_the_same_system_makes_the_same_bytes(tmp_path):
    first, second = (
        gp.export_fmu(random_system(3), tmp_path / f"{k}.fmu", units={"act_1": "N"}).read_bytes() for k in range(2)
    )
    assert first == second
    other = gp.export_fmu(random_system(3, seed=1), tmp_path / "other.fmu", units={"act_1": "N"})
    guids = {fmpy.read_model_description(str(path)).guid for path in (tmp_path / "0.fmu", other)}
    assert len(guids) == 2


@pytest.mark.parametrize("fmi", FMIS)
def test_reference_results_are_python_controls(fmi, tmp_path):
    """The linear ones against forced_response; both replayed through the FMU."""
    system = random_system(5, seed=2)
    unpacked = Fmu.unpack(gp.export_fmu(system, tmp_path / "it.fmu", fmi=fmi), tmp_path / "it")
    place = unpacked.folder / "extra" / "org.fmi-standard.fmi-ls-ref"
    inputs = read_csv(place / "sweep_in.csv")
    linear, held = (read_csv(place / f"sweep_{kind}_out.csv") for kind in ("linear", "held"))
    u = np.stack([inputs[f"mount_{k}.force_uy"] for k in (1, 2)], axis=1)
    wanted = control.forced_response(system, inputs["time"], u.T).outputs
    for name, row in zip(system.output_labels, wanted):
        assert abs(linear[name] - row).max() < 1e-10 * abs(row).max()
    steps = np.diff(inputs["time"])
    for reference, slopes in ((held, None), (linear, np.diff(u, axis=0) / steps[:, None])):
        found = run(unpacked, system, steps, u, slopes, np.zeros(5))
        for name, column in zip(system.output_labels, found.T):
            assert abs(reference[name] - column).max() < 1e-10 * abs(column).max()


def test_no_reference_where_it_overflows(tmp_path):
    path = gp.export_fmu(random_system(4, growth=1e5), tmp_path / "it.fmu")
    with zipfile.ZipFile(path) as archive:
        assert not [name for name in archive.namelist() if name.startswith("extra/")]


class Page(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.open, self.text, self.paths = [], [], {}
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        if tag not in ("meta", "br", "rect"):
            self.open.append(tag)
        if tag == "path":
            self.last = dict(attributes).get("d", "")

    def handle_startendtag(self, tag, attributes):
        pass

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text.append(data)
        if self.open[-2:] == ["path", "title"]:
            self.paths.setdefault(data, []).append(self.last)


def test_page(exported):
    """Well-formed, nothing from outside; poles as numpy finds them."""
    system, fmi, path = exported
    with zipfile.ZipFile(path) as archive:
        html = archive.read("documentation/index.html").decode()
    page = Page(html)
    assert not page.open
    assert not re.search(r"(src|href)=\"(?!#|licenses/)", html)
    text = " ".join(page.text)
    assert f"FMI {fmi}" in text
    assert system.name in text
    system = control.ss(system)
    if system.nstates:
        corner = float(abs(np.linalg.eigvals(system.A)).max()) / (2 * np.pi)
        assert corner == 0.0 or f"{corner:.6g}"[:5] in text


def test_bode_plots(tmp_path):
    """Magnitude and phase of a lag: 0 dB and 0 degrees at the left, 45 degrees and 3 dB down at the corner."""
    path = gp.export_fmu(control.tf([200.0], [1.0, 200.0], name="lag", inputs="e", outputs="u"), tmp_path / "lag.fmu")
    with zipfile.ZipFile(path) as archive:
        html = archive.read("documentation/index.html").decode()
    for key, low, corner in (("magnitude-0", 0.0, -3.0103), ("phase-0", -5.7106, -45.0)):
        drawing = html.split(f'<title id="{key}-title">')[1].split("</svg>")[0]
        rows = re.findall(
            r'<text x="[\d.]+" y="([\d.]+)">(-?\d+)</text>', drawing.split('class="y"')[1].split("</g>")[0]
        )
        (y0, v0), (y1, v1) = [(float(y) - 4, float(v)) for y, v in (rows[0], rows[-1])]
        curve = re.findall(r'<path d="M([^"]*)"[^>]*><title>u</title>', drawing)[0].replace("L", " ").split()
        points = np.array(curve, float).reshape(-1, 2)
        value = v0 + (points[:, 1] - y0) * (v1 - v0) / (y1 - y0)
        middle = np.argmin(abs(points[:, 0] - (points[0, 0] + points[-1, 0]) / 2))
        assert value[0] == pytest.approx(low, abs=0.2)
        assert value[middle] == pytest.approx(corner, abs=0.3)


def test_the_systems_own_units_are_taken(tmp_path):
    """What gp.state_space says about its signals, and what is given beside it."""
    model = gp.load("models/gearbox.toml")
    system = gp.state_space(model)
    own = {**getattr(system, "input_units", {}), **getattr(system, "output_units", {})}
    path = gp.export_fmu(system, tmp_path / "it.fmu", units={"mesh/force": "N"}, documentation=False)
    variables = {v.name: v.unit for v in fmpy.read_model_description(str(path)).modelVariables}
    assert variables["mesh.force"] == "N"
    for label, unit in own.items():
        assert variables[label.replace("/", ".")] == unit
