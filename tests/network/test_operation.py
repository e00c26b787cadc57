"""The operating point: static equilibrium of the whole machine, judged without the method that found it."""

import warnings
from dataclasses import replace
from math import cos, pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import block_diag
from scipy.sparse import issparse

import gearpath as gp
from gearpath.components import DOFS
from gearpath.network.assemble import assemble
from gearpath.network.operation import at_operating_point, operating_point, schedule

SPUR, HELICAL = gp.load("models/gearbox.toml"), gp.load("models/helical_gearbox.toml")
BALL, ANGULAR, CYLINDER, TAPER = "6206-like", "7206B-like", "NU206-like", "30206-like"


def machine(base, bearings, torque, **more):
    """The model with these bearings (tables without ends) and operation."""
    data = base.to_dict()
    for k, bearing in enumerate(bearings, 1):
        between = data["joints"][f"bearing_{k}"]["between"]
        data["joints"][f"bearing_{k}"] = {"kind": "bearing", "between": between, "damping_time": 1e-6, **bearing}
    return type(base).from_dict({**data, "operation": {"torque": torque, **more}})


def apart(designation, **more):
    """Four of a kind that face outwards (O) on both shafts."""
    return [{"catalogue": designation, "mirrored": k % 2 == 1, **more} for k in range(4)]


def spur(torque=100.0, **more):
    return machine(SPUR, [{"catalogue": BALL}] * 4, torque, **more)


def quiet(model):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return operating_point(model.system)


def contradiction(model):
    """How far the found state is from one that balances every coordinate: of the load, over all coordinates.

    Given the bearings' loads there must be coordinates x with K x = f - B^T g and B x = q, K with all linear joints.
    """
    found, network = quiet(model), assemble(model.system)
    K = block_diag(
        *(s.stiffness.toarray() if issparse(s.stiffness) else s.stiffness for s in network.structures.values())
    )
    f = np.zeros(len(K))
    train = model.table.components["gear_train"]
    mesh = train.meshes["mesh"]
    force = model.table.operation.torque / (mesh.base_radii[0] * cos(mesh.helix_angle))
    structure = network.structures["gear_train"]
    sense = -1.0 if mesh.driving_torque == "-z" else 1.0
    if "rz" in model.dofs:  # torques that balance on the two gears
        for (shaft, disk), radius in zip((text.split(".") for text in mesh.between), mesh.base_radii):
            z = next(item.z for item in train.shafts[shaft].disks if item.name == disk)
            row = spin_row(model, shaft, z, structure.size)
            f[network.blocks["gear_train"]] += sense * force * radius * cos(mesh.helix_angle) * row
    else:  # the last coordinate of the train is the gears' relative spin
        f[network.blocks["gear_train"]][-1] = force
    rows, places = [], []
    for joint in network.joints:
        B = joint.source - joint.receiver
        if joint.name in found:
            f -= B.T @ found[joint.name].load[[DOFS.index(dof) for dof in joint.dofs]]
            bearing = [i for i, dof in enumerate(joint.dofs) if dof != "rz"]
            rows.append(B[bearing])
            places.append(found[joint.name].displacement[[DOFS.index(joint.dofs[i]) for i in bearing]])
        else:
            K = K + B.T @ joint.stiffness @ B
    unit = 1e8
    A = np.vstack([K / unit, *rows])
    b = np.concatenate([f / unit, *places])
    x = np.linalg.lstsq(A, b, rcond=1e-14)[0]
    return np.abs(A @ x - b).max() * unit / force


def spin_row(model, shaft, z, size):
    """Rotation about z of a shaft at a station: another system with a sensor there says which coordinate it is."""
    data = model.to_dict()
    data["sensors"] = {
        "turn": {"component": "gear_train", "point": f"{shaft}@{z}", "dof": "rz", "quantity": "velocity"}
    }
    network = assemble(type(model).from_dict(data).system)
    output = next(item for item in network.outputs if item.name == "sensors.turn")
    assert network.structures["gear_train"].size == size
    return output.row[network.blocks["gear_train"]]


@pytest.mark.parametrize(
    "model",
    [
        spur(),
        machine(SPUR, [{"catalogue": CYLINDER}] * 4, 250.0),
        machine(HELICAL, apart(TAPER), 100.0),
        machine(HELICAL, apart(ANGULAR, preload=500.0), 60.0),
        machine(HELICAL, [{"catalogue": BALL}] * 4, 40.0),
    ],
    ids=["ball", "cylinder", "taper", "angular", "helical ball"],
)
def test_every_coordinate_is_balanced(model):
    assert contradiction(model) < 1e-9


