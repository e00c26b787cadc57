"""What is in the FMU: description, dependencies, binaries, sources, and that it is reproducible."""

import struct
import xml.etree.ElementTree as ET
import zipfile
from dataclasses import replace

import numpy as np
import pytest
from fmi_signatures import signatures
from fmpy.validation import validate_fmu
from fmu_driver import OK, Fmu
from fmu_helpers import export
from fmu_networks import gearbox

from gearpath.errors import GearpathError, InputError
from gearpath.fmu import runtime_files
from gearpath.fmu.description import unit_exponents
from gearpath.fmu.native_table import native_table


def test_fmpy_validates(fmu_path):
    assert validate_fmu(str(fmu_path)) == []


@pytest.mark.slow
def test_fmpy_simulates(fmu_path):
    import fmpy

    result = fmpy.simulate_fmu(
        str(fmu_path),
        stop_time=1e-3,
        step_size=1e-5,
        output=["bearing_1.force_uy"],
        start_values={"actuators.shaker": 1.0},
    )
    assert np.isfinite(result["bearing_1.force_uy"]).all()
    assert np.abs(result["bearing_1.force_uy"]).max() > 0


def test_same_model_same_bytes(fmu_path, tmp_path):
    again = export(gearbox(), tmp_path / "again.fmu")
    assert again.read_bytes() == fmu_path.read_bytes()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["again.fmu"]


def test_guid_follows_the_content(network, unpacked, tmp_path):
    def guid(net, **changes):
        with zipfile.ZipFile(export(net, tmp_path / "x.fmu", **changes)) as archive:
            return ET.fromstring(archive.read("modelDescription.xml")).get("guid")

    changed = network.with_joint("mount_1", 1.1e7 * np.ones((1, 1)), 440 * np.ones((1, 1)))
    guids = {guid(network), guid(changed), guid(network, description="B"), guid(network, frequency=501.0)}
    assert len(guids) == 4
    assert unpacked.description.guid in guids


def test_variables_are_in_order_and_described(unpacked, network):
    table = native_table(network, 500.0)
    variables = unpacked.description.modelVariables
    assert [v.name for v in variables] == [v.name for v in table]
    assert [v.valueReference for v in variables] == list(range(len(table)))
    for v in variables:
        assert v.description
        assert float(v.nominal) > 0
        low = -np.inf if v.min is None else float(v.min)
        high = np.inf if v.max is None else float(v.max)
        assert low < high
        if v.start is not None:
            assert low <= float(v.start) <= high
        assert (v.start is None) == (v.causality == "output" or v.derivative is not None)
    names = [v.name for v in variables]
    for expected in ("mesh.transmission_error", "frequency", "bearing_1.stiffness[1,2]", "mount_1.damping"):
        assert expected in names
    assert "bearing_1.stiffness[2,1]" not in names
    assert "bearing_1.power" in names
    assert "frf.bearing_1.power.re" not in names
    assert "mount_1.alpha" not in names
    states = [v.name for v in variables if v.causality == "local" and v.derivative is None]
    assert len(states) == 2 * len(network.eigenvalues)
    assert states[0] == "gear_train.mode_1.x"
    assert states[-1] == "casing.mode_3.v"
    assert [(v.name, v.derivative.name) for v in variables if v.derivative] == [(f"der({s})", s) for s in states]


def test_start_values_are_those_of_the_binary(fmu):
    for v in fmu.unpacked.description.modelVariables:
        if v.start is not None:
            assert fmu.get([v.name])[0] == float(v.start), v.name


def test_units(unpacked):
    units = {u.name: u for u in unpacked.description.unitDefinitions}
    assert len(units) == len(unpacked.description.unitDefinitions)
    exponents = {
        "N.m/rad": (1, 2, -2, -1),
        "N.s/m": (1, 0, -1, 0),
        "(m/s)/m": (0, 0, -1, 0),
        "W": (1, 2, -3, 0),
    }
    for name, expected in exponents.items():
        base = units[name].baseUnit
        assert (base.kg, base.m, base.s, base.rad) == expected, name
    of = {v.name: v.unit for v in unpacked.description.modelVariables}
    assert of["bearing_1.stiffness[1,1]"] == "N/m"
    assert of["bearing_1.stiffness[1,2]"] == "N/rad"
    assert of["bearing_1.stiffness[2,2]"] == "N.m/rad"
    assert of["bearing_1.damping[1,2]"] == "N.s/rad"
    assert of["frf.casing.acceleration_uy.re"] == "(m/s2)/m"


