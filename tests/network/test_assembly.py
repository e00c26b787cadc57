"""Ports, loads, actuators and sensors of the assembled network; inputs that do not exist."""

from dataclasses import replace

import numpy as np
import pytest
from systems import BEARING, PLANAR, STEEL, default_gearbox, scaled

from gearpath.components import DOFS, GearTrain, Section, Shaft
from gearpath.joints import Joint, Port
from gearpath.network.assemble import assemble
from gearpath.network.power import power_flow
from gearpath.network.response import frequency_response
from gearpath.network.synthesis import Synthesis
from gearpath.network.system import Actuator, PointExcitation, Sensor

OMEGA = 2 * np.pi * np.array([50.0, 700.0, 2500.0])


def response(modal, output, load):
    outputs = [o for o in modal.outputs if o.name == output]
    loads = [item for item in modal.loads if item.name == load]
    return frequency_response(modal, OMEGA, outputs, loads)[:, 0, 0]


@pytest.fixture(scope="module")
def equipped():
    system = replace(
        default_gearbox(),
        actuators={"shaker": Actuator(Port("casing"), "uy", (0.05, 0.0, 0.1)), "twist": Actuator(Port("casing"), "rx")},
        sensors={
            "foot": Sensor(Port("casing"), "uy", "acceleration", (0.05, 0.0, 0.1)),
            "shaft": Sensor(Port("gear_train", "input", 0.07), "uy", "displacement"),
            "tilt": Sensor(Port("casing"), "rx", "velocity"),
            "gear": Sensor(Port("gear_train", "output", disk="wheel"), "uy"),
        },
    )
    return assemble(system).modal()


def test_actuator_and_sensor_at_one_place_are_a_driving_point(equipped):
    """Acceleration per force at the same point and degree of freedom: the real part of the mobility is not negative."""
    mobility = response(equipped, "sensors.foot", "actuators.shaker") / (1j * OMEGA)
    assert np.all(mobility.real > 0.0)


def test_reciprocity_between_shaft_and_casing(equipped):
    """Force on the casing, motion on the shaft; and the mesh force against the mesh velocity."""
    there = response(equipped, "mesh.velocity", "actuators.shaker")
    back = response(equipped, "sensors.foot", "mesh.force") / (1j * OMEGA)
    np.testing.assert_allclose(there, back, rtol=1e-10)


def test_displacement_velocity_and_acceleration_differ_by_i_omega(equipped):
    velocity = response(equipped, "casing.velocity_uy", "mesh.force")
    acceleration = response(equipped, "casing.acceleration_uy", "mesh.force")
    np.testing.assert_allclose(acceleration, 1j * OMEGA * velocity, rtol=1e-13)


def test_a_transmission_error_acts_like_its_inertial_force(equipped):
    error = response(equipped, "bearing_1.force_uy", "mesh.transmission_error")
    force = response(equipped, "bearing_1.force_uy", "mesh.force")
    np.testing.assert_allclose(error, 0.3853032060440 * OMEGA**2 * force, rtol=1e-10)


def test_a_moment_on_the_casing_has_its_own_units(equipped):
    assert {load.name: load.unit for load in equipped.loads}["actuators.twist"] == "N.m"
    assert {o.name: o.unit for o in equipped.outputs}["sensors.tilt"] == "rad/s"


def test_point_excitation_puts_its_power_in():
    system = replace(
        default_gearbox(), excitation=PointExcitation(Port("gear_train", "input", disk="pinion"), "uy", 2.0)
    )
    flow = power_flow(assemble(system).modal(), OMEGA, 2.0)
    np.testing.assert_allclose(flow.dissipated_power.sum(axis=0), flow.input_power, rtol=1e-9)
    assert np.all((flow.share() > 0.0) & (flow.share() < 1.0))


