"""Reference files: replayed through the FMU by several importers, and against python-control and a dense solution."""

import hashlib
import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import control
import fmpy
import numpy as np
import pytest
import scipy.integrate
from fmi3_driver import Fmu3
from fmpy.util import read_csv
from fmu_driver import OK, Fmu
from fmu_exchange import Exchange
from fmu_helpers import export
from fmu_networks import gearbox
from fmu_oracle import frequency_response, time_system

from gearpath.fmu.description import Experiment
from gearpath.fmu.native_table import native_table
from gearpath.fmu.reference_files import FOLDER, reference_files
from gearpath.network.records import MeshSource, Tone

EXPERIMENT, STEP = Experiment(0.0, 0.1, 1e-5), 5e-5
LAYERED = "{http://fmi-standard.org/fmi-ls-manifest}"
TONES = (Tone("mesh.harmonic_1", 1.0, 0.0, 2e-6, 0.4), Tone("mesh.sideband_1", 1.0, -1.5, 5e-7, -1.0))
LOADS = ["mesh.transmission_error", "mesh.force", "actuators.shaker"]


def with_source():
    return replace(gearbox(), source=MeshSource("mesh.transmission_error", 1450.0, 23, TONES))


class Reference:
    """The files of a network, on disk, read by fmpy."""

    def __init__(self, network, folder, experiment=EXPERIMENT, fmi="2.0"):
        self.variables = native_table(network, 500.0, fmi)
        self.files = reference_files(network, self.variables, experiment)
        self.paths = {}
        for name, content in self.files.items():
            self.paths[name.rsplit("/", 1)[1]] = folder / name.rsplit("/", 1)[1]
            self.paths[name.rsplit("/", 1)[1]].write_bytes(content)
        self.inputs = read_csv(self.paths["sweep_in.csv"])
        self.outputs = {kind: read_csv(self.paths[f"sweep_{kind}_out.csv"]) for kind in ("held", "linear")}
        self.names = list(self.outputs["held"].dtype.names[1:])
        self.loads = list(self.inputs.dtype.names[1:])

    def values(self, kind, names=None):
        return np.column_stack([self.outputs[kind][name] for name in names or self.names])

    def u(self):
        return np.column_stack([self.inputs[name] for name in self.loads])

    def deviation(self, found, kind):
        """Of every output, relative to its largest value."""
        expected = self.values(kind)
        return (abs(found - expected).max(axis=0) / abs(expected).max(axis=0)).max()


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    return Reference(gearbox(), tmp_path_factory.mktemp("reference"))


@pytest.fixture(scope="module")
def turning(tmp_path_factory):
    folder = tmp_path_factory.mktemp("source")
    path = export(with_source(), folder / "it.fmu")
    return Reference(with_source(), folder), Fmu.unpack(path, folder / "unpacked"), path


def replayed(reference, unpacked, *, linear):
    """Outputs at the end of every step, before the next inputs are set."""
    fmu, u, times = Fmu(unpacked), reference.u(), reference.inputs["time"]
    fmu.start()
    assert fmu.set(dict(zip(reference.loads, u[0]))) == OK
    rows = [fmu.get(reference.names)]
    for k, (t, h) in enumerate(zip(times[:-1], np.diff(times))):
        assert fmu.set(dict(zip(reference.loads, u[k]))) == OK
        if linear:
            assert fmu.set_slopes(dict(zip(reference.loads, (u[k + 1] - u[k]) / h))) == OK
        assert fmu.step(float(t), float(h)) == OK
        rows.append(fmu.get(reference.names))
    fmu.free()
    return np.array(rows)


def test_held_inputs_replayed_by_an_importer(plain, fmu_path):
    """fmpy holds inputs from one communication point to the next."""
    result = fmpy.simulate_fmu(
        str(fmu_path), fmi_type="CoSimulation", start_time=0.0, stop_time=200 * STEP, output_interval=STEP,
        input=plain.inputs, output=plain.names,
    )  # fmt: skip
    assert np.array_equal(result["time"], plain.outputs["held"]["time"])
    found = np.column_stack([result[name] for name in plain.names])
    assert plain.deviation(found, "held") < 1e-9
    assert plain.deviation(found, "linear") > 1e-3  # the two answers are not the same


def test_held_inputs_replayed_in_fmi_3(network, fmu3_path, tmp_path):
    reference = Reference(network, tmp_path, fmi="3.0")
    result = fmpy.simulate_fmu(
        str(fmu3_path), fmi_type="CoSimulation", start_time=0.0, stop_time=200 * STEP, output_interval=STEP,
        input=reference.inputs, output=reference.names,
    )  # fmt: skip
    found = np.column_stack([result[name] for name in reference.names])
    assert reference.deviation(found, "held") < 1e-9


