"""The helical gearbox of models/: its numbers follow from its gears, and what the file's new keys become."""

from pathlib import Path

import numpy as np
import pytest

import gearpath as gp
from gearpath.components import DOFS, Section
from gearpath.errors import ModelError
from gearpath.fmu.python_design import design_parameters
from gearpath.network.assemble import assemble
from gearpath.network.natural import natural_frequencies
from gearpath.network.power import power_flow
from gearpath.network.reference import reference_solution
from gearpath.study.sweeping import reference_checks

MODELS = Path(__file__).parents[2] / "models"
MESH = "components.gear_train.meshes.mesh"


@pytest.fixture(scope="module")
def model():
    return gp.load(MODELS / "helical_gearbox.toml")


def test_mesh_data_follow_from_the_gears(model):
    """Module 2 mm, 32 and 64 teeth, 20 deg, centre distance 100 mm (ISO 21771)."""
    mesh = model.system.components["gear_train"].meshes["mesh"]
    cos_beta = 2e-3 * (32 + 64) / (2 * 0.1)
    transverse = np.arctan(np.tan(np.radians(20)) / cos_beta)
    base = np.arcsin(np.sqrt(1 - cos_beta**2) * np.cos(np.radians(20)))
    assert mesh.pressure_angle == pytest.approx(transverse, rel=1e-5)
    assert mesh.helix_angle == pytest.approx(base, rel=1e-5)
    radii = np.array([32, 64]) * 2e-3 / (2 * cos_beta) * np.cos(transverse)
    np.testing.assert_allclose(mesh.base_radii, radii, rtol=1e-5)
    train = model.system.components["gear_train"]
    first, second = (train.shafts[s].position(train.shafts[s].disk(d).z) for s, d in mesh.between)
    n = mesh.line_of_action(first, second)  # F_t : F_r : F_a = 1 : tan(alpha_t) : tan(beta), upwards on the wheel
    np.testing.assert_allclose(n / n[1], [np.tan(transverse), 1.0, -np.sqrt(1 / cos_beta**2 - 1)], rtol=1e-4)


def test_gear_bodies_are_steel_rings(model):
    train = model.system.components["gear_train"]
    for disk, outer, bore, width in (
        (train.shafts["input"].disk("pinion"), 66.667e-3, 36e-3, 32e-3),
        (train.shafts["output"].disk("wheel"), 133.333e-3, 42e-3, 30e-3),
    ):
        mass = 7850 * np.pi / 4 * (outer**2 - bore**2) * width
        squares = (outer**2 + bore**2) / 4
        found = [disk.mass, disk.polar_inertia, disk.diametral_inertia]
        np.testing.assert_allclose(found, [mass, mass * squares / 2, mass * (3 * squares + width**2) / 12], rtol=1e-3)


def test_bearings_hold_in_five_directions_and_turn_freely(model):
    for name in ("bearing_1", "bearing_2", "bearing_3", "bearing_4"):
        joint = model.system.joints[name]
        assert joint.dofs == DOFS
        K = np.array(joint.stiffness)
        lever = np.array([1, 1, 1, 0.02, 0.02, 0.02])
        values = np.linalg.eigvalsh(K * np.outer(1 / lever, 1 / lever))
        assert values[0] == 0.0
        assert values[1] > 1e-3 * values[-1]
        assert not K[5].any()
        assert K[1, 3] == -K[0, 4] != 0.0  # a ring turned about z is the same ring
    assert model.system.joints["bearing_1"].stiffness[1][3] == -model.system.joints["bearing_2"].stiffness[1][3]


def test_the_model_passes_its_own_checks(model):
    few = model.replace({"frequency.points": 100})
    for check in reference_checks(few):
        assert check.passed, check


def test_every_direction_carries_power(model):
    """Force and moment paths in all planes, and the free rotation in none; alpha against the direct solution."""
    network = assemble(model.system)
    omega = 2 * np.pi * np.array([100.0, 1000.0, 3000.0])
    flow = power_flow(network.modal(), omega)
    np.testing.assert_allclose(flow.share(), reference_solution(network, omega).alpha, rtol=1e-8)
    for dof in DOFS:
        part = np.max([abs(flow.path_power[flow.paths.index(f"bearing_{k}.{dof}")]) for k in (1, 2, 3, 4)], axis=0)
        if dof == "rz":
            np.testing.assert_array_equal(part, 0.0)
        else:
            assert np.all(part > 1e-5 * flow.input_power), dof


def test_shafts_turn_together_freely(model):
    """One natural frequency is zero, as both shafts turn while their gears roll; the casing is held by its mounts."""
    found = natural_frequencies(assemble(model.system).modal())
    assert found[0] < 0.1
    assert found[1] > 50.0


