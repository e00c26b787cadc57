"""Measured components in model files: formats, units, signs, reciprocity, and what is refused."""

from pathlib import Path

import numpy as np
import pytest
import pyuff

from gearpath.errors import ModelError
from gearpath.modelfile import Model

F = np.linspace(0.0, 400.0, 101)  # a line at 0 Hz, as analysers write it
W = 2 * np.pi * F[1:]
SHAPES = np.array([[0.5, 0.3], [0.2, -0.6], [0.4, 0.1]])


def mobility(w=W):
    """Two modes and a rigid-body line at three channels."""
    w = w[:, None]
    w_r, zeta = 2 * np.pi * np.array([90.0, 210.0]), np.array([0.02, 0.03])
    lines = 1j * w / (w_r**2 - w**2 + 2j * zeta * w_r * w)
    return np.einsum("ar,fr,br->fab", SHAPES, lines, SHAPES) + (0.05 / (1j * w))[:, :, None]


def machine(table, dofs=("ux", "uy"), matrix=((2e6, 0.0), (0.0, 2e6)), **more):
    """A rigid block on a measured foundation with two ports."""
    matrix = [list(row) for row in matrix]
    return {
        "name": "block_on_foundation",
        "dofs": list(dofs),
        "frequency": {"start": 10.0, "stop": 400.0, "points": 50},
        "components": {
            "block": {"kind": "rigid_body", "mass": 3.0, "inertia": {"xx": 0.1, "yy": 0.1, "zz": 0.1}},
            "foundation": {"kind": "measured", **table},
        },
        "joints": {
            "bearing": {
                "kind": "bearing", "between": ["block", "foundation.seat"], "at": [0.1, 0.0, 0.0],
                "stiffness": matrix, "damping_time": 1e-5,
            },
            "mount": {"kind": "mount", "between": ["foundation.foot", "ground"], "at": [0.0, 0.0, 0.0],
                      "stiffness": 1e5, "damping": 10.0},
        },
        "excitation": {"point": "block", "dof": "uy"},
        **more,
    }  # fmt: skip


PORTS = {"seat": {"ux": 0, "uy": 1}, "foot": {"uy": 2}}


def build(folder, data):
    return Model.from_dict(data, str(folder / "model.toml"))


def component(folder, table, **more):
    return build(folder, machine(table, **more)).system.components["foundation"]


def full(values):
    """With the line at 0 Hz, where an analyser has anything."""
    return np.concatenate([np.full((1, *values.shape[1:]), 0.0), values])


def write_npz(folder, values, **more):
    np.savez(folder / "data.npz", frequencies=F, frf=full(values), **more)


def write_csv(folder, values, pairs, header="frequency_hz"):
    names = "abc"
    columns = [f'"H[{names[i]},{names[k]}].{part}"' for i, k in pairs for part in ("re", "im")]
    rows = [[f, *(x for i, k in pairs for x in (H[i, k].real, H[i, k].imag))] for f, H in zip(F, full(values))]
    text = "\n".join([",".join([header, *columns]), *(",".join(repr(float(x)) for x in row) for row in rows)])
    (folder / "data.csv").write_text(f"# a comment\n{text}\n")


def write_uff(folder, values, directions, data_type=12, length=1.0, force=1.0, skip=(), labels=None):
    """Datasets 164 and 58 of channels at nodes 1, 2, 3, measured along these directions (2 is +Y, -2 is -Y).

    Without dataset 164 where the axes have `labels` and `length` is None.
    """
    path = folder / "data.unv"
    path.unlink(missing_ok=True)
    file = pyuff.UFF(str(path))
    if length is not None:
        units = {"units_code": 9, "units_description": "own", "temp_mode": 1, "length": length, "force": force}
        file._write_set(pyuff.prepare_164(**units, temp=1.0, temp_offset=0.0), "add")
    axes = dict(zip(("ordinate_axis_units_lab", "orddenom_axis_units_lab"), labels or ()))
    for i in range(3):
        for k in range(3):
            if (i, k) not in skip:
                signs = np.sign(directions[i]) * np.sign(directions[k])
                file._write_set(
                    pyuff.prepare_58(
                        func_type=4, rsp_node=i + 1, rsp_dir=directions[i], ref_node=k + 1, ref_dir=directions[k],
                        data=signs * full(values)[:, i, k], x=F, binary=0, abscissa_spacing=1, abscissa_min=0.0,
                        abscissa_inc=F[1], ordinate_spec_data_type=data_type, orddenom_spec_data_type=13,
                        abscissa_spec_data_type=18, **axes,
                    ),
                    "add",
                )  # fmt: skip