def on_a_plate():
    """The spur gearbox on a flexible plate in the plane of its shafts, free to roll: six degrees of freedom, sparse."""
    data = machine(SPUR, [{"catalogue": BALL}] * 4, 100.0).to_dict()
    del data["dofs"]
    seats = {"bearing_1": (-0.04975, -0.125), "bearing_2": (-0.04975, 0.125)}
    seats |= {"bearing_3": (0.05025, -0.125), "bearing_4": (0.05025, 0.125)}
    data["components"]["casing"] = {
        "kind": "plate",
        "material": "steel",
        "centre": [0.0, 0.0, 0.0],
        "lengths": [0.3, 0.4],
        "axis_1": [1.0, 0.0, 0.0],
        "axis_2": [0.0, 0.0, 1.0],
        "thickness": 0.02,
        "elements": 4,
        "footprints": {name: {"centre": [x, 0.0, z], "size": [0.05, 0.05]} for name, (x, z) in seats.items()},
    }
    for name in seats:
        data["joints"][name]["between"][1] = f"casing.{name}"
    for k in range(1, 5):
        soft = np.diag([1e6, 4e6, 1e6, 0.0, 0.0, 0.0])
        data["joints"][f"mount_{k}"] |= {"stiffness": soft.tolist(), "damping": (1e-5 * soft).tolist()}
    return type(SPUR).from_dict(data)


def test_a_flexible_casing_is_balanced():
    model = on_a_plate()
    assert contradiction(model) < 1e-8
    found, rigid = quiet(model), quiet(spur())
    # the plate bends, so that the rings tilt differently; the forces of a symmetric shaft stay
    assert found["bearing_1"].load[1] == pytest.approx(rigid["bearing_1"].load[1], rel=1e-2)
    assert found["bearing_1"].displacement[3] != pytest.approx(rigid["bearing_1"].displacement[3], rel=1e-4)


def test_symmetric_shaft_in_closed_form():
    """Slope at the ends under a force F in the middle: theta + M L / (2 E I) = F L^2 / (16 E I); reactions F / 2."""
    found = quiet(spur(torque=180.0))
    force, length, EI = 180.0 / 0.04975, 0.25, 2.07e11 * pi * 0.03**4 / 64.0
    for name, side in (("bearing_1", -1.0), ("bearing_2", -1.0), ("bearing_3", 1.0), ("bearing_4", 1.0)):
        assert found[name].load[1] == pytest.approx(side * 0.5 * force, rel=1e-9)
    tilt, moment = found["bearing_1"].displacement[3], found["bearing_1"].load[3]
    assert tilt + moment * length / (2.0 * EI) == pytest.approx(force * length**2 / (16.0 * EI), rel=1e-6)


def test_shafts_are_in_balance_in_space():
    """Forces and moments about the origin, tooth force by hand from the angles of the gears, both shafts."""
    model = machine(HELICAL, apart(TAPER), 100.0)
    found = quiet(model)
    train = HELICAL.table.components["gear_train"]
    r1, r2 = 0.0311684, 0.0623368
    alpha, beta = 0.362392, 0.266248
    n = np.array([cos(beta) * np.sin(alpha), cos(beta) * np.cos(alpha), -np.sin(beta)])
    pitch = np.array([-0.05 + 0.1 * r1 / (r1 + r2), 0.0, 0.0])
    tooth = 100.0 / (r1 * cos(beta))
    for shaft, sign, names in (
        ("input", -1.0, ("bearing_1", "bearing_2")),
        ("output", 1.0, ("bearing_3", "bearing_4")),
    ):
        force, moment = sign * tooth * n, np.cross(pitch, sign * tooth * n)
        for name in names:
            x, y, z = train.shafts[shaft].origin
            place = np.array([x, y, z + float(model.table.joints[name].between[0].split("@")[1])])
            load = -found[name].load  # what the bearing does to the shaft
            force = force + load[:3]
            moment = moment + load[3:] + np.cross(place, load[:3])
        axis = np.array(train.shafts[shaft].origin)
        about_axis = moment - np.cross(axis, force)
        assert np.abs(force).max() < 1e-8 * tooth
        assert np.abs(about_axis[:2]).max() < 1e-8 * tooth * r1
        # the file's angle and radii are rounded to six digits
        assert about_axis[2] == pytest.approx(-100.0 if shaft == "input" else -100.0 * r2 / r1, rel=1e-5)


def test_small_changes_follow_the_stiffness():
    """dg/dF of the equilibrium is the static limit of the synthesised transfer from the mesh force."""
    f0 = np.array([0.5])
    model = spur(torque=100.0)
    H = gp.frequency_response(model, f0, ["bearing_1.force_uy", "bearing_1.force_rx"], ["mesh.force"]).values[0, :, 0]
    step = 1e-3
    high, low = (quiet(spur(torque=100.0 + sign * step))["bearing_1"].load[[1, 3]] for sign in (1.0, -1.0))
    assert np.abs(H.real - (high - low) / (2.0 * step / 0.04975)).max() < 1e-4 * np.abs(H).max()


