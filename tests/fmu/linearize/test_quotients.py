"""Extrapolated differences of functions whose derivative is known."""

import numpy as np
import pytest

from gearpath.fmu.linearizing.quotients import derivative

INF = np.inf


def of(function, largest=0.01, low=-INF, high=INF):
    value, error = derivative(lambda h: np.array([function(h)]), largest, low, high)
    return value[0], error[0]


@pytest.mark.parametrize(
    ("function", "expected"),
    [
        (lambda h: 3.0 + 7.0 * h, 7.0),
        (lambda h: np.exp(1.0 + h), np.e),
        (lambda h: np.sin(1e3 * h) / 1e3, 1.0),
        (lambda h: h / (1.0 + (h / 1e-6) ** 2), 1.0),  # a scale far below the first step
        (lambda h: 1e6 + h**2, 0.0),
        (lambda h: np.tanh(1e5 * (h + 2e-6)), 1e5 / np.cosh(0.2) ** 2),
    ],
)
def test_smooth_functions_of_any_scale(function, expected):
    found, error = of(function)
    assert found == pytest.approx(expected, rel=1e-6, abs=1e-9)
    assert abs(found - expected) <= 10.0 * error
    assert error <= 1e-4 * max(abs(expected), 1e-2)


def test_linear_functions_are_exact_at_once():
    steps = []

    def function(h):
        steps.append(h)
        return np.array([3.0 + 7.0 * h, 0.0, -2.0 * h])

    value, _ = derivative(function, 0.01, -INF, INF)
    np.testing.assert_allclose(value, [7.0, 0.0, -2.0], rtol=1e-13)
    assert len(steps) <= 6


@pytest.mark.parametrize(("low", "high"), [(0.0, INF), (-INF, 0.0), (0.0, 1e-3), (-2e-9, 5.0)])
def test_bounds_are_kept(low, high):
    def function(h):
        assert low <= h <= high
        return np.exp(h) + h**2

    found, error = of(function, 0.01, low, high)
    assert found == pytest.approx(1.0, rel=1e-9)
    assert abs(found - 1.0) <= 10.0 * error


def test_steps_without_a_value_are_left_out():
    value, _ = derivative(lambda h: np.array([np.exp(h)]) if abs(h) < 1e-3 else None, 0.1, -INF, INF)
    assert value[0] == pytest.approx(1.0, rel=1e-9)
    assert derivative(lambda _: None, 0.1, -INF, INF) is None


def test_a_jump_has_a_large_error():
    _, error = of(lambda h: np.sign(h))
    assert error > 1.0
    _, error = of(abs, 0.01, 0.0, INF)
    assert error < 1e-9  # from one side there is no kink
