"""Whole machines with rigid joints: the reference solution, the time twin, power balance, paths, transmission error."""

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rigid_machines import gearbox_on_beam, on, rigid, spatial_gearbox, spring, with_more_bodies
from systems import PLANAR, random_gearbox
from test_operation import apart, machine
from test_random_machines import check_balance_and_passivity, check_reciprocity, check_synthesis_against_reference

import gearpath as gp
from gearpath.components import RigidBody
from gearpath.joints import Port
from gearpath.network.assemble import assemble
from gearpath.network.operation import operating_point
from gearpath.network.power import power_flow
from gearpath.network.reference import reference_solution
from gearpath.network.response import frequency_response
from gearpath.network.synthesis import Synthesis
from gearpath.network.time_twin import time_twin

LINES = 2 * np.pi * np.geomspace(20.0, 5000.0, 30)
BOTH_HELD = {
    "bearing_1": rigid(Port("gear_train", "input", 0.0), Port("ground")),
    "bearing_3": rigid(Port("gear_train", "output", 0.0), Port("casing")),
}


def check_twins(system):
    modal = assemble(system).modal()
    twin, omega = time_twin(modal), LINES[::5]
    identity = np.eye(len(twin.A))
    time = np.array([twin.C @ np.linalg.solve(1j * w * identity - twin.A, twin.B) + twin.D for w in omega])
    frequency = frequency_response(modal, omega, twin.outputs, twin.loads)
    deviation, largest = abs(time - frequency).max(axis=0), abs(frequency).max(axis=0)
    for unit in {output.unit for output in twin.outputs}:  # some outputs are rounding beside others of their unit
        rows = [output.unit == unit for output in twin.outputs]
        assert np.all(deviation[rows] <= 1e-8 * largest[rows] + 1e-12 * largest[rows].max(axis=0))


def test_gearbox_bolted_to_a_beam():
    system = gearbox_on_beam()
    assert list(assemble(system).modal().components) == ["gear_train", "casing+base"]
    check_synthesis_against_reference(system)
    check_balance_and_passivity(system)
    check_twins(system)


def test_only_the_beam_dissipates_beside_the_source():
    """The bolts lose nothing, and the power through the bearings is lost in the joined body."""
    modal = assemble(gearbox_on_beam(damped=False)).modal()
    flow = power_flow(modal, LINES)
    lost = dict(zip(flow.elements, flow.dissipated_power))
    assert set(lost) == {"gear_train", "casing+base", *(j.name for j in modal.joints)}
    gross = abs(flow.path_power).sum(axis=0)
    assert np.all(abs(lost["casing+base"] - flow.transmitted_power) < 1e-9 * gross)


@pytest.mark.parametrize("held", [{"bearing_3": BOTH_HELD["bearing_3"]}, BOTH_HELD], ids=["one", "both"])
def test_shafts_held_against_the_spin_of_the_transmission_error(held):
    system = spatial_gearbox(**held)
    check_synthesis_against_reference(system)
    check_balance_and_passivity(system)
    check_reciprocity(system)
    check_twins(system)


def test_the_held_spin_pushes_with_the_force_of_the_mesh_spring():
    """Without damping in the components a transmission error e is the force pair k b e = K d e at the teeth."""
    system = spatial_gearbox(**BOTH_HELD)
    train = replace(system.components["gear_train"], modal_damping=0.0)
    system = replace(system, components={**system.components, "gear_train": train})
    network = assemble(system)
    error = network.loads[0]
    block = network.blocks["gear_train"]
    push = np.zeros(len(error.column))
    push[block] = network.structures["gear_train"].stiffness @ error.mesh_displacement[block]
    pair = replace(error, name="pair", column=push, mesh_displacement=None)
    modal = replace(network, loads=(error, pair)).modal()
    solved = Synthesis(modal, modal.loads).solve(LINES)
    for found in (solved.force, solved.velocity):
        scale = abs(found[:, 1]).max(axis=0)
        assert np.all(abs(found[:, 0] - found[:, 1]).max(axis=0) < 1e-8 * scale)


def test_where_nothing_resists_the_spin_the_excitation_stays_the_inertial_one():
    network = assemble(spatial_gearbox(weld=rigid(Port("gear_train", "output", 0.0), Port("casing"), None, PLANAR)))
    error, force = network.modal().loads[:2]
    np.testing.assert_array_equal(error.column, error.mesh_displacement)
    np.testing.assert_allclose(error.column / error.equivalent_mass, force.column, rtol=1e-12, atol=1e-12)


def test_a_bearing_within_one_body_is_no_path():
    """The power passes by it through the weld, which has no force: what it carries says nothing."""
    with pytest.warns(UserWarning, match="move as one"):
        network = assemble(spatial_gearbox(bearing_3=BOTH_HELD["bearing_3"]))
    assert network.paths == ()
    assert "bearing_1.force_uy" in [output.name for output in network.modal().outputs]


