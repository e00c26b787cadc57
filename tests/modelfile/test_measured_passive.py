"""Measured data that are right are never refused, and those that are not are named, over random structures in noise."""

import numpy as np
import pytest

from gearpath.components.driving_points import active_part, complaint

CHANNELS = [f"channel {k}" for k in range(8)]
F = np.linspace(20.0, 2000.0, 400)
S = 2j * np.pi * F[:, None, None]  # i w
ORDERS = {"receptance": 0, "mobility": 1, "accelerance": 2}


def structure(seed, noise):
    """Mobility of a structure with 10 to 30 modes of light damping, every other one free, noise in each value."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(10, 31))
    w = 2 * np.pi * np.sort(rng.uniform(100.0, 3000.0, n))
    zeta = 10 ** rng.uniform(-3.0, -1.7, n)
    if seed % 2:
        w[: rng.integers(1, 7)] = 0.0
    shapes = rng.normal(size=(8, n)) * (0.05 if seed % 4 < 2 else 1.0)
    lossy = w**2 * (1 + 2j * zeta) if seed % 3 else w**2 + 2 * zeta * w * S[:, :, 0]  # hysteretic or viscous
    Y = np.einsum("ar,fr,br->fab", shapes, S[:, :, 0] / (lossy + S[:, :, 0] ** 2), shapes)
    return Y * (1 + noise * (rng.normal(size=Y.shape) + 1j * rng.normal(size=Y.shape)) / np.sqrt(2))


@pytest.mark.parametrize("noise", [0.0, 0.05])
def test_good_data_are_neither_refused_nor_warned_of(noise):
    for seed in range(100):
        Y = structure(seed, noise)
        assert complaint(S[:, 0, 0].imag, Y, "mobility", CHANNELS) is None, seed
        assert active_part(Y) < 0.01, seed


def reading(true, declared, conjugate, seed):
    H = structure(seed, 0.02) * S ** (ORDERS[true] - 1)
    H = H.conj() if conjugate else H
    return complaint(S[:, 0, 0].imag, H * S ** (1 - ORDERS[declared]), declared, CHANNELS)


@pytest.mark.parametrize("declared", ORDERS)
@pytest.mark.parametrize("true", ORDERS)
def test_another_quantity_is_named(true, declared):
    if true != declared:
        found = [reading(true, declared, False, seed) for seed in range(40)]
        assert sum(f"as {true}" in str(words) for words in found) >= 30  # free bodies with few modes may pass
        assert not any("conjugate" in str(words) for words in found)


@pytest.mark.parametrize("quantity", ORDERS)
def test_conjugated_data_are_named(quantity):
    found = [reading(quantity, quantity, True, seed) for seed in range(40)]
    assert sum("conjugate the data" in str(words) for words in found) >= 38


def test_few_sharp_resonances_are_enough():
    """Conjugated accelerance: where a structure takes in power it gives it off, on 3 % of the lines."""
    s = 2j * np.pi * np.linspace(10.0, 2000.0, 2000)
    Y = sum(s / (w**2 + 0.002 * w * s + s**2) for w in 2 * np.pi * np.array([350.0, 800.0, 1300.0, 1900.0]))
    A = (s * Y + 2.0).conj()[:, None, None]
    found = A / s[:, None, None]
    assert 0.0 < active_part(found) < 0.05
    assert "conjugate the data" in str(complaint(s.imag, found, "accelerance", ["one"]))


def test_a_channel_with_the_sign_of_its_force_changed_is_named():
    for seed in range(20):
        Y = structure(seed, 0.01)
        Y[:, :, 3] *= -1.0
        assert "at channel 3 the driving point gives off power" in complaint(S[:, 0, 0].imag, Y, "mobility", CHANNELS)
