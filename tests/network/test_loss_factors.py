"""Loss factors: (1 + i eta) K of components and joints in the frequency twin, viscous equivalents in the time twin."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from systems import default_gearbox, random_gearbox

from gearpath.components import RigidBody
from gearpath.joints import Joint, Port
from gearpath.network.assemble import assemble
from gearpath.network.power import power_flow
from gearpath.network.reference import reference_solution
from gearpath.network.response import frequency_response
from gearpath.network.synthesis import Synthesis
from gearpath.network.system import PointExcitation, System
from gearpath.network.time_twin import time_twin

LINES = 2 * np.pi * np.geomspace(20.0, 5000.0, 7)


def lossy(system, joint_loss, component_loss):
    """The network of a machine with the given loss factors instead of dashpots and modal damping."""
    joints = {
        name: replace(
            joint, loss_factor=joint_loss, damping=tuple(tuple(0.0 * x for x in row) for row in joint.damping)
        )
        for name, joint in system.joints.items()
    }
    network = assemble(replace(system, joints=joints))
    structures = {
        name: replace(item, modal_damping=0.0, loss_factor=component_loss) for name, item in network.structures.items()
    }
    return replace(network, structures=structures)


def test_a_mass_on_a_hysteretic_spring():
    """Receptance 1 / ((1 + i eta) k - w^2 m), in closed form."""
    mount = Joint("mount", (Port("block"), Port("ground")), ("uy",), ((2.0e6,),), ((0.0,),), (0.0, 0.0, 0.0), True, 0.2)
    system = System(
        "oscillator",
        ("uy",),
        {"block": RigidBody(3.0, {"xx": 1.0, "yy": 1.0, "zz": 1.0})},
        {"spring": mount},
        PointExcitation(Port("block"), "uy"),
    )
    network = assemble(system).modal()
    velocity = next(output for output in network.outputs if output.name == "block.velocity_uy")
    found = frequency_response(network, LINES, [velocity], network.loads)[:, 0, 0]
    np.testing.assert_allclose(found, 1j * LINES / (2.0e6 * (1 + 0.2j) - LINES**2 * 3.0), rtol=1e-12)


@settings(max_examples=50, deadline=None)
@given(
    st.builds(random_gearbox, st.integers(0, 2**20), st.integers(1, 8)),
    st.sampled_from([0.0, 0.02, 0.3]),
    st.sampled_from([0.005, 0.05]),
)
def test_synthesis_balance_and_passivity_with_loss_factors(system, joint_loss, component_loss):
    network = lossy(system, joint_loss, component_loss)
    modal = network.modal()
    load = next(item for item in modal.loads if item.name == modal.excitation)
    force, reference = Synthesis(modal, [load]).solve(LINES).force[:, 0], reference_solution(network, LINES)
    rotation = np.array([dof[0] == "r" for joint in modal.joints for dof in joint.dofs])
    for rows in (rotation, ~rotation):
        if rows.any():
            assert np.all(
                abs(force - reference.force)[rows].max(axis=0) <= 1e-8 * abs(reference.force[rows]).max(axis=0)
            )
    flow = power_flow(modal, LINES)
    np.testing.assert_allclose(flow.dissipated_power.sum(axis=0), flow.input_power, rtol=1e-7)
    assert np.all(flow.dissipated_power >= 0.0)
    assert np.all(flow.transmitted_power >= -1e-9 * flow.input_power)


def test_viscous_equivalent_agrees_where_it_says():
    """A joint's dashpot dissipates as its loss factor at `loss_frequency`; a mode's damping ratio is eta / 2."""
    network = lossy(default_gearbox(), 0.1, 0.04).modal()
    viscous = network.viscous()
    assert viscous.modal_damping["gear_train"] == pytest.approx(0.02, rel=1e-14)
    assert not viscous.has_loss_factors
    at = 2 * np.pi * network.loss_frequency
    for given_joint, found in zip(network.joints, viscous.joints):
        wanted = (1 + 0.1j) * given_joint.stiffness
        np.testing.assert_allclose(found.stiffness + 1j * at * found.damping, wanted, rtol=1e-14)


def test_time_twin_is_that_of_the_viscous_equivalent():
    network = lossy(default_gearbox(), 0.1, 0.04).modal()
    twin = time_twin(network)
    w = LINES[4]
    time = twin.C @ np.linalg.solve(1j * w * np.eye(len(twin.A)) - twin.A, twin.B) + twin.D
    frequency = frequency_response(network.viscous(), np.array([w]), twin.outputs, twin.loads)[0]
    assert np.all(abs(time - frequency).max(axis=0) < 1e-8 * abs(frequency).max(axis=0))
    assert np.linalg.eigvals(twin.A).real.max() < 0.0