def in_series(**more):
    """Bearings carry the casing on a quill, which is welded to a second body on mounts."""
    gearbox = gearbox_on_beam()
    joints = {name: joint for name, joint in gearbox.joints.items() if joint.kind == "bearing"}
    joints["weld"] = rigid(Port("casing"), on("base", 0.1))
    joints["last"] = spring(on("base", 0.4), Port("frame"), [1e8, 1e5], PLANAR, time=1e-6, kind="bearing")
    joints["foot"] = spring(Port("frame"), Port("ground"), [1e7, 1e6], PLANAR, time=1e-5)
    frame = RigidBody(30.0, {"xx": 1.0, "yy": 1.0, "zz": 1.0})
    return replace(gearbox, components={**gearbox.components, "frame": frame}, joints=joints, **more)


def test_power_counts_where_it_leaves_the_joined_body():
    network = assemble(in_series())
    assert network.paths == ("last",)
    check_synthesis_against_reference(in_series())


@settings(max_examples=40, deadline=None)
@given(
    st.builds(
        with_more_bodies,
        st.builds(random_gearbox, st.integers(0, 2**32 - 1), st.integers(1, 4)),
        st.integers(0, 2**32 - 1),
    )
)
def test_random_assemblies(system):
    check_balance_and_passivity(system)
    check_reciprocity(system)
    network = assemble(system)
    modal = network.modal()
    load = next(item for item in modal.loads if item.name == modal.excitation)
    force = Synthesis(modal, [load]).solve(LINES[::6]).force[:, 0]
    reference = reference_solution(network, LINES[::6])
    for turns in (True, False):
        rows = np.array([(dof[0] == "r") is turns for joint in network.joints for dof in joint.dofs])
        if rows.any():
            largest = abs(reference.force[rows]).max(axis=0)
            assert np.all(abs(force - reference.force)[rows].max(axis=0) <= 1e-6 * largest + 1e-300)


def test_the_operating_point_is_that_of_very_stiff_joints():
    """Helical gearbox on ball bearings, the casing split in two bodies."""
    model = machine(gp.load("models/helical_gearbox.toml"), apart("7206B-like"), 100.0)
    half = replace(model.system.components["casing"], centre_of_gravity=(0.02, -0.05, 0.1))
    parts = {**model.system.components, "foot": half}
    found = []
    for weld in (rigid(Port("casing"), Port("foot"), (0.0, 0.0, 0.0)), None):
        stiff = spring(Port("casing"), Port("foot"), [1e13] * 3 + [1e12] * 3, at=(0.0, 0.0, 0.0))
        joints = {
            name: replace(joint, between=(Port("foot"), Port("ground"))) if joint.kind == "mount" else joint
            for name, joint in model.system.joints.items()
        }
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            joined = replace(model.system, components=parts, joints={**joints, "w": weld or stiff})
            found.append(operating_point(joined))
    for name, state in found[0].items():
        np.testing.assert_allclose(state.load, found[1][name].load, rtol=1e-5, atol=1e-5 * abs(state.load).max())


def test_the_operating_point_holds_a_shaft_that_is_welded_to_the_casing():
    """The output shaft stands: its bearings' seats are part of the casing, and the input shaft's bearings carry all."""
    model = machine(gp.load("models/helical_gearbox.toml"), apart("7206B-like"), 100.0)
    joints = dict(model.system.joints)
    output = [name for name, joint in joints.items() if joint.kind == "bearing" and joint.between[0].shaft == "output"]
    for name in output:
        joints[name] = rigid(*joints[name].between)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = operating_point(replace(model.system, joints=joints))
        free = operating_point(model.system)
    assert set(found) == {name for name in free if name not in output}
    total, usual = (sum(states[name].load[:3] for name in found) for states in (found, free))
    np.testing.assert_allclose(total, usual, rtol=1e-6, atol=1e-6 * abs(usual).max())


def test_state_space_names_the_joined_body():
    control = pytest.importorskip("control")
    model = gp.load("models/gearbox.toml")
    data = model.to_dict()
    data["components"]["frame"] = {**data["components"]["casing"], "mass": 3.0}
    data["joints"]["weld"] = {"kind": "rigid", "between": ["casing", "frame"], "at": [0.0, -0.1, 0.0]}
    plant = gp.state_space(type(model).from_dict(data))
    assert isinstance(plant, control.StateSpace)
    assert "casing+frame/mode_1/x" in plant.state_labels


def test_bearings_inside_a_joined_body_are_no_paths_and_a_warning_says_so():
    data = gp.load(Path(__file__).parents[2] / "models" / "gearbox.toml").to_dict()
    data["joints"]["bearing_1"] = {"kind": "rigid", "between": data["joints"]["bearing_1"]["between"]}
    with pytest.warns(UserWarning, match=r"^joints\.bearing_1: gear_train and casing move .* bearing_2, bearing_3"):
        flow = gp.power_flow(gp.Model.from_dict(data), [100.0])
    assert flow.sizes["path"] == 0
    data["components"]["frame"] = {**data["components"]["casing"], "mass": 3.0}
    weld = {"kind": "rigid", "between": ["casing", "frame"], "at": [0.0, -0.1, 0.0]}
    data["joints"] = {"weld": weld, **data["joints"]}  # not the one that makes the difference, but the first
    with pytest.warns(UserWarning, match=r"^joints\.weld, joints\.bearing_1: gear_train and casing and frame move"):
        assemble(gp.Model.from_dict(data).system)
