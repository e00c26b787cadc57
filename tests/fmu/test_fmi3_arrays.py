"""FMI 3 arrays: joint matrices, ports, states, and the matrices of the state equations."""

import fmu_oracle as oracle
import numpy as np
import pytest
from fmi3_driver import Fmu3
from fmu_driver import OK, Fmu
from fmu_helpers import ROOT
from fmu_networks import CHANGES, changed

import gearpath as gp

MATRICES = ["system.A", "system.B", "system.C", "system.D"]


def agree(fmu, wanted):
    """Each matrix to 1e-12 of the largest entry of each of its rows."""
    for name, matrix in zip(MATRICES, wanted):
        found = fmu.array(name)
        assert found.shape == matrix.shape
        scale = np.abs(matrix).max(axis=1, keepdims=True)
        assert (np.abs(found - matrix) <= 1e-12 * scale).all(), (name, np.abs(found - matrix).max())


def test_matrices_of_the_state_equations(fmu3, network):
    agree(fmu3, oracle.scaled_time_system(network)[:4])
    assert fmu3.set(CHANGES) == OK
    agree(fmu3, oracle.scaled_time_system(changed(network))[:4])
    assert fmu3.set({name: float(fmu3.variables[name].start) for name in list(CHANGES)[2:]}) == OK
    joint = network.joints[0]
    assert fmu3.set({"bearing_1.stiffness": joint.stiffness, "bearing_1.damping": joint.damping}) == OK
    agree(fmu3, oracle.scaled_time_system(network)[:4])


@pytest.mark.slow
def test_matrices_are_those_of_state_space(tmp_path):
    """The default gearbox, as exported and after a bearing was changed, against `gp.state_space`."""
    model = gp.load(ROOT / "models" / "gearbox.toml")
    fmu = Fmu3(Fmu.unpack(gp.export_fmu(model, tmp_path / "g.fmu", fmi="3.0"), tmp_path / "g"))
    fmu.start()
    space = gp.state_space(model)
    agree(fmu, (space.A, space.B, space.C, space.D))
    names = [v.name for v in fmu.unpacked.description.modelVariables]
    inputs = [label.replace("/", ".", 1) for label in space.input_labels]
    assert [name for name in names if name in inputs] == inputs
    stiffness = [[8e7, 1e6], [1e6, 5e4]]
    other = gp.state_space(model.replace({"joints.bearing_1.stiffness": stiffness}))
    damping = 1e-6 * np.array(stiffness)  # the model file gives it as a time
    assert fmu.set({"bearing_1.stiffness": stiffness, "bearing_1.damping": damping}) == OK
    agree(fmu, (other.A, other.B, other.C, other.D))
    fmu.free()


def test_start_values(fmu3, network):
    for joint in network.joints:
        for what in ("stiffness", "damping"):
            found = fmu3.get([f"{joint.name}.{what}"])
            assert np.array_equal(found, getattr(joint, what).ravel())
            written = fmu3.variables[f"{joint.name}.{what}"].start.split()
            assert [float(x) for x in written] == found.tolist()


def test_a_matrix_acts_at_once(fmu3, network):
    """Set, get, and the frequency outputs of the changed network."""
    fmu3.get(["alpha"])
    assert fmu3.set(CHANGES) == OK
    for name, value in CHANGES.items():
        assert np.array_equal(fmu3.get([name]), np.ravel(value))
    wanted = oracle.frequency_response(changed(network), 500.0)
    for name in ("alpha", "alpha_force", "bearing_1.alpha", "bearing_4.alpha"):
        assert abs(fmu3.get([name])[0] - wanted[name]) < 1e-9 * abs(wanted["alpha"])


def check_ports(fmu, network):
    for joint in network.joints:
        force, velocity = fmu.get([f"{joint.name}.force"]), fmu.get([f"{joint.name}.velocity"])
        assert force.tolist() == fmu.get([f"{joint.name}.force_{dof}" for dof in joint.dofs[: len(force)]]).tolist()
        assert (force != 0).all()
        if joint.kind == "bearing":
            assert velocity[0] == fmu.get([f"{joint.name}.velocity_uy"])[0]
            assert fmu.get([f"{joint.name}.power"])[0] == pytest.approx(force @ velocity, rel=1e-13)
        else:
            assert velocity.tolist() == [0.0]  # the ground


@pytest.mark.parametrize("as_exported", [True, False])
def test_ports_are_the_scalars(fmu3, exchange3, network, as_exported):
    """Bit by bit, in modal and in physical coordinates, in co-simulation and in model exchange."""
    fmu3.set({"mesh.transmission_error": 1e-6, "actuators.shaker": 5.0})
    if not as_exported:
        fmu3.set(CHANGES)
    for i in range(20):
        assert fmu3.step(i * 1e-5, 1e-5) == OK
    check_ports(fmu3, network)
    exchange3.set({"mesh.transmission_error": 1e-6})
    assert exchange3.set_states(fmu3.get(["state"])) == OK
    check_ports(exchange3, network)


def test_states_and_derivatives(unpacked3, network):
    """Set before the simulation as an array, they are what model exchange gets, and der(state) is its derivative."""
    x = np.random.default_rng(1).normal(size=54)
    fmu = Fmu3(unpacked3, exchange=True)
    assert fmu.set({"state": x}) == OK
    fmu.start()
    assert np.array_equal(fmu.get(["state"]), x)
    assert np.array_equal(fmu.vector("fmi3GetContinuousStates"), x)
    assert np.array_equal(fmu.get(["der(state)"]), fmu.vector("fmi3GetContinuousStateDerivatives"))
    fmu.free()
    stepping = Fmu3(unpacked3)
    assert stepping.set({"state": x}) == OK
    stepping.start()
    A, _, C, _, names = oracle.scaled_time_system(network)
    assert stepping.get(names) == pytest.approx(C @ x, rel=1e-9, abs=1e-12 * np.abs(C @ x).max())
    wanted = np.abs(A) @ np.abs(x)
    assert (np.abs(stepping.get(["der(state)"]) - A @ x) <= 1e-13 * wanted).all()
    stepping.free()


def test_time(fmu3):
    assert fmu3.get(["time"])[0] == 0.0
    for i in range(7):
        assert fmu3.step(i * 1e-4, 1e-4) == OK
    assert fmu3.get(["time"])[0] == 6 * 1e-4 + 1e-4
    assert fmu3.call("fmi3Reset") == OK
    fmu3.start(start=2.5)
    assert fmu3.get(["time"])[0] == 2.5


def test_any_order_of_arrays_and_scalars(fmu3):
    """One call for all variables, shuffled, gives what single calls give."""
    fmu3.set({"mesh.force": 3.0})
    fmu3.step(0.0, 1e-5)
    names = list(np.random.default_rng(3).permutation(list(fmu3.reference)))
    found, at = fmu3.get(names), 0
    for name, size in zip(names, fmu3.sizes(names)):
        assert np.array_equal(found[at : at + size], fmu3.get([name])), name
        at += size
    assert at == len(found)