@settings(max_examples=15, deadline=None)
@given(
    designation=st.sampled_from([BALL, ANGULAR, TAPER]),
    torque=st.floats(1.0, 300.0),
    preload=st.floats(50.0, 2000.0),
    helix=st.floats(-0.3, 0.3),
    driving=st.sampled_from(["+z", "-z"]),
)
def test_random_machines_are_balanced(designation, torque, preload, helix, driving):
    model = machine(HELICAL, apart(designation, preload=preload), torque)
    mesh = "components.gear_train.meshes.mesh"
    model = model.replace({f"{mesh}.helix_angle": helix, f"{mesh}.driving_torque": driving})
    assert contradiction(model) < 1e-8
    for name, state in quiet(model).items():
        K = np.array(model.system.joints[name].stiffness)
        assert np.allclose(K, state.stiffness, rtol=1e-12, atol=1e-6)
        unit = np.sqrt(np.diag(K).clip(1e-3))
        assert np.linalg.eigvalsh(K / np.outer(unit, unit)).min() > -1e-12


def test_rotation_about_the_axis_does_not_matter():
    """Shafts that twist (rz active) and gears that spin freely load the bearings alike."""
    whole = machine(HELICAL, apart(TAPER), 100.0)
    data = whole.to_dict()
    data["dofs"] = ["ux", "uy", "uz", "rx", "ry"]
    for joint in data["joints"].values():
        for key in ("stiffness", "damping"):
            if isinstance(joint.get(key), list):
                joint[key] = [row[:5] for row in joint[key][:5]]
    fewer = quiet(type(whole).from_dict(data))
    for name, state in quiet(whole).items():
        assert np.abs(state.load - fewer[name].load).max() < 1e-6 * np.abs(state.load).max()


def test_a_machine_that_floats_is_held():
    """Without mounts the casing takes the load by its inertia; the bearings feel the same tooth force."""
    model = spur()
    data = model.to_dict()
    for k in range(1, 5):
        del data["joints"][f"mount_{k}"]
    floating = type(model).from_dict(data)
    assert quiet(floating)["bearing_1"].load[1] == pytest.approx(quiet(model)["bearing_1"].load[1], rel=1e-9)


def test_preload_alone_holds_a_machine_at_rest():
    model = machine(HELICAL, apart(ANGULAR, preload=800.0), 0.0)
    found = quiet(model)
    for name, state in found.items():
        assert state.loaded == 13
        assert abs(state.load[2]) == pytest.approx(
            abs(found["bearing_1" if name in ("bearing_1", "bearing_2") else "bearing_3"].load[2]), rel=1e-6
        )
    alone = gp.catalogue_bearing(ANGULAR)
    K = alone.equilibrium({"uz": 800.0}).stiffness
    # shaft and casing yield, so that the pair carries somewhat less than both would against rigid walls
    assert 0.8 * K[1, 1] < found["bearing_1"].stiffness[1, 1] < K[1, 1]


def test_damping_follows_the_stiffness():
    system = spur().system
    K, C = (np.array(getattr(system.joints["bearing_1"], name)) for name in ("stiffness", "damping"))
    assert np.array_equal(C, 1e-6 * K) or np.allclose(C, 1e-6 * K, rtol=1e-15)


def test_stiffness_grows_with_torque():
    """Hertzian contact of a purely radial load: K ~ F^(1/3) nearly, loads shared alike."""
    K = [np.array(spur(torque=torque).system.joints["bearing_1"].stiffness)[0, 0] for torque in (20.0, 160.0)]
    assert 1.9 < K[1] / K[0] < 2.1


def test_torque_sweep_is_one_power_flow_a_torque():
    model, f = spur(), np.linspace(50.0, 4000.0, 40)
    sweep = gp.torque_sweep(model, [10.0, 80.0], f)
    for torque in (10.0, 80.0):
        flow = gp.power_flow(model.replace({"operation.torque": torque}), f)
        for name in ("alpha", "alpha_moment", "path_alpha"):
            assert np.array_equal(sweep[name].sel(torque=torque).transpose(*flow[name].dims), flow[name])
    assert sweep.alpha.dims == ("torque", "frequency")
    assert sweep["stiffness.bearing_1"].shape == (2, 2, 2)


