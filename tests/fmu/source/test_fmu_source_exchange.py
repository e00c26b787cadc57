"""The source in model exchange: the angle is a state, and an integrator finds what the exact steps do."""

import ctypes as ct

import numpy as np
import pytest
from fmi3_driver import Fmu3
from fmu_driver import OK, Fmu, reals
from scipy.integrate import solve_ivp
from source_machine import SPEED, deviation, run_up_angle, tones

N = 145  # states with the angle


class Exchange2:
    """An FMI 2 instance in continuous-time mode, as functions of time, states and speed."""

    def __init__(self, unpacked) -> None:
        self.fmu = Fmu(unpacked, kind=0)
        self.fmu.enter("continuous")

    def derivative(self, t, x, speed) -> np.ndarray:
        self._at(t, x, speed)
        result = (ct.c_double * len(x))()
        assert self.fmu.call("fmi2GetDerivatives", result, ct.c_size_t(len(x))) == OK, self.fmu.messages
        return np.array(result)

    def outputs(self, t, x, speed, names) -> np.ndarray:
        self._at(t, x, speed)
        return self.fmu.get(names)

    def states(self) -> np.ndarray:
        result = (ct.c_double * N)()
        assert self.fmu.call("fmi2GetContinuousStates", result, ct.c_size_t(N)) == OK
        return np.array(result)

    def _at(self, t, x, speed) -> None:
        assert self.fmu.call("fmi2SetTime", ct.c_double(t)) == OK
        assert self.fmu.call("fmi2SetContinuousStates", reals(x), ct.c_size_t(len(x))) == OK
        assert self.fmu.set({"mesh.speed": speed}) == OK


class Exchange3(Exchange2):
    """The same in FMI 3."""

    def __init__(self, unpacked) -> None:
        self.fmu = Fmu3(unpacked, exchange=True)
        self.fmu.start()

    def derivative(self, t, x, speed) -> np.ndarray:
        self._at(t, x, speed)
        return self.fmu.vector("fmi3GetContinuousStateDerivatives")

    def states(self) -> np.ndarray:
        return self.fmu.vector("fmi3GetContinuousStates")

    def _at(self, t, x, speed) -> None:
        assert self.fmu.call("fmi3SetTime", ct.c_double(t)) == OK
        assert self.fmu.set_states(x) == OK
        assert self.fmu.set({"mesh.speed": speed}) == OK


@pytest.fixture(params=["2.0", "3.0"])
def exchange(request, source2, source3):
    made = Exchange2(source2) if request.param == "2.0" else Exchange3(source3)
    yield made
    made.fmu.free()


@pytest.mark.parametrize("speed", [SPEED, -300.0, 0.0])
def test_derivatives_and_outputs_at_any_state(exchange, machine, speed):
    rng = np.random.default_rng(2)
    for angle in (0.0, 1.7, -53.2):
        x, e = rng.normal(size=N - 1) * 1e-3, tones().at(angle)
        found = exchange.derivative(0.25, [*x, angle], speed)
        terms = abs(machine.A) @ abs(x) + abs(machine.b * e)
        assert (abs(found[:-1] - machine.A @ x - machine.b * e) / terms.max()).max() < 1e-12
        assert found[-1] == pytest.approx(2 * np.pi * speed / 60, rel=1e-15)
        y = exchange.outputs(0.25, [*x, angle], speed, machine.names)
        assert deviation([y], machine.outputs([x], [e]), machine.names) < 1e-12


def test_states_are_read_as_they_were_set(exchange):
    rng = np.random.default_rng(4)
    for angle in [*rng.uniform(-10, 10, 50), 0.0, 1e-300, -1e-17, 2 * np.pi, 6283185.307, -1e12, 1e22]:
        x = np.append(rng.normal(size=N - 1), angle)
        exchange.derivative(0.0, x, SPEED)
        np.testing.assert_array_equal(exchange.states(), x)


@pytest.mark.parametrize("rate", [0.0, 4.5e6])
def test_an_integrator_finds_the_exact_motion(exchange, machine, rate):
    """Steady speed, and from 0 to 4500 rev/min in 1 ms; DOP853 to 1e-10."""
    start, stop = (SPEED if rate == 0 else 0.0), 1e-3
    scale = np.append(np.full(N - 1, 1e-12), 1e-9)
    found = solve_ivp(
        lambda t, x: exchange.derivative(t, x, start + rate * t),
        (0.0, stop), np.zeros(N), method="DOP853", rtol=1e-10, atol=scale, t_eval=np.linspace(0, stop, 11),
    )  # fmt: skip
    x, e = machine.in_run_up(tones(), start, rate, 1e-5, 100)
    expected = machine.outputs(x, e)[::10]
    speeds = start + rate * found.t
    y = [exchange.outputs(t, x, n, machine.names) for t, x, n in zip(found.t, found.y.T, speeds)]
    assert deviation(y, expected, machine.names) < 1e-8
    np.testing.assert_allclose(found.y[-1], run_up_angle(start, rate, found.t), rtol=1e-9)
