"""The time twin against the frequency twin, stability, and exact discretisation."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from systems import random_gearbox

from gearpath.network.assemble import assemble
from gearpath.network.response import frequency_response
from gearpath.network.time_twin import time_twin
from gearpath.numerics.propagator import discretise

LINES = 2 * np.pi * np.linspace(20.0, 5000.0, 400)


def transfer(twin, omega):
    identity = np.eye(len(twin.A))
    return np.array([twin.C @ np.linalg.solve(1j * w * identity - twin.A, twin.B) + twin.D for w in omega])


@pytest.fixture(scope="module")
def both(modal):
    twin = time_twin(modal)
    return twin, transfer(twin, LINES), frequency_response(modal, LINES, twin.outputs, twin.loads)


def test_twins_agree_to_1e8_of_the_largest_value(both):
    _, time, frequency = both
    assert np.all(abs(time - frequency).max(axis=0) < 1e-8 * abs(frequency).max(axis=0))


def test_twins_agree_pointwise(both):
    """1e-6 at every line, of the value itself or of 1e-7 of the output's largest.

    At 20 Hz the tilt of the casing is 1e-13 of its largest value, a small difference of joint forces K q, where q holds
    the rigid spin d e itself, because a transmission error is a proper input. Rounding of A and of the solution is then
    K eps d e: 9 of 10,800 values miss 1e-6 of their own size.
    """
    _, time, frequency = both
    floor = 1e-7 * abs(frequency).max(axis=0)
    assert np.all(abs(time - frequency) < 1e-6 * np.maximum(abs(frequency), floor))


def test_default_gearbox_is_stable(both):
    twin, _, _ = both
    assert np.linalg.eigvals(twin.A).real.max() < -1.0


@settings(max_examples=30, deadline=None)
@given(st.builds(random_gearbox, st.integers(0, 2**32 - 1), st.integers(1, 8)))
def test_twins_agree_on_random_machines(system):
    modal = assemble(system).modal()
    twin = time_twin(modal)
    omega = LINES[[10, 100, 399]]
    time, frequency = transfer(twin, omega), frequency_response(modal, omega, twin.outputs, twin.loads)
    force = np.array([not load.is_transmission_error for load in twin.loads])
    scale = abs(frequency).max(axis=(0, 1), keepdims=True)
    assert np.all(abs(time - frequency)[..., force] <= 1e-8 * scale[..., force])


def test_energy_of_free_motion_only_decays(modal):
    """Without input the mechanical energy falls in every step: T + V from the modal state and the joint springs."""
    twin = time_twin(modal)
    N = len(modal.eigenvalues)
    step = discretise(twin.A, twin.B, 2e-5)
    w = np.where(modal.eigenvalues > 0, np.sqrt(modal.eigenvalues), 2 * np.pi * 1000.0)
    K, _ = modal.interface_matrices()
    x = np.random.default_rng(1).normal(size=2 * N) * np.where(np.arange(2 * N) % N < 12, 1.0, 0.0)
    energies = []
    for _ in range(200):
        q, v = x[:N] / w, x[N:]
        slip = modal.relative @ q
        energies.append(0.5 * (v @ v + modal.eigenvalues @ q**2 + slip @ K @ slip))
        x = step.step(x, np.zeros(2), np.zeros(2))
    assert np.all(np.diff(energies) < 0.0)
