"""What the model description says of a schedule, and schedules that are refused."""

from dataclasses import replace

import numpy as np
import pytest
from fmpy.validation import validate_fmu
from fmu_driver import Fmu
from fmu_helpers import export
from schedule_machine import START, TORQUE, TORQUES, machine

from gearpath.errors import InputError
from gearpath.fmu.binary import scheduled_torques
from gearpath.fmu.conformance import Severity, check_conformance
from gearpath.network.records import Schedule

BOTH = pytest.mark.parametrize("version", [2, 3])


def named(unpacked):
    return {v.name: v for v in unpacked.description.modelVariables}


@BOTH
def test_conformance(schedule_paths, version):
    """Our own rules, which also run the binary and compare dependencies and derivatives, and fmpy's."""
    assert [f for f in check_conformance(schedule_paths[version]) if f.severity != Severity.NOTE] == []
    assert validate_fmu(str(schedule_paths[version])) == []


@BOTH
def test_variables(fmus, version):
    found = named(fmus[version])
    torque = found[TORQUE]
    assert (torque.causality, torque.variability, torque.unit) == ("input", "continuous", "N.m")
    assert [float(torque.start), float(torque.min), float(torque.max)] == [START, TORQUES[0], TORQUES[-1]]
    entry = "" if version == 3 else "[1,2]"
    for name in (f"bearing_1.stiffness{entry}", f"bearing_2.damping{entry}", "mount_1.stiffness"):
        v = found[name]
        assert (v.causality, v.variability, v.initial, v.start) == ("local", "continuous", "calculated", None)
        assert TORQUE in v.description
    for name in (f"bearing_1.damping{entry}", f"bearing_3.stiffness{entry}", "mount_1.damping"):
        assert (found[name].causality, found[name].variability) == ("parameter", "tunable")


@BOTH
def test_dependencies(fmus, version):
    """Forces, powers, accelerations and all over frequency; velocities and displacements do not jump with it."""
    description = fmus[version].description
    listed = {u.variable.name: {d.name for d in u.dependencies} for u in description.outputs}
    for name in ("bearing_1.force_uy", "bearing_2.power", "mount_1.force_uy", "casing.acceleration_uy", "alpha"):
        assert TORQUE in listed[name], name
    assert all(TORQUE in listed[name] for name in listed if name.startswith("frf.") or "alpha" in name)
    for name in ("bearing_1.velocity_uy", "casing.displacement_uy", "bearing_3.force_uy", "mount_2.force_uy"):
        assert TORQUE not in listed[name], name
    initial = {u.variable.name: {d.name for d in u.dependencies} for u in description.initialUnknowns}
    everything = set().union(*initial.values())
    assert TORQUE in initial["bearing_1.force_uy"]
    assert not [name for name in everything if name.startswith(("bearing_2.", "mount_1.stiffness"))]
    assert not [name for name in initial if name.startswith("bearing_1.stiffness")]


def test_matrices_of_the_state_equations(fmus, tmp_path):
    """Those that follow an input are no calculated parameters."""
    assert {named(fmus[3])[f"system.{name}"].causality for name in "ABCD"} == {"local"}
    network = machine(1)
    schedule = replace(network.schedule, damping={})
    path = export(replace(network, schedule=schedule), tmp_path / "it.fmu", fmi="3.0")
    found = named(Fmu.unpack(path, tmp_path / "it"))
    wanted = {"A": "local", "B": "calculatedParameter", "C": "local", "D": "calculatedParameter"}
    assert {name: found[f"system.{name}"].causality for name in "ABCD"} == wanted
    assert [f for f in check_conformance(path) if f.severity == Severity.ERROR] == []


@BOTH
def test_page(fmus, version):
    page = (fmus[version].folder / "documentation" / "index.html").read_text()
    assert "Stiffness over the torque" in page
    assert "10, 25, 40, 100&nbsp;N&nbsp;m" in page
    assert "Following operation.torque" in page


def bad_schedules():
    good = machine(1).schedule
    K, C, T = good.stiffness, good.damping, good.torques
    lopsided, indefinite, broken = (K["bearing_1"].copy() for _ in range(3))
    lopsided[1, 0, 1] += 1e4
    indefinite[2] = [[1e6, 2e5], [2e5, 1e4]]
    broken[0, 0, 0] = np.nan
    return {
        "at least two": Schedule(T[:1], {"bearing_1": K["bearing_1"][:1]}, {}),
        "finite and increasing": Schedule(T[[0, 1, 1, 3]], K, C),
        "finite": Schedule(np.array([1.0, 2.0, 3.0, np.inf]), K, C),
        "give at most 8192": Schedule(np.arange(8193.0), K, C),
        "no joint follows": Schedule(T, {}, {}),
        "no stiffness": Schedule(T, {"bearing_1": K["bearing_1"]}, C),
        "there is no joint 'bearing_9'": Schedule(T, {"bearing_9": K["bearing_1"]}, {}),
        "2 by 2 matrix at each of 4 torques": Schedule(T, {"bearing_1": K["bearing_1"][:3]}, {}),
        "bearing_1.stiffness at 25 N m: the matrix is not symmetric": Schedule(T, K | {"bearing_1": lopsided}, C),
        "40 N m: the matrix is not positive semidefinite": Schedule(T, K | {"bearing_1": indefinite}, C),
        "10 N m: the matrix holds a number that is not finite": Schedule(T, K | {"bearing_1": broken}, C),
    }


@pytest.mark.parametrize(("words", "schedule"), bad_schedules().items(), ids=bad_schedules())
def test_bad_schedules(words, schedule, tmp_path):
    with pytest.raises(InputError, match=r"schedule|bearing_1") as caught:
        export(replace(machine(1), schedule=schedule), tmp_path / "it.fmu")
    assert words in str(caught.value)
    assert not list(tmp_path.iterdir())


def test_without_a_schedule_there_is_none_of_it(tmp_path):
    path = export(replace(machine(1), schedule=None), tmp_path / "it.fmu")
    unpacked = Fmu.unpack(path, tmp_path / "it")
    assert TORQUE not in named(unpacked)
    assert scheduled_torques((unpacked.folder / "resources" / "model.bin").read_bytes()).size == 0
    for content in (b"", b"GEARPATH" + bytes(200)):
        with pytest.raises(InputError, match=r"model\.bin cannot be read"):
            scheduled_torques(content)
