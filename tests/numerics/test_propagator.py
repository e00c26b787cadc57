"""Exact discretisation against closed forms."""

import numpy as np
import pytest

from gearpath.numerics.propagator import discretise

W, ZETA = 2 * np.pi * 50.0, 0.02
A = np.array([[0.0, 1.0], [-(W**2), -2 * ZETA * W]])
B = np.array([[0.0], [1.0]])


def test_free_decay_of_an_oscillator():
    h, wd = 0.003, W * np.sqrt(1 - ZETA**2)
    expected = np.exp(-ZETA * W * h) * (np.cos(wd * h) + ZETA * W / wd * np.sin(wd * h))
    assert discretise(A, B, h).transition[0, 0] == pytest.approx(expected, rel=1e-12)


def test_a_ramp_input_is_exact_for_a_double_integrator():
    """x'' = u with u = a + b t: x = a t^2/2 + b t^3/6."""
    step = discretise(np.array([[0.0, 1.0], [0.0, 0.0]]), B, 0.5)
    x = step.step(np.zeros(2), np.array([3.0]), np.array([2.0 * 0.5]))
    np.testing.assert_allclose(x, [3 * 0.125 + 2 * 0.125 / 6, 3 * 0.5 + 2 * 0.125], rtol=1e-13)


def test_many_small_steps_equal_one_large_step():
    """With a linear input the result does not depend on the step size: 1 s in one step and in 10,000."""
    large, small = discretise(A, B, 1.0), discretise(A, B, 1e-4)
    x = np.array([1e-3, 0.0])
    expected = large.step(x, np.array([1.0]), np.array([4.0]))
    for k in range(10_000):
        x = small.step(x, np.array([1.0 + 4.0 * k * 1e-4]), np.array([4.0 * 1e-4]))
    np.testing.assert_allclose(x, expected, rtol=1e-9)


def test_units_of_the_inputs_do_not_matter():
    """An input in tiny units has a huge B: the responses stay as accurate as with any other, over many periods too."""
    w, h, factor = 2 * np.pi * 5e5, 5e-5, 1e15
    stiff = np.array([[0.0, w], [-w, -2 * ZETA * w]])
    wd = np.sqrt(1 - ZETA**2)
    decay = np.exp(-ZETA * w * h) * (np.cos(wd * w * h) + ZETA / wd * np.sin(wd * w * h))
    huge, plain = discretise(stiff, factor * B, h), discretise(stiff, B, h)
    assert huge.transition[0, 0] == pytest.approx(decay, abs=1e-12)
    assert huge.held[0, 0] * w / factor == pytest.approx(1 - decay, rel=1e-12)
    np.testing.assert_allclose(huge.held, factor * plain.held, rtol=1e-12)
    np.testing.assert_allclose(huge.ramp, factor * plain.ramp, rtol=1e-12)
    assert not discretise(stiff, 0 * B, h).held.any()
