"""FMI 3 intermediate update: inputs given within a step make an exact first-order hold; results can be read there."""

import ctypes as ct
import math

import control
import fmu_oracle as oracle
import numpy as np
import pytest
from fmi3_driver import Fmu3
from fmu_driver import ERROR, OK

from gearpath.network.time_twin import time_twin
from gearpath.numerics.propagator import discretise

INPUTS = ["mesh.transmission_error", "mesh.force", "actuators.shaker"]
AGES = slice(208, 280)  # in a serialised state: the steps counted and the step sizes kept, for the age of a cache


def signals(steps, seed=0):
    return np.random.default_rng(seed).normal(size=(steps, 3)) * [1e-6, 100.0, 100.0]


def run(unpacked3, U, h, outputs):
    """Steps whose inputs go from one row of U to the next: outputs at all rows."""
    rows = iter(U[1:])

    def give(fmu, _time, asked, _readable):
        if asked:
            assert_ok.append(fmu.set(dict(zip(INPUTS, next(rows)))))

    assert_ok: list[int] = []
    fmu = Fmu3(unpacked3, intermediate=give)
    fmu.start()
    fmu.set(dict(zip(INPUTS, U[0])))
    y = [fmu.get(outputs)]
    for i in range(len(U) - 1):
        assert fmu.step(i * h, h) == OK, fmu.messages
        y.append(fmu.get(outputs))
        assert np.allclose(fmu.get(INPUTS), U[i + 1], rtol=1e-14, atol=1e-14 * np.abs(U[i : i + 2]).max(axis=0))
    assert assert_ok == [OK] * (len(U) - 1)
    fmu.free()
    return np.array(y)


def error(found, wanted):
    return (np.abs(found - wanted).max(axis=0) / np.abs(wanted).max(axis=0)).max()


@pytest.mark.skipif(np.finfo(np.longdouble).eps > 1e-18, reason="long double is no wider than double here")
@pytest.mark.parametrize("h", [1e-6, 1e-5, 1e-4])
def test_first_order_hold_in_extended_precision(unpacked3, network, h):
    U = signals(500)
    wanted, names = oracle.first_order_hold(network, U, h)
    assert error(run(unpacked3, U, h, names), wanted) < 2e-12


@pytest.mark.parametrize(
    ("h", "of_control", "of_propagator"), [(1e-6, 1e-11, 1e-10), (1e-5, 1e-11, 1e-10), (1e-4, 1e-9, 1e-8)]
)
def test_first_order_hold(unpacked3, network, h, of_control, of_propagator):
    """Against python-control, and the package's propagator in the scaled states.

    It is those two that are off from 80-bit arithmetic, by 7e-12, 1e-12, 3e-10 and 3e-11, 3e-11, 1e-9.
    """
    U, twin = signals(500), time_twin(network)
    names = [output.name for output in twin.outputs]
    found = run(unpacked3, U, h, names)
    A, B, C, D, others = oracle.time_system(network)
    assert others == names
    peer = control.forced_response(control.ss(A, B, C, D), T=np.arange(len(U)) * h, U=U.T).outputs.T
    assert error(found, peer) < of_control
    step, x, wanted = discretise(twin.A, twin.B, h), np.zeros(len(twin.A)), []
    for u, change in zip(U, np.diff(U, axis=0, append=U[-1:])):
        wanted.append(twin.C @ x + twin.D @ u)
        x = step.step(x, u, change)
    assert error(found, np.array(wanted)) < of_propagator


def test_calls_and_their_flags(unpacked3):
    """Asked for inputs once, told of results once, both at the end of the step."""
    fmu = Fmu3(unpacked3, intermediate=lambda *_: None)
    fmu.start()
    assert fmu.step(0.0, 1e-5) == OK
    assert fmu.step(1e-5, 2e-5) == OK
    ask, tell = (True, False, False, False), (False, True, True, False)
    assert fmu.calls == [(1e-5, ask), (1e-5, tell), (1e-5 + 2e-5, ask), (1e-5 + 2e-5, tell)]
    fmu.free()


def test_results_within_the_step_are_those_after_it(unpacked3):
    names, inside = ["bearing_1.force", "casing.velocity_uy", "state", "time", "alpha"], []

    def read(fmu, _time, _asked, readable):
        if readable:
            inside.append(fmu.get(names))

    fmu = Fmu3(unpacked3, intermediate=read)
    fmu.start()
    fmu.set({"actuators.shaker": 3.0})
    for i in range(5):
        assert fmu.step(i * 1e-5, 1e-5) == OK
        assert np.array_equal(inside[-1], fmu.get(names))
    assert len(inside) == 5
    fmu.free()


def test_no_callback_and_a_silent_one_hold_the_inputs(unpacked3):
    ends = []
    for intermediate in (None, lambda *_: None):
        fmu = Fmu3(unpacked3, intermediate=intermediate)
        fmu.start()
        fmu.set({"mesh.force": 7.0})
        for i in range(10):
            assert fmu.step(i * 1e-5, 1e-5) == OK
        assert fmu.get(["mesh.force"])[0] == 7.0
        ends.append(fmu.serialised())
        fmu.free()
    assert ends[0] == ends[1]