def test_linear_inputs_replayed_with_input_derivatives(plain, unpacked):
    found = replayed(plain, unpacked, linear=True)
    assert plain.deviation(found, "linear") < 1e-9
    assert plain.deviation(found, "held") > 1e-3


def test_linear_inputs_replayed_with_intermediate_update(network, unpacked3, tmp_path):
    reference, row = Reference(network, tmp_path, fmi="3.0"), [0]
    u, times = reference.u(), reference.inputs["time"]

    def intermediate(instance, _time, asked, _readable):
        if asked:
            assert instance.set(dict(zip(reference.loads, u[row[0] + 1]))) == OK

    fmu = Fmu3(unpacked3, intermediate=intermediate)
    fmu.start()
    found = [fmu.get(reference.names)]
    for k, (t, h) in enumerate(zip(times[:-1], np.diff(times))):
        row[0] = k
        assert fmu.set(dict(zip(reference.loads, u[k]))) == OK
        assert fmu.step(float(t), float(h)) == OK
        found.append(fmu.get(reference.names))
    fmu.free()
    assert reference.deviation(np.array(found), "linear") < 1e-9


def test_model_exchange_follows_the_linear_answer(plain, exchange, network):
    """An integrator of high order through the FMU's derivatives, from row to row."""
    me, u, rows, x = Exchange(exchange, 2), plain.u(), 8, np.zeros(2 * len(network.eigenvalues))
    assert me.update() is False
    me.ok("EnterContinuousTimeMode")
    nominals, found = me.vector("GetNominalsOfContinuousStates"), [exchange.get(plain.names)]
    for k in range(rows - 1):

        def slope(t, state, k=k):
            part = t / STEP - k
            me.ok("SetTime", t)
            me.set(dict(zip(plain.loads, (1 - part) * u[k] + part * u[k + 1])))
            me.states = state
            return me.derivatives

        span = (k * STEP, (k + 1) * STEP)
        run = scipy.integrate.solve_ivp(slope, span, x, "DOP853", rtol=1e-9, atol=1e-12 * nominals)
        x = run.y[:, -1]
        slope(span[1], x)
        found.append(exchange.get(plain.names))
    expected = plain.values("linear")[:rows]
    assert (abs(np.array(found) - expected).max(axis=0) / abs(expected).max(axis=0)).max() < 1e-6


@pytest.mark.parametrize("linear", [False, True])
def test_a_gear_mesh_source_is_in_the_reference(turning, linear):
    """Frequencies of the tones: 23 and 21.5 orders at 1450 rev/min."""
    reference, unpacked, _ = turning
    found = replayed(reference, unpacked, linear=linear)
    assert reference.deviation(found, "linear" if linear else "held") < 1e-9
    assert "mesh.speed" in reference.loads
    assert (reference.inputs["mesh.speed"] == 1450.0).all()


def test_tones_add_what_their_own_signal_adds(turning, plain):
    """The source's share of the outputs, by python-control from the sampled tones: exact but for the sampling."""
    t = np.linspace(0.0, 200 * STEP, 20001)
    theta = 2 * np.pi * 1450.0 / 60 * t
    e = 2e-6 * np.cos(23 * theta + 0.4) + 5e-7 * np.cos(21.5 * theta - 1.0)
    A, B, C, D, names = time_system(gearbox())
    share = control.forced_response(control.ss(A, B[:, :1], C, D[:, :1]), t, e).outputs[:, ::100].T
    found = turning[0].values("linear", names) - plain.values("linear", names)
    assert (abs(found - share).max(axis=0) / abs(share).max(axis=0)).max() < 1e-6


def test_against_python_control(plain):
    """Zero-order hold and piecewise linear inputs, as python-control discretises them."""
    A, B, C, D, names = time_system(gearbox())
    u = np.column_stack([plain.inputs[name] for name in LOADS])
    system = control.ss(A, B, C, D)
    linear = control.forced_response(system, plain.inputs["time"], u.T).outputs.T
    states = control.forced_response(control.c2d(system, STEP, "zoh"), plain.inputs["time"], u.T).states.T
    held = states @ C.T + np.vstack([u[:1], u[:-1]]) @ D.T
    for kind, expected in (("held", held), ("linear", linear)):
        found = plain.values(kind, names)
        assert (abs(found - expected).max(axis=0) / abs(expected).max(axis=0)).max() < 1e-9


def test_power_ratios_belong_to_the_start_frequency(plain):
    expected = frequency_response(gearbox(), 500.0)
    ratios = [name for name in plain.names if "alpha" in name]
    assert len(ratios) == 7
    for name in ratios:
        assert (plain.outputs["held"][name] == plain.outputs["held"][name][0]).all()
        assert plain.outputs["held"][name][0] == pytest.approx(expected[name], rel=1e-9)