def test_planar_machine_is_the_planar_part_of_the_full_one():
    """With all six degrees of freedom and decoupled geometry the planar response comes back (spins aside).

    The polar inertia of the shafts themselves then turns too, so it is left out by comparing the response to a force.
    """
    planar = default_gearbox()

    def widened(joint):
        K, C = np.zeros((6, 6)), np.zeros((6, 6))
        rows = [DOFS.index(dof) for dof in joint.dofs]
        K[np.ix_(rows, rows)], C[np.ix_(rows, rows)] = joint.stiffness, joint.damping
        for free in {0, 2, 4, 5} if joint.kind == "mount" else {0, 2, 4}:
            K[free, free], C[free, free] = (1e7, 440.0) if free < 3 else (1e5, 4.0)
        return Joint(joint.kind, joint.between, DOFS, scaled(K, 1), scaled(C, 1), joint.at)

    dofs = ("ux", "uy", "uz", "rx", "ry")  # spins stay free, as in the planar model
    full = replace(planar, dofs=dofs, joints={n: restricted(widened(j), dofs) for n, j in planar.joints.items()})
    small, large = (assemble(s).modal() for s in (planar, full))
    for output in ("bearing_1.force_uy", "bearing_3.force_rx"):
        expected = response(small, output, "mesh.force")
        np.testing.assert_allclose(response(large, output, "mesh.force"), expected, rtol=1e-7)


def restricted(joint, dofs):
    rows = [DOFS.index(dof) for dof in dofs]
    pick = np.ix_(rows, rows)
    K, C = (np.array(m)[pick] for m in (joint.stiffness, joint.damping))
    return replace(joint, dofs=dofs, stiffness=scaled(K, 1), damping=scaled(C, 1))


def test_a_released_joint_carries_nothing(modal):
    """A bearing without stiffness and damping is as good as none: its force is exactly zero, the others still work."""
    free = modal.with_joint("bearing_1", np.zeros((2, 2)), np.zeros((2, 2)))
    solved = Synthesis(free, [free.loads[0]]).solve(OMEGA)
    assert np.all(solved.force[:2] == 0.0)
    assert np.all(abs(solved.force[2:4]).max(axis=0) > 0.0)
    assert modal.joints[0].dofs == PLANAR


def with_quill():
    """Bearings 1 and 2 carry the input shaft in a hollow quill, which has its own bearings in the casing."""
    system = default_gearbox()
    quill = Shaft(STEEL, (-0.04975, 0.0, -0.15), (Section(0.3, 0.06, 0.04),), None, (4,))
    joints, casing = dict(system.joints), Port("casing")
    damping = scaled(BEARING, 1e-6)
    for name, z in (("bearing_1", 0.025), ("bearing_2", 0.275)):
        shaft, _ = joints[name].between
        joints[name] = replace(joints[name], between=(shaft, Port("quill", "tube", z)))
    for k, z in ((5, 0.0), (6, 0.3)):
        joints[f"bearing_{k}"] = Joint("bearing", (Port("quill", "tube", z), casing), PLANAR, BEARING, damping)
    components = {**system.components, "quill": GearTrain({"tube": quill}, {}, 0.015)}
    return replace(system, components=components, joints=joints)


def test_power_through_bearings_in_series_is_counted_once():
    """What leaves the paths is lost in the components and bearings before them; the rest is lost in the casing."""
    network = assemble(with_quill())
    assert network.paths == ("bearing_3", "bearing_4", "bearing_5", "bearing_6")
    flow = power_flow(network.modal(), 2 * np.pi * np.geomspace(20.0, 5000.0, 300))
    assert np.all((flow.share() > 0.0) & (flow.share() < 1.0))
    mounts = [k for k, name in enumerate(flow.elements) if name.startswith("mount")]
    np.testing.assert_allclose(flow.transmitted_power, flow.dissipated_power[mounts].sum(axis=0), rtol=1e-6)


def test_a_casing_on_bearings_to_the_ground_keeps_its_paths():
    system = default_gearbox()
    joints = {name: replace(joint, kind="bearing") for name, joint in system.joints.items()}
    assert assemble(replace(system, joints=joints)).paths[:4] == ("bearing_1", "bearing_2", "bearing_3", "bearing_4")