def assert_is_the_mobility(found):
    np.testing.assert_allclose(found.omega, W, rtol=1e-12)
    np.testing.assert_allclose(found.mobility, mobility(), rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize(
    ("quantity", "factor", "units"),
    [
        ("mobility", 1.0, {}),
        ("accelerance", 1j * W, {}),
        ("receptance", 1 / (1j * W), {}),
        ("accelerance", 1j * W / 9.80665, {"unit_motion": "g"}),
        ("mobility", np.full(len(W), 1e6), {"unit_motion": "mm/s", "unit_force": "kN"}),
        ("receptance", 1e6 / (1j * W), {"unit_motion": 1e-6}),
        ("mobility", np.full(len(W), 4.4482216152605), {"unit_force": "lbf"}),
    ],
)
def test_quantities_and_units(tmp_path, quantity, factor, units):
    write_npz(tmp_path, mobility() * np.broadcast_to(factor, len(W))[:, None, None])
    table = {"file": "data.npz", "quantity": quantity, "ports": PORTS, **units}
    assert_is_the_mobility(component(tmp_path, table))


def test_channels_by_name_and_in_any_order(tmp_path):
    write_npz(tmp_path, mobility()[:, ::-1, ::-1], channels=["third", "second", "first"])
    ports = {"seat": {"ux": "first", "uy": "second"}, "foot": {"uy": 0}}
    assert_is_the_mobility(component(tmp_path, {"file": "data.npz", "quantity": "mobility", "ports": ports}))


def test_a_table_of_text_filled_by_reciprocity(tmp_path):
    write_csv(tmp_path, mobility(), [(0, 0), (0, 1), (2, 0), (1, 1), (2, 1), (2, 2)])
    ports = {"seat": {"ux": "a", "uy": "b"}, "foot": {"uy": "c"}}
    assert_is_the_mobility(component(tmp_path, {"file": "data.csv", "quantity": "mobility", "ports": ports}))


def test_a_universal_file_says_quantity_units_and_signs(tmp_path):
    """Millimetres and millinewtons, two channels along negative axes, a transpose left out."""
    acceleration = mobility() * (1j * W)[:, None, None]
    write_uff(tmp_path, acceleration * 1e3 / 1e3, (-1, 2, -2), length=1e3, force=1e3, skip=[(0, 2)])
    ports = {"seat": {"ux": "1:ux", "uy": "2:uy"}, "foot": {"uy": "3:uy"}}
    assert_is_the_mobility(component(tmp_path, {"file": "data.unv", "ports": ports}))


def test_a_universal_file_says_units_on_its_axes(tmp_path):
    H = mobility() * (1j * W)[:, None, None]
    table = {"file": "data.unv", "ports": {"seat": {"ux": "1:ux", "uy": "2:uy"}, "foot": {"uy": "3:uy"}}}
    write_uff(tmp_path, H / 9.80665 * 1e3, (1, 2, 2), length=None, labels=("g", "kN"))
    assert_is_the_mobility(component(tmp_path, table))
    write_uff(tmp_path, H, (1, 2, 2), labels=("(m/s**2)", "N"))
    assert_is_the_mobility(component(tmp_path, table))
    write_uff(tmp_path, H, (1, 2, 2), labels=("g", "N"))
    assert "unit_motion: is missing; the file says g on an axis, and 1 of SI units" in refusal(tmp_path, table)
    with pytest.warns(UserWarning, match='unit_motion: "m/s.2" counts, though the file says g on an axis'):
        assert_is_the_mobility(component(tmp_path, {**table, "unit_motion": "m/s^2"}))


@pytest.mark.parametrize(
    ("labels", "length", "words"),
    [
        (("mV", "N"), None, 'unit_motion: is missing; the file says "mV" on an axis'),
        (("m/s/s", "EU"), None, 'unit_force: is missing; the file says "EU" on an axis'),
        (("mm/s", "N"), 1.0, "which is none of the units m/s^2, mm/s^2, g, in/s^2"),
    ],
)
def test_units_that_are_not_known_are_asked_for(tmp_path, labels, length, words):
    write_uff(tmp_path, mobility() * (1j * W)[:, None, None], (1, 2, 2), length=length, labels=labels)
    table = {"file": "data.unv", "ports": {"seat": {"ux": "1:ux", "uy": "2:uy"}, "foot": {"uy": "3:uy"}}}
    assert words in refusal(tmp_path, table)
    key = words.split(":")[0] if ":" in words else "unit_motion"
    assert_is_the_mobility(component(tmp_path, {**table, key: 1.0}))


@pytest.mark.parametrize(
    ("factor", "words"),
    [
        (1j * W, "quantity: is mobility, but no passive structure has such driving points; they would do as accel"),
        (1 / (1j * W), "they would do as receptance"),
        (None, "would do with phasors e^(-i w t): conjugate the data"),
        (np.full(len(W), -1.0), "would do with force and response of opposite signs"),
    ],
)
def test_data_that_are_not_what_they_are_said_to_be(tmp_path, factor, words):
    write_npz(tmp_path, mobility().conj() if factor is None else mobility() * factor[:, None, None])
    assert words in refusal(tmp_path, {**GOOD, "quantity": "mobility"})


def test_units_of_the_table_go_before_those_of_the_file(tmp_path):
    write_uff(tmp_path, mobility() * (1j * W)[:, None, None] / 9.80665, (1, 2, 2), length=1e3)
    ports = {"seat": {"ux": "1:ux", "uy": "2:uy"}, "foot": {"uy": "3:uy"}}
    assert_is_the_mobility(component(tmp_path, {"file": "data.unv", "ports": ports, "unit_motion": "g"}))


def test_a_joint_connects_what_both_ends_have(tmp_path):
    """The seat lacks rx: the bearing keeps its translations, rows and columns of its matrix."""
    write_npz(tmp_path, mobility())
    table = {"file": "data.npz", "quantity": "mobility", "ports": PORTS}
    matrix = ((2e6, 1e5, 3e3), (1e5, 4e6, 5e3), (3e3, 5e3, 2e4))
    joint = build(tmp_path, machine(table, ("ux", "uy", "rx"), matrix)).system.joints["bearing"]
    assert joint.dofs == ("ux", "uy")
    assert joint.stiffness == ((2e6, 1e5), (1e5, 4e6))


def test_places_of_ports_are_places_of_joints(tmp_path):
    write_npz(tmp_path, mobility())
    ports = {"seat": {**PORTS["seat"], "at": [0.1, 0.0, 0.0]}, "foot": PORTS["foot"]}
    data = machine({"file": "data.npz", "quantity": "mobility", "ports": ports})
    del data["joints"]["bearing"]["at"]
    found = build(tmp_path, data).system.components["foundation"]
    assert found.position("seat") == (0.1, 0.0, 0.0)
    assert found.position("foot") is None


GOOD = {"file": "data.npz", "quantity": "mobility", "ports": PORTS}


@pytest.mark.parametrize(
    ("change", "key", "words"),
    [
        ({"file": "data.txt"}, "file", "is no file of FRFs"),
        ({"file": "none.npz"}, "file", "there is no such file"),
        ({"quantity": "impedance"}, "quantity", "is not a quantity"),
        ({"quantity": ""}, "quantity", "is not a quantity"),
        ({"unit_motion": "g"}, "unit_motion", "is no unit of mobility"),
        ({"unit_motion": "parsec"}, "unit_motion", "is not a known unit"),
        ({"unit_force": 0.0}, "unit_force", "is not above 0"),
        ({"ports": {}}, "ports", "there is no port"),
        ({"ports": {**PORTS, "seat": {}}}, "ports.seat", "has no channel"),
        ({"ports": {**PORTS, "seat": {"ux": 7}}}, "ports.seat.ux", "no channel 7 among 3"),
        ({"ports": {**PORTS, "seat": {"uy": "x"}}}, "ports.seat.uy", 'no channel "x"'),
        ({"ports": {**PORTS, "seat": {"uy": 2}}}, "ports.foot.uy", "already the channel of seat.uy"),
        ({"ports": {**PORTS, "seat": {"uy": True}}}, "ports.seat.uy", "is not a channel"),
        ({"ports": {**PORTS, "seat": {"uz": 0}}}, "joints.bearing.between", "do not both have"),
        ({"ports": {"seat": {"uy": 0}, "foot": {"ux": 1}}}, "joints.mount.between", "do not both have uy"),
        ({"ports": {"seat": {"uy": 0}}}, "joints.mount.between", 'there is no port "foundation.foot"'),
        ({"tolerance": 1.0}, "tolerance", "is not below 1"),
        ({"modes": 0}, "modes", "out of range"),
    ],
)
def test_refused(tmp_path, change, key, words):
    write_npz(tmp_path, mobility())
    with pytest.raises(ModelError) as caught:
        build(tmp_path, machine({**GOOD, **change}))
    wanted = key if key.startswith("joints") else f"components.foundation.{key}"
    assert caught.value.key == wanted
    assert words in caught.value.problem
    assert caught.value.remedy


def refusal(folder, table, **more):
    with pytest.raises(ModelError) as caught:
        build(folder, machine(table, **more))
    return str(caught.value)


def test_a_range_outside_the_band_is_refused(tmp_path):
    write_npz(tmp_path, mobility())
    text = refusal(tmp_path, GOOD, frequency={"start": 10.0, "stop": 500.0, "points": 5})
    assert "frequency.stop: 500 Hz is outside 4 to 400 Hz, where foundation was measured" in text


def test_actuators_and_sensors_sit_on_ports(tmp_path):
    write_npz(tmp_path, mobility())
    sensor = {"component": "foundation", "point": "foot", "dof": "uy"}
    model = build(tmp_path, machine(GOOD, sensors={"s": sensor}))
    assert model.system.sensors["s"].port.place == "foot"
    assert "not among the channels" in refusal(tmp_path, GOOD, sensors={"s": {**sensor, "dof": "ux"}})
    assert "not the name of a port" in refusal(tmp_path, GOOD, sensors={"s": {**sensor, "point": [0.0, 0.0, 0.0]}})


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("f,H[a,a].re\n1,2\n", "frequency_hz"),
        ("frequency_hz,H[a,a].re\n1,2\n2,3\n", "only one of .re and .im"),
        ("frequency_hz,H[a,a].re,H[a,a].im\n1,2\n", "2 columns in place of 3"),
        ("frequency_hz,H[a,a].re,H[a,a].im\n1,2,x\n", "could not convert"),
        ("frequency_hz,H[a,a].re,H[a,a].im\n1,2,3\n1,2,3\n", "the line 1 Hz is there twice"),
        ("frequency_hz,H(a,a)\n1,2\n", "is no FRF"),
        ("frequency_hz\n1\n", "has no FRF"),
        ("frequency_hz,H[a,a].re,H[a,a].im\n5,2,3\n", "has 1 lines"),
        ("frequency_hz,H[a,a].re,H[a,a].im\n-5,2,3\n6,1,1\n", "not finite numbers from 0 up"),
        ("", "frequency_hz"),
    ],
)
def test_unusable_tables(tmp_path, text, words):
    (tmp_path / "data.csv").write_text(text)
    assert words in refusal(tmp_path, {**GOOD, "file": "data.csv"})