@pytest.mark.parametrize("unit", ["", "furlong", "m//s", "m/", "(m", "m s", "m)"])
def test_unknown_units_are_refused(unit):
    with pytest.raises(InputError, match="not understood"):
        unit_exponents(unit)


def test_outputs_and_unknowns_are_complete_and_unique(unpacked):
    root = ET.parse(unpacked.folder / "modelDescription.xml").getroot()
    variables = list(enumerate(unpacked.description.modelVariables, 1))
    outputs = [i for i, v in variables if v.causality == "output"]
    derivatives = [i for i, v in variables if v.derivative is not None]
    for section, wanted in {
        "Outputs": outputs,
        "Derivatives": derivatives,
        "InitialUnknowns": outputs + derivatives,
    }.items():
        entries = root.findall(f"ModelStructure/{section}/Unknown")
        assert [int(e.get("index")) for e in entries] == wanted
        for entry in entries:
            listed = [int(i) for i in entry.get("dependencies").split()]
            assert listed == sorted(set(listed))
    assert len(derivatives) > 1


def test_binaries_of_all_platforms(fmu_path):
    magic = {
        "linux64/gearbox.so": (b"\x7fELF", 18, 62),
        "aarch64-linux/gearbox.so": (b"\x7fELF", 18, 183),
        "win64/gearbox.dll": (b"MZ", None, None),
        "darwin64/gearbox.dylib": (b"\xca\xfe\xba\xbe", None, None),
        "aarch64-darwin/gearbox.dylib": (b"\xcf\xfa\xed\xfe", 4, 0x000C),
    }
    with zipfile.ZipFile(fmu_path) as archive:
        assert {n for n in archive.namelist() if n.startswith("binaries/")} == {f"binaries/{n}" for n in magic}
        for name, (start, at, machine) in magic.items():
            content = archive.read(f"binaries/{name}")
            assert content.startswith(start), name
            if at is not None:
                assert struct.unpack_from("<H", content, at)[0] == machine, name
        dll = archive.read("binaries/win64/gearbox.dll")
        assert struct.unpack_from("<I", dll, struct.unpack_from("<I", dll, 0x3C)[0] + 8)[0] == 0  # no date
        assert struct.unpack_from("<H", dll, struct.unpack_from("<I", dll, 0x3C)[0] + 4)[0] == 0x8664
        fat = archive.read("binaries/darwin64/gearbox.dylib")
        parts = [struct.unpack_from(">5I", fat, 8 + 20 * i) for i in range(2)]
        assert {p[0] for p in parts} == {0x01000007, 0x0100000C}
        for processor, _, offset, size, align in parts:
            assert offset % (1 << align) == 0
            assert struct.unpack_from("<II", fat, offset) == (0xFEEDFACF, processor)
            assert offset + size <= len(fat)


def test_every_function_of_both_versions_is_exported(unpacked, fmu_path, fmu3_path):
    functions = [f"fmi{version}{name}" for version in (2, 3) for name in signatures(version)]
    assert len(functions) == 44 + 75
    for function in functions:
        assert getattr(unpacked.library, function)
    for path in (fmu_path, fmu3_path):
        with zipfile.ZipFile(path) as archive:  # by name in the others: their tables hold plain text
            for name in archive.namelist():
                if name.startswith("binaries/"):
                    content = archive.read(name)
                    missing = [f for f in functions if f"{f}\0".encode() not in content]
                    assert not missing, name


def test_windows_needs_only_ucrtbase(fmu_path):
    with zipfile.ZipFile(fmu_path) as archive:
        content = archive.read("binaries/win64/gearbox.dll").lower()
    assert b"ucrtbase.dll" in content or b"api-ms-win-crt" in content
    assert b"vcruntime" not in content
    assert b"msvcrt" not in content


