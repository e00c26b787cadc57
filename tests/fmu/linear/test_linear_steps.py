"""Steps of a linear system against scipy's exponential, python-control's simulation and closed forms."""

import control
import numpy as np
import pytest
from fmu_driver import OK
from linear_cases import random_system, run, started, stepped, unpacked_of

SIZES = (0, 1, 2, 5, 8, 13, 37, 60)
STEPS = np.array([1e-5, 2e-5, 1e-5, 3.7e-4, 1e-6, 1e-5, 5e-3, 1e-5, 2e-5, 1e-3, 4e-5, 1e-5])


def relative(found, wanted) -> float:
    return float((abs(found - wanted).max(axis=0) / (abs(wanted).max(axis=0) + 1e-300)).max())


@pytest.mark.parametrize("fmi", ["2.0", "3.0"])
@pytest.mark.parametrize("n", SIZES)
@pytest.mark.parametrize("growth", [0.0, 400.0])
def test_steps_of_changing_size(n, growth, fmi, tmp_path):
    """From random states, inputs held and linear, stable and unstable."""
    system = random_system(n, growth=growth)
    unpacked = unpacked_of(system, tmp_path, fmi)
    rng = np.random.default_rng(n)
    x = rng.normal(size=n)
    u, slopes = rng.normal(size=(len(STEPS), 2)), rng.normal(size=(len(STEPS), 2)) / STEPS[:, None]
    for growing in (None, slopes):
        wanted = stepped(system, x, STEPS, u, 0 * slopes if growing is None else growing)
        assert relative(run(unpacked, system, STEPS, u, growing, x), wanted) < 1e-12


@pytest.mark.parametrize("fmi", ["2.0", "3.0"])
def test_linear_inputs_are_those_of_forced_response(fmi, tmp_path):
    system, h, steps = random_system(7), 2e-5, 400
    t = h * np.arange(steps + 1)
    u = np.stack([np.sin(2e3 * t**0.9), np.cos(900.0 * t)], axis=1)
    wanted = control.forced_response(system, t, u.T).outputs.T
    unpacked = unpacked_of(system, tmp_path, fmi)
    found = run(unpacked, system, np.full(steps, h), u, np.diff(u, axis=0) / h, np.zeros(7))
    assert relative(found, wanted) < 1e-12


def test_companion_form_of_poles_far_apart(tmp_path):
    """Lags of 1 to 1e6 rad/s in a row: coefficients up to 1e12, the step response known in closed form."""
    poles = np.array([1.0, 1e2, 1e4, 1e6])
    tf = control.tf([np.prod(poles)], np.poly(-poles), name="lags", inputs="u", outputs="y")
    unpacked = unpacked_of(tf, tmp_path)
    residues = [-np.prod(np.delete(poles, i) / (np.delete(poles, i) - p)) for i, p in enumerate(poles)]
    for h in (1e-6, 1e-5, 1e-3, 0.1):
        fmu = started(unpacked)
        assert fmu.set({"u": 1.0}) == OK
        found = []
        for k in range(20):
            assert fmu.step(k * h, h) == OK, fmu.messages
            found.append(fmu.get(["y"])[0])
        t = h * np.arange(1, 21)
        # near t = 0 the closed form cancels: it is measured at the response's own end
        wanted = 1.0 + np.exp(-np.outer(t, poles)) @ residues
        assert abs(found - wanted).max() < 1e-11 * abs(wanted[-1]) + 1e-15, h
        fmu.free()


def test_integrator_and_ramp(tmp_path):
    """A double integrator: y = t^2 / 2 for u = 1, t^3 / 6 for u = t; exact but for rounding."""
    system = control.ss([[0, 1], [0, 0]], [[0], [1]], [[1, 0]], [[0]], inputs="u", outputs="y", states=["x", "v"])
    unpacked = unpacked_of(system, tmp_path)
    steps = np.full(50, 0.02)
    t = np.concatenate([[0.0], np.cumsum(steps)])
    found = run(unpacked, system, steps, np.ones((50, 1)), None, np.zeros(2))
    assert abs(found[:, 0] - t**2 / 2).max() < 1e-14
    found = run(unpacked, system, steps, t[:-1, None], np.ones((50, 1)), np.zeros(2))
    assert abs(found[:, 0] - t**3 / 6).max() < 1e-14


def test_units_of_any_size(tmp_path):
    """A gain of 1e9, states in units of 1e-12 and 1e8: what comes out does not depend on them."""
    plain = random_system(6, seed=3)
    T, v = np.array([1e-12, 1.0, 1e8, 1e3, 1e-6, 1e2]), np.array([1e9, 1e-9])
    scaled = control.StateSpace(
        plain.A * T / T[:, None], plain.B * v / T[:, None], plain.C * T, plain.D * v,
        inputs=plain.input_labels, outputs=plain.output_labels, states=plain.state_labels,
    )  # fmt: skip
    u = np.random.default_rng(5).normal(size=(len(STEPS), 2))
    wanted = stepped(plain, np.zeros(6), STEPS, u, 0 * u)
    found = run(unpacked_of(scaled, tmp_path), scaled, STEPS, u / v, None, np.zeros(6))
    assert relative(found, wanted) < 1e-12


def test_a_step_that_leaves_no_digits_is_refused(tmp_path):
    system = control.ss([[-1e20, 3e19], [2e19, -1e20]], [[1], [1]], [[1, 0]], [[0]])
    fmu = started(unpacked_of(system, tmp_path))
    assert fmu.step(0.0, 1.0) != OK
    assert "its matrix A is too large for it" in fmu.messages[-1]
    fmu.free()
    growing = started(unpacked_of(control.ss([[1e4]], [[1]], [[1]], [[0]], inputs="u"), tmp_path / "growing"))
    assert growing.set({"u": 1.0}) == OK
    assert growing.step(0.0, 1.0) != OK
    before = growing.get(["y[0]"])
    assert before == 0.0
    assert growing.step(0.0, 1e-4) == OK  # nothing has changed
    growing.free()