def test_schedule_holds_the_operating_points():
    system = spur().system
    found = schedule(system, [10.0, 80.0])
    assert list(found.torques) == [10.0, 80.0]
    for i, torque in enumerate(found.torques):
        there = at_operating_point(replace(system, operation=replace(system.operation, torque=float(torque))))
        for name in ("bearing_1", "bearing_4"):
            assert np.array_equal(found.stiffness[name][i], there.joints[name].stiffness)
            assert np.array_equal(found.damping[name][i], there.joints[name].damping)


def test_mean_load_of_a_chain():
    """Two stages: the torque grows by the ratio of the base radii, both teeth of the middle shaft balance."""
    from gearpath.components import Mesh
    from gearpath.components.mean_load import mean_load

    meshes = {
        "first": Mesh((("a", "p"), ("b", "w")), 1e8, (0.02, 0.06)),
        "second": Mesh((("c", "w"), ("b", "p")), 1e8, (0.08, 0.025), helix_angle=0.2),
    }
    load = mean_load(meshes, 50.0)
    assert load.force["first"] == pytest.approx(50.0 / 0.02)
    assert load.force["second"] * 0.025 * cos(0.2) == pytest.approx(50.0 * 3.0)
    assert load.speed == pytest.approx({"a": 1.0, "b": 1.0 / 3.0, "c": 0.025 / 0.08 / 3.0})
    backwards = mean_load(meshes, 50.0, "c")
    assert backwards.force["second"] == pytest.approx(50.0 / (0.08 * cos(0.2)))
    with pytest.raises(gp.InputError, match="several meshes at once: first, second"):
        mean_load(meshes, 50.0, "b")


def test_two_stages_in_planar_balance():
    """Three shafts: each mesh carries its tooth force, and the middle shaft their difference, by hand."""
    data = spur().to_dict()
    train = data["components"]["gear_train"]
    train["shafts"]["middle"] = train["shafts"].pop("output")
    middle = train["shafts"]["middle"]
    train["meshes"]["mesh"]["between"] = ["input.pinion", "middle.wheel"]
    train["shafts"]["last"] = {**middle, "origin": [0.15025, 0.0, -0.125], "elements": 8}
    train["shafts"]["last"]["disks"] = [{**middle["disks"][0], "name": "wheel", "z": 0.06}]
    middle["disks"] = [*middle["disks"], {**middle["disks"][0], "name": "pinion", "z": 0.06}]
    middle["elements"] = 8
    train["meshes"]["second"] = {
        "between": ["middle.pinion", "last.wheel"],
        "stiffness": 1.5e8,
        "base_radii": [0.03, 0.07],
    }
    for k, shaft in ((3, "middle"), (4, "middle"), (5, "last"), (6, "last")):
        end = 0.25 if k % 2 == 0 else 0.0
        data["joints"][f"bearing_{k}"] = {
            **data["joints"]["bearing_1"],
            "between": [f"gear_train.{shaft}@{end}", "casing"],
        }
    found = quiet(type(SPUR).from_dict(data))
    first = 100.0 / 0.04975
    second = first * 0.05025 / 0.03
    y = {name: state.load[1] for name, state in found.items()}
    assert y["bearing_1"] + y["bearing_2"] == pytest.approx(-first, rel=1e-9)
    assert y["bearing_3"] + y["bearing_4"] == pytest.approx(first - second, rel=1e-9)
    assert y["bearing_5"] + y["bearing_6"] == pytest.approx(second, rel=1e-9)
    # moments about the first end; a force uy at z turns by -z uy about x
    turned = found["bearing_5"].load[3] + found["bearing_6"].load[3] - 0.25 * y["bearing_6"]
    assert turned == pytest.approx(-0.06 * second, rel=1e-9)


def test_centrifugal_warning_takes_the_shaft_of_the_bearing():
    slow, fast = spur(torque=5.0, speed=100.0), spur(torque=5.0, speed=9000.0)
    assert not any("centrifugal" in note for state in quiet(slow).values() for note in state.notes)
    with pytest.warns(UserWarning, match=r"bearing_\d: .*entrifugal"):
        at_operating_point(fast.system)


def test_loads_that_nothing_carries_are_refused():
    model = machine(HELICAL, [{"catalogue": CYLINDER}] * 4, 100.0)
    with pytest.raises(
        gp.ModelError, match=r"operation.torque: the bearings cannot carry 100 N m: bearing_\d comes apart along uz"
    ):
        _ = model.system
    with pytest.raises(gp.InputError, match="not at least two torques"):
        schedule(spur().system, [50.0])
    with pytest.raises(gp.InputError, match="no table operation"):
        gp.torque_sweep(SPUR, [10.0])
    with pytest.raises(gp.InputError, match="at least 0 N m"):
        gp.torque_sweep(spur(), [-10.0])