def test_tapered_sections_of_the_file(model):
    sections = model.system.components["gear_train"].shafts["input"].sections
    assert sections[0] == Section(0.036, 0.0214, 0.0, 0.0250, 0.0)
    assert sections[0].tapered
    assert sections[1] == Section(0.034, 0.028)
    shaft = "components.gear_train.shafts.input"
    alike = model.replace({f"{shaft}.sections": [{"length": 0.206, "outer": [0.03, 0.03]}], f"{shaft}.elements": 2})
    assert alike.system.components["gear_train"].shafts["input"].sections == (Section(0.206, 0.03),)
    cone = alike.replace({f"{shaft}.sections": [{"length": 0.206, "outer": [0.03, 0.04]}]})
    offered = [{parameter.name for parameter in design_parameters(m.system)} for m in (alike, cone)]
    assert offered[0] - offered[1] == {"gear_train.input.diameter"}  # a cone has no one diameter to set


def test_system_is_plain_data(model):
    """`eval` of the repr gives the system again, as the python FMU needs it."""
    from gearpath import components, joints
    from gearpath.network import system as module

    names = {**vars(components), **vars(joints), **vars(module)}
    assert eval(repr(model.system), names) == model.system


def test_keys_of_the_mesh_can_be_replaced(model):
    mesh = model.replace({f"{MESH}.driving_torque": "-z", f"{MESH}.contact_offset": 0.003, f"{MESH}.helix_angle": -0.2})
    built = mesh.system.components["gear_train"].meshes["mesh"]
    assert (built.driving_torque, built.contact_offset, built.helix_angle) == ("-z", 0.003, -0.2)
    moved = "components.gear_train.shafts.input.disks.pinion.z"
    with pytest.raises(ModelError, match=r"are 0.004 m apart along z; move a disk, or say with contact_offset"):
        model.replace({moved: 0.132})
    assert model.replace({moved: 0.132, f"{MESH}.contact_offset": -0.002})


def test_reversed_torque_loads_the_other_flanks(model):
    """The line of action swings to the other side of the tangent: another machine, not a change of sign."""
    other = model.replace({f"{MESH}.driving_torque": "-z"})
    omega = 2 * np.pi * np.array([1500.0])
    one, two = (power_flow(assemble(m.system).modal(), omega).share() for m in (model, other))
    assert abs(two / one - 1) > 0.05


def test_handedness_is_a_mirror_image(model):
    """Both helices, hands exchanged, with all else mirrored about z = 0: the same power by mirrored paths."""
    text = model.to_dict()
    train = text["components"]["gear_train"]
    for shaft in train["shafts"].values():
        length = sum(section["length"] for section in shaft["sections"])
        shaft["origin"][2] = -(shaft["origin"][2] + length)
        shaft["sections"] = [
            {**s, "outer": s["outer"][::-1] if isinstance(s["outer"], list) else s["outer"]}
            for s in shaft["sections"][::-1]
        ]
        shaft["elements"] = shaft["elements"][::-1]
        for disk in shaft["disks"]:
            disk["z"] = length - disk["z"]
    mesh = train["meshes"]["mesh"]
    mesh["helix_angle"], mesh["driving_torque"] = -mesh["helix_angle"], "+z"
    casing = text["components"]["casing"]
    casing["centre_of_gravity"][2] *= -1
    casing["inertia"]["xz"] *= -1
    casing["inertia"]["yz"] *= -1
    sign = np.array([1, 1, -1, -1, -1, 1])  # of ux uy uz rx ry rz in the mirror z -> -z; rz is a torque about z
    for joint in text["joints"].values():
        joint["stiffness"] = (np.array(joint["stiffness"]) * np.outer(sign, sign)).tolist()
        if "at" in joint:
            joint["at"][2] *= -1
        else:
            shaft, z = joint["between"][0].removeprefix("gear_train.").split("@")
            length = sum(section["length"] for section in train["shafts"][shaft]["sections"])
            joint["between"][0] = f"gear_train.{shaft}@{length - float(z):.9g}"
    mirrored = type(model).from_dict(text)
    omega = 2 * np.pi * np.array([100.0, 900.0, 2500.0])
    one, two = (power_flow(assemble(m.system).modal(), omega) for m in (model, mirrored))
    np.testing.assert_allclose(two.path_power, one.path_power, rtol=1e-6, atol=1e-12 * one.input_power.max())
    assert one.paths == two.paths


@pytest.mark.parametrize(
    ("names", "ball", "pitch", "preload"),
    [(("bearing_1", "bearing_2"), 9.525e-3, 46.0e-3, 800.0), (("bearing_3", "bearing_4"), 11.112e-3, 53.5e-3, 1200.0)],
)
def test_matrices_are_those_of_the_bearings_in_the_comment(model, names, ball, pitch, preload):
    """Typed in by hand from the closed forms of the axially loaded bearing, with two or three digits."""
    row = gp.BallBearing(13, ball, pitch, 0.52, 0.52, np.radians(40.0))
    for name, bearing, sense in zip(names, (row, row.mirrored()), (1.0, -1.0)):
        K = bearing.equilibrium({"uz": sense * preload}).stiffness
        typed = np.array(model.system.joints[name].stiffness)
        assert np.abs(K - typed).max() < 0.006 * np.abs(typed).max()
        assert np.abs(K[3:, 3:] - typed[3:, 3:]).max() < 0.006 * typed[3, 3]
        assert np.abs(K[:3, 3:] - typed[:3, 3:]).max() < 0.006 * np.abs(typed[:3, 3:]).max()
