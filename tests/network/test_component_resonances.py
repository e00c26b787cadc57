"""At and beside the free-free resonances of undamped components, where their uncoupled mobility is infinite."""

from dataclasses import replace

import numpy as np
import pytest
from systems import default_gearbox

from gearpath.errors import AccuracyError
from gearpath.network.assemble import assemble
from gearpath.network.power import power_flow
from gearpath.network.reference import reference_solution
from gearpath.network.response import frequency_response
from gearpath.network.system import PointExcitation

DISTANCES = (0.0, 1e-14, 1e-12, 1e-10, 1e-8, 1e-7, 1e-6, 1e-5)


def undamped(**overrides):
    system = default_gearbox(damping=((0.0, 0.0), (0.0, 0.0)), **overrides)
    joints = {
        name: replace(j, damping=tuple((0.0,) * len(j.dofs) for _ in j.dofs)) for name, j in system.joints.items()
    }
    train = replace(system.components["gear_train"], modal_damping=0.0)
    return assemble(replace(system, joints=joints, components={**system.components, "gear_train": train}))


@pytest.fixture(scope="module")
def lossless():
    network = undamped()
    return network, network.modal()


def hertz_beside(modal):
    """Around the first and the fifth elastic mode of the gear train (1509.19 and 3682.29 Hz)."""
    modes = np.sqrt(modal.eigenvalues[[4, 8]]) / (2 * np.pi)
    hertz = (modes[:, None] * np.concatenate([1 + np.array(DISTANCES), 1 - np.array(DISTANCES)])).ravel()
    return np.append(hertz, 3682.2869053574373)


def forces_agree(network, modal, hertz):
    omega = 2 * np.pi * hertz
    wanted, flow = reference_solution(network, omega), power_flow(modal, omega)
    deviation = abs(flow.force - wanted.force[:8]) / abs(wanted.force[:8])
    np.testing.assert_array_less(deviation.max(axis=0), 1e-7)


def test_interface_forces_under_a_transmission_error(lossless):
    forces_agree(*lossless, hertz_beside(lossless[1]))


def test_interface_forces_under_a_point_force():
    port = default_gearbox().joints["bearing_1"].between[0]
    network = undamped(excitation=PointExcitation(replace(port, z=0.07), "uy"))
    modal = network.modal()
    forces_agree(network, modal, hertz_beside(modal))


def test_every_load_and_output_passes_smoothly_through_the_resonance(lossless):
    """All transfers at the resonance lie between those 1e-5 below and above it."""
    _, modal = lossless
    outputs = [output for output in modal.outputs if output.quantity != "power"]
    w = np.sqrt(modal.eigenvalues[8])
    below, at, above = frequency_response(modal, w * np.array([1 - 1e-5, 1.0, 1 + 1e-5]), outputs, modal.loads)
    scale = abs(at).max(axis=1, keepdims=True)
    assert np.all(abs(at - (below + above) / 2) < 1e-6 * scale)


def test_a_loose_component_at_its_resonance_is_refused(lossless):
    """Without joints there is no finite answer, and the frequency is named."""
    _, modal = lossless
    for joint in modal.joints:
        modal = modal.with_joint(joint.name, 0.0 * joint.stiffness, 0.0 * joint.damping)
    eigenvalues = modal.eigenvalues.copy()
    eigenvalues[4] = 1e4**2
    with pytest.raises(AccuracyError, match=r"not finite at 1591\.5494309\d* Hz"):
        power_flow(replace(modal, eigenvalues=eigenvalues), np.array([1.1e4, 1e4, 1.2e4]))