def test_missing_runtime_is_explained(network, tmp_path, monkeypatch):
    monkeypatch.setattr(runtime_files, "RUNTIME", tmp_path / "nothing")
    with pytest.raises(GearpathError, match=r"python hatch_build\.py"):
        export(network, tmp_path / "x.fmu")
    assert not (tmp_path / "x.fmu").exists()


def test_extra_files(network, tmp_path):
    path = export(network, tmp_path / "x.fmu", extra_files={"documentation/index.html": b"<html/>"})
    with zipfile.ZipFile(path) as archive:
        assert archive.read("documentation/index.html") == b"<html/>"
        assert {i.date_time for i in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        assert archive.namelist() == sorted(archive.namelist())
    for name in ("modelDescription.xml", "/etc/x", "../x", "a\\b"):
        with pytest.raises(InputError):
            export(network, tmp_path / "y.fmu", extra_files={name: b""})


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda n: replace(n, excitation="nothing"), "none of the network's loads"),
        (lambda n: replace(n, paths=("bearing_9",)), "none of the network's joints"),
        (lambda n: replace(n, modal_damping={"gear_train": 1.0}), "damping ratio"),
        (lambda n: replace(n, eigenvalues=-n.eigenvalues), "negative"),
        (lambda n: replace(n, eigenvalues=n.eigenvalues * np.nan), "not finite"),
        (lambda n: replace(n, outputs=(*n.outputs, n.outputs[0])), "two FMU variables"),
        (lambda n: n.with_joint("mount_1", -np.ones((1, 1)), np.ones((1, 1))), "not positive semidefinite"),
        (lambda n: n.with_joint("bearing_1", np.array([[1, 2], [0, 5.0]]), np.eye(2)), "not symmetric"),
    ],
)
def test_networks_that_cannot_be_exported(network, tmp_path, change, match):
    with pytest.raises(InputError, match=match):
        export(change(network), tmp_path / "x.fmu")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "changes",
    [
        {"model_identifier": "a b"},
        {"step_size": 0.0},
        {"stop_time": -1.0},
        {"frequency": 0.0},
        {"step_size": np.nan},
    ],
)
def test_settings_that_cannot_be_exported(network, tmp_path, changes):
    with pytest.raises(InputError):
        export(network, tmp_path / "x.fmu", **changes)


def test_acceleration_of_the_mesh_itself_is_refused(network, tmp_path):
    from gearpath.network.records import Output

    sensor = next(o for o in network.outputs if o.name == "sensors.gear")
    bad = Output("sensors.bad", "m/s2", "acceleration", row=sensor.row)
    with pytest.raises(InputError, match=r"derivative of mesh\.transmission_error"):
        export(replace(network, outputs=(*network.outputs, bad)), tmp_path / "x.fmu")


def test_smallest_network(tmp_path):
    """One rigid mode on one mount, no modal damping, no outputs of its own: nothing is taken for granted."""
    from gearpath.network.modal import ModalNetwork
    from gearpath.network.records import JointRows, Load, Output

    one = np.ones((1, 1))
    mount = JointRows("mount", "mount", ("uy",), 0.5 * one, 0 * one, 100.0 * one, 0 * one, scalar=True, grounded=True)
    for outputs in ((), (Output("x", "m", "displacement", row=np.array([0.5])),)):
        network = ModalNetwork(
            "oscillator", {"mass": slice(0, 1)}, {}, np.zeros(1), (mount,),
            (Load("force", "N", np.array([0.5])),), outputs, "force", (),
        )  # fmt: skip
        path = export(network, tmp_path / f"{len(outputs)}.fmu")
        assert validate_fmu(str(path)) == []
        fmu = Fmu(Fmu.unpack(path, tmp_path / str(len(outputs))))
        fmu.start()
        assert fmu.set({"force": 1.0}) == OK
        for i in range(100):
            assert fmu.step(0.01 * i, 0.01) == OK
        assert fmu.get(["alpha"]).tolist() == [0.0]
        if outputs:  # m = 4 kg, k = 100 N/m: x = (1 - cos(5 t)) / k
            assert fmu.get(["x"])[0] == pytest.approx((1 - np.cos(5.0)) / 100, rel=1e-12)
        fmu.free()
