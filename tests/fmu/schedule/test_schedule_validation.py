"""Export from models with an operating point, by function and command line, and the validation's own checks."""

import json
import re
import sys
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fmu_driver import Fmu
from schedule_machine import TORQUE, new, read_matrix

import gearpath as gp
from gearpath import cli
from gearpath.fmu.export import export as export_system
from gearpath.fmu.export import prepared
from gearpath.fmu.simulation import running
from gearpath.fmu.validation import exchange, schedule, suite, torques_of
from gearpath.network.operation import schedule as scheduled_matrices
from gearpath.network.records import Schedule

MODEL = Path(__file__).resolve().parents[3] / "models" / "gearbox.toml"
BAND = (20.0, 5000.0)
POINTS, OWN = [10.0, 50.0, 90.0], 30.0


@pytest.fixture(scope="module")
def model():
    """The spur gearbox on ball bearings of the catalogue."""
    data = gp.load(MODEL).to_dict()
    for k in range(1, 5):
        between = data["joints"][f"bearing_{k}"]["between"]
        new_one = {"kind": "bearing", "between": between, "catalogue": "6206-like", "damping_time": 1e-6}
        data["joints"][f"bearing_{k}"] = new_one
    return gp.Model.from_dict({**data, "operation": {"torque": OWN}})


@pytest.fixture(scope="module")
def path(model, tmp_path_factory):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return gp.export_fmu(model, tmp_path_factory.mktemp("spur") / "it.fmu", "3.0", schedule=POINTS)


def handmade(model, factors=(0.2, 1.0, 3.0), start=20.0):
    """The bearings' own stiffness by these factors, without any bearing theory."""
    joints = {name: joint for name, joint in model.system.joints.items() if joint.kind == "bearing"}
    K = {name: np.array([f * np.array(joint.stiffness) for f in factors]) for name, joint in joints.items()}
    C = {"bearing_2": 2e-6 * K["bearing_2"]}
    return Schedule(np.array([10.0, 20.0, 60.0]), K, C, start)


def test_begins_as_the_model(model, path, tmp_path):
    """The model's own torque is one of the points, so that nothing is interpolated at the start."""
    assert torques_of(path) == [10.0, OWN, 50.0, 90.0]
    fmu = new(Fmu.unpack(path, tmp_path / "it"), 3)
    assert fmu.get([TORQUE]).tolist() == [OWN]
    for torque in (OWN, 10.0, 90.0):  # at points the stiffness is that of the model with this torque
        there = model.replace({"operation.torque": torque}).system
        assert fmu.set({TORQUE: torque}) == 0
        for name in ("bearing_1", "bearing_4"):
            for what in ("stiffness", "damping"):
                wanted = np.array(getattr(there.joints[name], what))
                assert read_matrix(fmu, 3, f"{name}.{what}") == pytest.approx(wanted, rel=1e-9)
    for torque in (OWN, 50.0):
        assert fmu.set({TORQUE: torque, "frequency": 777.0}) == 0
        flow = gp.power_flow(model.replace({"operation.torque": torque}), [777.0])
        assert fmu.get(["alpha"])[0] == pytest.approx(float(flow.alpha[0]), rel=1e-8)
    fmu.free()


def test_the_validation_checks_it(model, path):
    """Its two checks pass; with another schedule than the FMU's both do not."""
    own = replace(scheduled_matrices(model.system, torques_of(path)), start=OWN)
    network = prepared(model.system, own)
    assert suite.same_model(path, network, "native", BAND[0]).passed
    assert not suite.same_model(path, replace(network, schedule=None), "native", BAND[0]).passed
    stiffer = replace(own, stiffness={name: 1.0001 * K for name, K in own.stiffness.items()})
    for matrices, good in ((own, True), (stiffer, False)):
        with running(path) as fmu:
            fmu.start()
            checks = schedule.checks(fmu, prepared(model.system, matrices), matrices, BAND, 1e-9, 1e-9)
            assert [check.passed for check in checks] == [good, good], checks
            assert len({check.name for check in checks}) == 2
    assert schedule.torques(own).tolist() == [10.0, 70.0, 90.0]