def test_every_load_matters(plain):
    """No load is so weak beside the others that an error of its path would not be seen at 1e-9."""
    A, B, C, D, _ = time_system(gearbox())
    whole = plain.values("linear")
    for k, load in enumerate(LOADS):
        one = control.ss(A, B[:, k : k + 1], C, D[:, k : k + 1])
        alone = control.forced_response(one, plain.inputs["time"], plain.inputs[load]).outputs
        assert abs(alone).max() > 1e-5 * abs(whole).max()


def test_numbers_read_back_as_the_same_doubles(plain):
    times = plain.inputs["time"]
    assert np.array_equal(times, 5 * 1e-5 * np.arange(201))
    text = plain.files[f"{FOLDER}/sweep_linear_out.csv"].decode()
    assert text.splitlines()[0] == ",".join(f'"{name}"' for name in ["time", *plain.names])
    column = [float(line.split(",")[1]) for line in text.splitlines()[1:]]
    digits = [len(re.sub(r"e.*|\D", "", line.split(",")[1]).lstrip("0")) for line in text.splitlines()[2:]]
    assert np.array_equal(column, plain.outputs["linear"][plain.names[0]])
    assert max(digits) == 17
    assert np.isfinite(plain.values("held")).all()


def test_all_inputs_and_time_outputs_are_there(plain):
    assert plain.loads == [v.name for v in plain.variables if v.causality == "input"]
    network = gearbox()
    assert {output.name for output in network.outputs} < set(plain.names)
    for load in LOADS:
        swept = plain.inputs[load]
        assert swept[0] == 0.0
        crossings = np.flatnonzero(np.diff(np.sign(swept[1:])))
        assert np.diff(crossings)[0] > 2 * np.diff(crossings)[-1]  # the frequency rises
    assert (plain.inputs["frequency"] == 500.0).all()


@pytest.mark.parametrize("experiment", [Experiment(0.25, 0.75, 1e-4), Experiment(1.0, 1.001, 1e-4)])
def test_other_experiments(experiment, tmp_path, unpacked):
    reference = Reference(gearbox(), tmp_path, experiment)
    times = reference.inputs["time"]
    assert times[0] == experiment.start_time
    assert times[-1] <= experiment.stop_time * (1 + 1e-12)
    fmu = Fmu(unpacked)
    fmu.start(start=float(times[0]))
    u = reference.u()
    for k in range(200):
        assert fmu.set(dict(zip(reference.loads, u[k]))) == OK
        assert fmu.step(float(times[k]), float(times[k + 1] - times[k])) == OK
    last = fmu.get(reference.names)
    expected = reference.values("held")
    assert (abs(last - expected[-1]) / abs(expected).max(axis=0)).max() < 1e-9
    fmu.free()


def test_manifest_names_the_files_and_their_checksums(plain):
    root = ET.fromstring(plain.files[f"{FOLDER}/fmi-ls-manifest.xml"])
    assert root.tag == "fmiReferences"
    assert root.get(f"{LAYERED}fmi-ls-name") == FOLDER.split("/")[1]
    assert root.get(f"{LAYERED}fmi-ls-version")
    assert root.get(f"{LAYERED}fmi-ls-description").startswith("Layered Standard")
    related = {element.get("source"): element for element in root}
    assert {f"{FOLDER}/{name}" for name in related} | {f"{FOLDER}/fmi-ls-manifest.xml"} == {
        name for name in plain.files if name.startswith("extra/")
    }
    for name, element in related.items():
        content = plain.files[f"{FOLDER}/{name}"]
        assert element.get("checksum") == hashlib.new("sha3-256", content).hexdigest()
        assert element.get("checksumType") == "SHA3-256"
        assert element.get("role").split("/")[0] in ("experiment", "testcase", "result")


def test_experiments_say_how_to_run_them(plain):
    root = ET.fromstring(plain.files[f"{FOLDER}/sweep.exp"])
    times = plain.inputs["time"]
    assert [e.get("name") for e in root] == ["sweep_held", "sweep_linear"]
    for experiment in root:
        run, stimuli, references = experiment
        assert [float(run.get(key)) for key in ("startTime", "stopTime", "stepSize")] == [0.0, times[-1], STEP]
        assert stimuli.get("source") == "sweep_in.csv"
        assert f"{FOLDER}/{references.get('source')}" in plain.files


def test_same_model_same_bytes(plain):
    again = reference_files(gearbox(), native_table(gearbox(), 500.0), EXPERIMENT)
    assert again == plain.files