def act_once(unpacked3, asked_for, action):
    """The state after two steps, in the first of which `action` is done; and its status and the last message."""
    status: list[int] = []

    def act(fmu, _time, asked, _readable):
        if asked == asked_for and not status:
            status.append(action(fmu) if action else OK)

    fmu = Fmu3(unpacked3, intermediate=act)
    fmu.start()
    fmu.set({"mesh.force": 7.0, "actuators.shaker": -1.0})
    for i in range(2):
        assert fmu.step(i * 1e-5, 1e-5) == OK
    message, end = fmu.messages[-1] if fmu.messages else "", fmu.serialised()
    fmu.free()
    return status[0], message, end


def sized(fmu, values):
    return fmu.call("fmi3SetFloat64", fmu.references(["mesh.force"]), 1, (ct.c_double * 2)(1.0, 2.0), values)


@pytest.mark.parametrize(
    ("asked", "action", "words"),
    [
        (True, lambda fmu: fmu.set({"mesh.force": 1.0, "mount_1.stiffness": 1e6}), "between steps only"),
        (True, lambda fmu: fmu.set({"bearing_1.stiffness": np.eye(2)}), "between steps only"),
        (True, lambda fmu: fmu.set({"gear_train.modal_damping": 0.1}), "between steps only"),
        (True, lambda fmu: fmu.set({"state": np.ones(54)}), "is a state"),
        (True, lambda fmu: fmu.set({"alpha": 1.0}), "is a result"),
        (True, lambda fmu: fmu.set({"mesh.force": 1.0, "actuators.shaker": math.nan}), "finite"),
        (True, lambda fmu: fmu.set({"mesh.force": 1.0, "actuators.shaker": math.inf}), "finite"),
        (True, lambda fmu: fmu.set({"mesh.force": 1.0, 10**6: 1.0}), "does not exist"),
        (True, lambda fmu: sized(fmu, 2), "one value for each"),
        (True, lambda fmu: sized(fmu, 0), "one value for each"),
        (True, lambda fmu: fmu.try_get(["casing.velocity_uy"])[1], "not done yet"),
        (False, lambda fmu: fmu.set({"mesh.force": 1.0}), "step is done"),
        (False, lambda fmu: fmu.set({"gear_train.modal_damping": 0.1}), "between steps only"),
        (False, lambda fmu: fmu.try_get([10**6])[1], "does not exist"),
    ],
)
def test_refused_within_a_step(unpacked3, asked, action, words):
    """And nothing changes, not even an input that was given rightly in the same call."""
    status, message, end = act_once(unpacked3, asked, action)
    assert status == ERROR
    assert words in message
    assert end == act_once(unpacked3, asked, None)[2]


def test_an_input_given_twice(unpacked3):
    """The last value counts."""
    twice = act_once(unpacked3, True, lambda fmu: fmu.set({"mesh.force": 50.0}) | fmu.set({"mesh.force": 3.0}))
    once = act_once(unpacked3, True, lambda fmu: fmu.set({"mesh.force": 3.0}))
    assert twice == once
    assert once[2] != act_once(unpacked3, True, None)[2]


def test_the_frequency_moves_as_well(unpacked3, network):
    fmu = Fmu3(unpacked3, intermediate=lambda fmu, _t, asked, _r: asked and fmu.set({"frequency": 800.0}))
    fmu.start()
    assert fmu.step(0.0, 1e-5) == OK
    assert fmu.get(["frequency"])[0] == pytest.approx(800.0, rel=1e-15)
    wanted = oracle.frequency_response(network, 800.0)["alpha"]
    assert fmu.get(["alpha"])[0] == pytest.approx(wanted, rel=1e-9)
    fmu.free()


def test_inputs_of_a_step_that_failed_are_forgotten(unpacked3):
    """They belong to the step: the state is the one before it, but for the age of what is cached."""
    fmu = Fmu3(unpacked3, intermediate=lambda fmu, _t, asked, _r: asked and fmu.set(give))
    fmu.start()
    give = {"mesh.force": 2.0}
    assert fmu.step(0.0, 1e-5) == OK
    before = fmu.serialised()
    give = {"mesh.force": 3.0, "mesh.transmission_error": 1.7e308}
    assert fmu.step(1e-5, 1.0) == ERROR
    assert "overflow" in fmu.messages[-1]
    after = fmu.serialised()
    assert after[32 : AGES.start] == before[32 : AGES.start]
    assert after[AGES.stop :] == before[AGES.stop :]
    assert len(fmu.calls) == 3  # asked, told, asked
    give = {}
    assert fmu.step(1e-5, 1e-5) == OK
    assert fmu.get(["mesh.force", "mesh.transmission_error"]).tolist() == pytest.approx([2.0, 0.0], rel=1e-15)
    fmu.free()
