"""Reduced FMUs: what they carry, that they are as accurate as they say, joints exchanged while running, refusals."""

import json
import zipfile
from pathlib import Path

import numpy as np
import pytest
from fmi3_driver import Fmu3
from fmu_driver import OK, Fmu

import gearpath as gp

MODELS = Path(__file__).resolve().parents[2] / "models"
HERTZ = np.array([63.0, 520.0, 699.3, 1240.0, 3300.0, 4900.0])


@pytest.fixture(scope="module")
def model():
    return gp.load(MODELS / "gearbox.toml")


@pytest.fixture(scope="module")
def path(model, tmp_path_factory):
    return gp.export_fmu(model, tmp_path_factory.mktemp("reduced") / "small.fmu", tolerance=1e-3, documentation=False)


def certificate(path):
    with zipfile.ZipFile(path) as archive:
        return json.loads(archive.read("resources/reduction.json"))


def transfers(fmu, names):
    """frf outputs over HERTZ, (lines, outputs)."""
    rows = []
    for hertz in HERTZ:
        assert fmu.set({"frequency": float(hertz)}) == OK
        rows.append(fmu.get([f"frf.{n}.re" for n in names]) + 1j * fmu.get([f"frf.{n}.im" for n in names]))
    return np.array(rows)


def complete(model):
    """The complete model's transfers from the excitation, largest gains over the band, and the outputs' names."""
    H = gp.frequency_response(model, HERTZ).sel(input="mesh.transmission_error")
    band = gp.frequency_response(model, np.linspace(20.0, 5000.0, 4000)).sel(input="mesh.transmission_error")
    gain = abs(band.values).max(axis=0)
    heard = gain > 1e-9 * gain.max()
    return H.values[:, heard], gain[heard], [str(n) for n in np.array(H.output)[heard]]


@pytest.mark.parametrize("fmi", ["2.0", "3.0"])
def test_what_reduce_gave_is_the_same_fmu(model, tmp_path, fmi):
    """Bit for bit the one that the model gives with the same tolerance: the gearbox, not a bare linear system."""
    pytest.importorskip("control")
    settings = {"fmi": fmi, "documentation": False}
    one = gp.export_fmu(gp.reduce(model, tolerance=1e-3), tmp_path / "one.fmu", **settings)
    two = gp.export_fmu(model, tmp_path / "two.fmu", tolerance=1e-3, **settings)
    assert one.read_bytes() == two.read_bytes()


def test_an_exchanged_joint_goes_into_the_fmu(model, tmp_path):
    """K of `with_joint` is the start value, and the frequency response that of the model with it."""
    pytest.importorskip("control")
    stiff = [[1.2e9, 1.8e6], [1.8e6, 6e4]]
    reduced = gp.reduce(model, tolerance=1e-3).with_joint("bearing_1", stiff)
    path = gp.export_fmu(reduced, tmp_path / "it.fmu", documentation=False)
    assert certificate(path)["error"] == reduced.certificate.error
    fmu = Fmu(Fmu.unpack(path, tmp_path / "it"))
    fmu.start()
    assert list(fmu.get([f"bearing_1.stiffness[{i}]" for i in ("1,1", "1,2", "2,2")])) == [1.2e9, 1.8e6, 6e4]
    H, gain, names = complete(model.replace({"joints.bearing_1.stiffness": stiff}))
    assert (abs(transfers(fmu, names) - H).max(axis=0) / gain).max() <= reduced.certificate.error
    fmu.free()


def test_what_a_reduced_system_does_not_take(model, tmp_path):
    """Names and units are the gearbox's own; a part of it, and a balanced one, are linear systems with theirs."""
    pytest.importorskip("control")
    reduced = gp.reduce(model, order=25)
    with pytest.raises(gp.InputError, match="name: is for a controller or another linear system only"):
        gp.export_fmu(reduced, tmp_path / "it.fmu", name="plant")
    with pytest.raises(gp.InputError, match="order: is for a Model only"):
        gp.export_fmu(reduced, tmp_path / "it.fmu", order=25)
    with pytest.raises(gp.InputError, match="kind: 'python' is for a Model"):
        gp.export_fmu(reduced, tmp_path / "it.fmu", kind="python")
    with pytest.raises(gp.InputError, match=r"fmi: version '1\.0' is not available"):
        gp.export_fmu(reduced, tmp_path / "it.fmu", fmi="1.0")
    assert not list(tmp_path.iterdir())
    for k, system in enumerate((reduced["casing/velocity_uy", "mesh/force"], gp.reduce(model, 10, method="balanced"))):
        path = gp.export_fmu(system, tmp_path / f"{k}.fmu", name="plant", documentation=False)
        assert b'modelName="plant"' in zipfile.ZipFile(path).read("modelDescription.xml")


