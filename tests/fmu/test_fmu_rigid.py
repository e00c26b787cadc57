"""Rigid motions that nothing resists, beside the dense propagator: exact at every step size, and energy never grows."""

import numpy as np
import pytest
from fmu_driver import ERROR, OK
from fmu_networks import CASING, RIGID
from fmu_piecewise import in_entries
from fmu_states import new, version_of
from scipy.linalg import null_space

MOUNTS = {f"mount_{i}.{what}": 0.0 for i in range(1, 5) for what in ("stiffness", "damping")}
FREE = MOUNTS | {f"bearing_{i}.{what}": np.zeros((2, 2)) for i in (3, 4) for what in ("stiffness", "damping")}


@pytest.fixture(params=[2, 3])
def fmu(request, unpacked, unpacked3):
    fmu = new(unpacked if request.param == 2 else unpacked3)
    fmu.start()
    yield fmu
    fmu.free()


def free_motions(network):
    """Orthonormal c (N, count) with L c = 0 and P c = 0 at the bearings that are left, by singular values."""
    rows = [joint.source - joint.receiver for joint in network.joints if joint.name in ("bearing_1", "bearing_2")]
    return null_space(np.vstack([*rows, np.diag(network.eigenvalues > 0).astype(float)]))


def states(fmu, network):
    n = len(network.eigenvalues)
    if "state" in fmu.reference:
        found = fmu.get(["state"])
    else:
        names = [v.name for v in fmu.unpacked.description.modelVariables if v.name.endswith((".x", ".v"))]
        found = fmu.get(sorted(names, key=lambda name: fmu.reference[name]))
    return found[:n], found[n : 2 * n]


@pytest.mark.parametrize("h", [1e-5, 1e-3, 0.1, 1.0, 10.0])
def test_a_force_accelerates_the_free_machine(fmu, network, h):
    """c v = c b F t and c q = c b F t^2 / 2, in 300 steps; mounts and two bearings were taken away."""
    c = free_motions(network)
    assert c.shape[1] >= 1
    assert fmu.set(in_entries(FREE, version_of(fmu.unpacked))) == OK
    assert fmu.step(0.0, h) == OK
    assert fmu.set({"actuators.shaker": 7.0}) == OK
    for i in range(300):
        assert fmu.step(h + i * h, h) == OK, fmu.messages
    shaker = next(load for load in network.loads if load.name == "actuators.shaker")
    gain, t = 7.0 * (c.T @ shaker.column), 300 * h
    x, v = states(fmu, network)
    np.testing.assert_allclose(c.T @ v, gain * t, rtol=1e-9)
    rigid = x[np.flatnonzero(network.eigenvalues == 0)]
    assert len(rigid) == RIGID + CASING
    moved = c.T @ x
    np.testing.assert_allclose(moved / moved[0], gain / gain[0], rtol=1e-9)
    assert fmu.set({"actuators.shaker": 0.0}) == OK
    for i in range(300):
        assert fmu.step(301 * h + i * h, h) == OK
    x2, v2 = states(fmu, network)
    np.testing.assert_allclose(c.T @ v2, gain * t, rtol=1e-9)  # nothing is lost, and nothing won
    np.testing.assert_allclose(c.T @ x2, 3.0 * moved, rtol=1e-9)  # 1/2 t^2, then t^2 more


def test_linear_input(unpacked, network):
    """A force that grows within each step: c v = c b a t^2 / 2."""
    fmu, h, rate = new(unpacked), 0.05, 3.0
    fmu.start()
    c = free_motions(network)
    assert fmu.set(in_entries(FREE, version_of(fmu.unpacked))) == OK
    for i in range(100):
        assert fmu.set({"actuators.shaker": rate * i * h}) == OK
        assert fmu.set_slopes({"actuators.shaker": rate}) == OK
        assert fmu.step(i * h, h) == OK
    shaker = next(load for load in network.loads if load.name == "actuators.shaker")
    x, v = states(fmu, network)
    gain, t = rate * (c.T @ shaker.column), 100 * h
    np.testing.assert_allclose(c.T @ v, gain * t**2 / 2, rtol=1e-9)
    held, ratio = c.T @ x, (c.T @ v) * t / 3  # w c q = w c b a t^3 / 6
    np.testing.assert_allclose(held / held[0], ratio / ratio[0], rtol=1e-9)
    fmu.free()


@pytest.mark.parametrize("stiffness", [1e8, 1e10, 1e12])
@pytest.mark.parametrize("h", [1e-3, 0.1, 10.0])
def test_energy_does_not_grow(fmu, network, stiffness, h):
    """A kicked free machine with a very stiff bearing, 500 steps: what stays is the rigid motion."""
    changes = FREE | {"bearing_1.stiffness": stiffness * np.eye(2)}
    assert fmu.set(in_entries(changes, version_of(fmu.unpacked)) | {"actuators.shaker": 100.0}) == OK
    assert fmu.step(0.0, 1e-3) == OK
    assert fmu.set({"actuators.shaker": 0.0}) == OK
    kinetic = [0.5 * float(states(fmu, network)[1] @ states(fmu, network)[1])]
    for i in range(500):
        assert fmu.step(1e-3 + i * h, h) == OK
        kinetic.append(0.5 * float(np.sum(states(fmu, network)[1] ** 2)))
    rigid = 0.5 * float(np.sum((free_motions(network).T @ states(fmu, network)[1]) ** 2))
    assert rigid > 0
    if h >= 0.1:
        assert kinetic[-1] == pytest.approx(rigid, rel=1e-9)
    assert max(kinetic) <= 1.2 * max(kinetic[:2])  # some of it goes to and fro as energy of deformation
    assert kinetic[-1] < kinetic[0]


@pytest.mark.parametrize("damping", [1e16, 1e300])
def test_without_digits_a_step_is_refused(fmu, damping):
    """And smaller parameters bring it back."""
    version = version_of(fmu.unpacked)
    assert fmu.set(in_entries({"bearing_1.damping": damping * np.eye(2)}, version)) == OK
    assert fmu.step(0.0, 1e-2) == ERROR
    assert "no digits would be left" in fmu.messages[-1]
    assert fmu.set(in_entries({"bearing_1.damping": np.diag([300.0, 1.0])}, version)) == OK
    assert fmu.step(0.0, 1e-2) == OK