def test_parameters_leave_out_what_follows(model, path):
    own = replace(scheduled_matrices(model.system, POINTS), start=OWN)
    network = prepared(model.system, own)
    assert not [name for name in exchange.parameters(network) if name.startswith("bearing_")]
    changed = exchange.exchanged(network)
    assert (changed.joints[0].stiffness == network.joints[0].stiffness).all()
    assert changed.joints[-1].stiffness == 0.5 * network.joints[-1].stiffness
    with running(path) as fmu:
        assert exchange.start_check(fmu.description, network).passed
        other = replace(network, schedule=replace(own, start=31.0))
        assert not exchange.start_check(fmu.description, other).passed


@pytest.mark.slow
def test_whole_validation(tmp_path):
    """Of a schedule by hand, on a system that gives its stiffness itself."""
    system, matrices = gp.load(MODEL).system, handmade(gp.load(MODEL))
    path = export_system(system, tmp_path / "it.fmu", schedule=matrices, frequency=BAND[0])
    report = suite.validate(path, system, BAND, scheduled=matrices)
    assert report.passed, [check for check in report.checks if not check.passed]
    assert not report.findings


def test_damping_by_a_loss_factor_follows(tmp_path):
    """Viscous in its place, C + eta K / w, over the torque as well."""
    model = gp.load(MODEL)
    system = model.system
    lossy = replace(system.joints["bearing_1"], loss_factor=0.02)
    system = replace(system, joints={**system.joints, "bearing_1": lossy}, loss_frequency=800.0)
    matrices = replace(handmade(model), damping={})
    path = export_system(system, tmp_path / "it.fmu", schedule=matrices, documentation=False)
    fmu = new(Fmu.unpack(path, tmp_path / "it"), 2)
    for torque in (20.0, 33.0, 60.0):
        assert fmu.set({TORQUE: torque}) == 0
        K = read_matrix(fmu, 2, "bearing_1.stiffness")
        wanted = np.array(lossy.damping) + 0.02 / (2 * np.pi * 800.0) * K
        assert read_matrix(fmu, 2, "bearing_1.damping") == pytest.approx(wanted, rel=1e-12)
        exact = np.array(lossy.stiffness) * np.interp(torque, matrices.torques, [0.2, 1.0, 3.0])
        assert pytest.approx(exact, rel=1e-12) == K
    fmu.free()


def test_refusals(model, tmp_path):
    with pytest.raises(gp.InputError, match="the python kind has none"):
        gp.export_fmu(model, tmp_path / "it.fmu", kind="python", schedule=POINTS)
    with pytest.raises(gp.InputError, match=r"no \[operation\]"):
        gp.export_fmu(gp.load(MODEL), tmp_path / "it.fmu", schedule=POINTS)
    for torques in ([10.0], [], [50.0, 10.0], [10.0, 10.0, 60.0], [10.0, 50.0, 20.0, 60.0], [1.0, np.nan]):
        with pytest.raises(gp.InputError, match="at least two torques"):
            gp.export_fmu(model, tmp_path / "it.fmu", schedule=torques)
    assert not list(tmp_path.iterdir())


@pytest.fixture
def run(monkeypatch, capsys):
    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["gearpath", "fmu", *map(str, arguments)])
        with pytest.raises(SystemExit) as stop:
            cli.main()
        captured = capsys.readouterr()
        return stop.value.code or 0, captured.out, captured.err

    return call


def test_command_line(run, tmp_path):
    file, fmu = tmp_path / "balls.toml", tmp_path / "it.fmu"
    text = re.sub(r"stiffness = \[\[1.2e8.*", 'catalogue = "6205-like"', MODEL.read_text("utf-8"))
    file.write_text(text + "\n[operation]\ntorque = 80.0\n", "utf-8")
    code, _, error = run(file, "-o", fmu, "--torques", "10,x")
    assert (code, fmu.exists()) == (2, False)
    assert "--torques 10,x: are no numbers; write them in N m, as --torques 10,50,100" in " ".join(error.split())
    code, _, error = run(MODEL, "-o", fmu, "--torques", "10,20")
    assert (code, fmu.exists()) == (2, False)
    assert "no [operation]" in error
    code, out, _ = run(file, "-o", fmu, "--torques", "10, 50,100", "--json")
    assert code == 0
    assert json.loads(out)["fmu"] == str(fmu)
    assert torques_of(fmu) == [10.0, 50.0, 80.0, 100.0]
    code, _, _ = run(file, "-o", fmu, "--json")
    assert torques_of(fmu) == []