@pytest.mark.parametrize("version", [2, 3])
def test_the_fmu_keeps_its_certificate_and_its_joints_are_tunable(model, version, tmp_path):
    path = gp.export_fmu(model, tmp_path / "small.fmu", fmi=f"{version}.0", tolerance=1e-3, documentation=False)
    found = certificate(path)
    assert found["order"] == 25
    assert found["complete"] == 72
    assert found["error"] <= 1e-3
    assert found["passive"]
    fmu = {2: Fmu, 3: Fmu3}[version](Fmu.unpack(path, tmp_path / "it"))
    fmu.start()
    H, gain, names = complete(model)
    assert (abs(transfers(fmu, names) - H) <= found["error"] * gain).all()
    K, C = [[6e7, -9e5], [-9e5, 8e4]], [[300.0, 4.0], [4.0, 0.9]]
    changed = model.replace({"joints.bearing_1.stiffness": K, "joints.bearing_1.damping": C})
    entry = "bearing_1.{}[{},{}]"
    values = {entry.format("stiffness", i + 1, k + 1): K[i][k] for i in range(2) for k in range(i, 2)}
    values |= {entry.format("damping", i + 1, k + 1): C[i][k] for i in range(2) for k in range(i, 2)}
    if version == 3:
        values = {"bearing_1.stiffness": np.ravel(K), "bearing_1.damping": np.ravel(C)}
    assert fmu.set(values) == OK
    H, gain, names = complete(changed)
    assert (abs(transfers(fmu, names) - H) <= 1e-3 * gain).all()
    fmu.free()


def test_power_ratios_follow(model, path, tmp_path):
    fmu = Fmu(Fmu.unpack(path, tmp_path / "it"))
    fmu.start()
    alpha = gp.power_flow(model, HERTZ).alpha.values
    for hertz, wanted in zip(HERTZ, alpha):
        assert fmu.set({"frequency": float(hertz)}) == OK
        assert fmu.get(["alpha"])[0] == pytest.approx(wanted, abs=1e-3)
    fmu.free()


@pytest.mark.slow
def test_validation_knows_the_reduction(model, path):
    report = gp.validate_fmu(path, model)
    assert report.passed, [check for check in report.checks if not check.passed]
    names = [check.name for check in report.checks]
    assert "reduction against the complete model" in names
    assert "swept sine against python-control" in names
    other = gp.validate_fmu(path, model.replace({"components.gear_train.modal_damping": 0.03}))
    assert not other.passed


def test_the_same_reduction_gives_the_same_bytes(model, path, tmp_path):
    again = gp.export_fmu(model, tmp_path / "again.fmu", tolerance=1e-3, documentation=False)
    assert again.read_bytes() == path.read_bytes()


def test_a_schedule_is_reduced_for_all_its_torques(tmp_path):
    model = gp.load(MODELS / "bearing_study.toml")
    torques = [20.0, 60.0, 120.0]
    path = gp.export_fmu(model, tmp_path / "it.fmu", schedule=torques, tolerance=1e-2, documentation=False)
    found = certificate(path)
    assert found["error"] <= 1e-2
    assert found["order"] < found["complete"]
    fmu = Fmu(Fmu.unpack(path, tmp_path / "it"))
    fmu.start()
    names = [f"{joint}.force_uy" for joint in list(model.system.joints)[:2]]
    for torque in torques:
        assert fmu.set({"operation.torque": torque}) == OK
        there = model.replace({"operation.torque": torque})
        H = gp.frequency_response(there, HERTZ, names).sel(input=_excitation(there)).values
        lines = np.linspace(model.frequency.start, model.frequency.stop, 3000)
        gain = abs(gp.frequency_response(there, lines, names).sel(input=_excitation(there)).values).max(axis=0)
        assert (abs(transfers(fmu, names) - H) <= found["error"] * gain).all()
    fmu.free()


def _excitation(model):
    return gp.api.modal_network(model).excitation


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"kind": "python", "order": 20}, "the python kind is the whole solver"),
        ({"order": 20, "tolerance": 1e-3}, "give one of the two"),
        ({"band": (20.0, 500.0)}, "only a reduced FMU has one"),
        ({"order": -1}, "order: -1 is not a number"),
    ],
)
def test_requests_that_do_not_fit_write_nothing(model, tmp_path, settings, words):
    with pytest.raises(gp.InputError, match=words):
        gp.export_fmu(model, tmp_path / "it.fmu", **settings)
    assert not list(tmp_path.iterdir())


def test_a_damaged_record_is_refused(model, path, tmp_path):
    damaged = tmp_path / "damaged.fmu"
    with zipfile.ZipFile(path) as source, zipfile.ZipFile(damaged, "w") as target:
        for name in source.namelist():
            content = source.read(name)
            target.writestr(name, b"{}" if name == "resources/reduction.json" else content)
    with pytest.raises(gp.InputError, match=r"reduction\.json cannot be read"):
        gp.validate_fmu(damaged, model)