def test_frfs_missing_both_ways_are_named(tmp_path):
    write_csv(tmp_path, mobility(), [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2)])
    ports = {"seat": {"ux": "a", "uy": "b"}, "foot": {"uy": "c"}}
    text = refusal(tmp_path, {**GOOD, "file": "data.csv", "ports": ports})
    assert "no complete FRF between seat.ux and foot.uy, either way" in text


def test_unusable_archives_and_universal_files(tmp_path):
    for name in ("data.npz", "data.unv"):
        (tmp_path / name).write_bytes(b"\x00 neither the one nor the other")
        assert f"{name}: " in refusal(tmp_path, {**GOOD, "file": name})
    np.savez(tmp_path / "data.npz", frf=np.ones((5, 1, 1)))
    assert "has no array 'frequencies'" in refusal(tmp_path, GOOD)
    np.savez(tmp_path / "data.npz", frequencies=np.arange(4.0), frf=np.ones((5, 1, 1)))
    assert "do not fit" in refusal(tmp_path, GOOD)
    write_uff(tmp_path, mobility(), (1, 2, 2), data_type=8)
    ports = {"seat": {"ux": "1:ux", "uy": "2:uy"}, "foot": {"uy": "3:uy"}}
    text = refusal(tmp_path, {"file": "data.unv", "quantity": "mobility", "ports": ports})
    assert '"mobility" is given for a file that holds receptance' in text


def test_the_same_file_changed_is_read_again(tmp_path):
    write_npz(tmp_path, mobility())
    first = component(tmp_path, GOOD)
    write_npz(tmp_path, 2 * mobility(), channels=["1", "2", "3"])
    second = component(tmp_path, GOOD)
    np.testing.assert_allclose(second.mobility, 2 * first.mobility)
    assert Path(tmp_path / "data.npz").exists()
