"""Beam joints (Eq. 18 to 21): the 12 x 12 beam stiffness rebuilt, closed forms, and power flow through one."""

from dataclasses import replace

import numpy as np
import pytest
from systems import PLANAR, default_gear_train, default_gearbox

from gearpath.components import Material, RigidBody, Section
from gearpath.components.beam import beam_element
from gearpath.components.dofs import DOFS, rigid_motion
from gearpath.errors import InputError
from gearpath.joints import Joint, Port, beam_joint
from gearpath.joints.beam_joint import beam_compliance
from gearpath.network.assemble import assemble
from gearpath.network.natural import natural_frequencies
from gearpath.network.power import power_flow
from gearpath.network.reference import reference_solution
from gearpath.network.system import PointExcitation, System

STEEL = Material(2.07e11, 0.3, 7850.0)
ENDS = (Port("source"), Port("receiver"))
ZERO = (0.0, 0.0, 0.0)
CASING = RigidBody(12.0, {"xx": 0.15, "yy": 0.2, "zz": 0.17})


def test_compliance_and_transport_rebuild_the_beam_stiffness():
    section, l = Section(0.0127, 0.009525), 0.0127  # noqa: E741
    H = beam_compliance(l, section.area, section.area_moment, 2.07e11, 0.3, 0.886)
    B = np.hstack([rigid_motion(np.array([0.0, 0.0, l])), -np.eye(6)])
    K, _ = beam_element("timoshenko", section, STEEL, l, 0.886)
    np.testing.assert_allclose(B.T @ np.linalg.inv(H) @ B, K, atol=1e-12 * abs(K).max())


@pytest.mark.parametrize("direction", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0, 1, 0), (0.6, -0.48, 0.64)])
def test_a_clamped_beam_of_any_direction(direction):
    """Tip deflection F l^3 / 3 E I + F l / kappa G A across, F l / E A along, M l / G J about the axis."""
    l, axis = 0.08, np.array(direction, float)  # noqa: E741
    joint = beam_joint(ENDS, tuple((l * axis).tolist()), DOFS, 0.02, 2.07e11, 0.3, 0.01)
    area, moment = np.pi / 4 * (0.02**2 - 0.01**2), np.pi / 64 * (0.02**4 - 0.01**4)
    G, flexibility = 2.07e11 / 2.6, np.linalg.inv(np.array(joint.stiffness))
    across = np.cross(axis, [0.3, 0.5, 0.7])
    across /= np.linalg.norm(across)
    bending = l**3 / (3 * 2.07e11 * moment) + l / (0.886 * G * area)
    np.testing.assert_allclose(flexibility[:3, :3] @ across, bending * across, rtol=1e-9, atol=1e-9 * bending)
    np.testing.assert_allclose(flexibility[:3, :3] @ axis, l / (2.07e11 * area) * axis, atol=1e-9 * bending)
    twist = l / (G * 2 * moment)
    np.testing.assert_allclose(flexibility[3:, 3:] @ axis, twist * axis, rtol=1e-9, atol=1e-9 * twist)
    slope = flexibility[3:, :3] @ across  # a force F across turns the tip by F l^2 / 2 E I about axis x F
    np.testing.assert_allclose(
        slope, l**2 / (2 * 2.07e11 * moment) * np.cross(axis, across), atol=1e-9 * abs(slope).max()
    )


def dumbbell(loss_factor=0.0):
    """Two rigid bodies on a short beam, free in space; pushed off-centre."""
    inertia = {"xx": 0.02, "yy": 0.03, "zz": 0.01}
    joint = beam_joint(ENDS, (0.0, 0.0, 0.1), DOFS, 0.012, 2.07e11, 0.3, loss_factor=loss_factor, at=(0.0, 0.0, 0.15))
    soft = Joint("mount", (Port("receiver"), Port("ground")), ("uy",), ((1e3,),), ((1.0,),), ZERO, True)
    return System(
        "dumbbell",
        DOFS,
        {"source": RigidBody(2.0, inertia, (0.0, 0.0, 0.0)), "receiver": RigidBody(3.0, inertia, (0.0, 0.0, 0.2))},
        {"neck": joint, "soft": soft},
        PointExcitation(Port("source"), "uy", 1.0, (0.01, 0.0, 0.02)),
    )


def test_natural_frequencies_of_two_bodies_on_a_beam():
    """Axial and torsional modes in closed form: sqrt(k (1/m1 + 1/m2))."""
    f = natural_frequencies(assemble(dumbbell()).modal())
    area, polar = np.pi / 4 * 0.012**2, np.pi / 32 * 0.012**4
    axial = np.sqrt(2.07e11 * area / 0.1 * (1 / 2 + 1 / 3)) / 2 / np.pi
    twist = np.sqrt(2.07e11 / 2.6 * polar / 0.1 * 2 / 0.01) / 2 / np.pi
    for wanted in (axial, twist):
        assert abs(f / wanted - 1).min() < 1e-9


def test_power_through_a_beam_joint():
    network = assemble(dumbbell(0.02))
    omega = 2 * np.pi * np.geomspace(30.0, 3000.0, 9)
    flow, reference = power_flow(network.modal(), omega), reference_solution(network, omega)
    assert flow.paths == tuple(f"neck.{dof}" for dof in DOFS)
    np.testing.assert_allclose(flow.dissipated_power.sum(axis=0), flow.input_power, rtol=1e-8)
    np.testing.assert_allclose(flow.share(), reference.alpha, rtol=1e-7)
    lost = flow.dissipated_power[flow.elements.index("neck")]
    assert np.all(lost > 0.0)
    np.testing.assert_allclose(flow.transmitted_power, flow.input_power - lost, rtol=1e-7)


def test_a_joint_at_a_disk_holds_the_shaft_not_the_spinning_disk():
    """Planar: the disk at the station spins freely, and a beam joint reaching sideways must not follow it."""
    alpha = []
    for z in (0.125, 0.12499):
        ends = (Port("gear_train", "input", z), Port("casing"))
        neck = beam_joint(ends, (0.05, 0.0, 0.0), PLANAR, 0.004, 2.07e11, 0.3)
        base = default_gearbox(components={"gear_train": default_gear_train((8,)), "casing": CASING})
        system = replace(base, joints={**base.joints, "neck": neck})
        alpha.append(power_flow(assemble(system).modal(), np.array([2 * np.pi * 700.0])).share()[0])
    assert alpha[0] == pytest.approx(alpha[1], rel=1e-3)


def test_ports_that_coincide_are_refused():
    with pytest.raises(InputError, match="two ports apart"):
        beam_joint(ENDS, ZERO, DOFS, 0.01, 2.07e11, 0.3)
