"""Model exchange in both versions of FMI: states, derivatives, and parameters that change in event mode."""

import ctypes as ct
import math

import fmu_oracle as oracle
import numpy as np
import pytest
from fmi3_driver import Fmu3
from fmu_driver import ERROR, Fmu, reals
from fmu_exchange import Exchange
from fmu_networks import C2, CHANGES, K2, changed

INPUTS = ["mesh.transmission_error", "mesh.force", "actuators.shaker"]
LEVELS = np.array([1e-6, 30.0, 50.0])


def random_state(it, seed=0):
    return np.random.default_rng(seed).normal(size=it.n) * it.vector("GetNominalsOfContinuousStates")


def test_derivatives_and_outputs(me, network):
    """x' = A x + B u and y = C x + D u, also after parameters were changed in event mode."""
    for system in (network, changed(network)):
        A, B, C, D, names = oracle.scaled_time_system(system)
        x = random_state(me)
        me.states = x
        me.set(dict(zip(INPUTS, LEVELS)))
        assert np.array_equal(me.states, x)
        size = np.abs(A) @ np.abs(x) + np.abs(B) @ LEVELS
        assert (np.abs(me.derivatives - (A @ x + B @ LEVELS)) <= 1e-13 * size).all()
        size = np.abs(C) @ np.abs(x) + np.abs(D) @ LEVELS
        assert (np.abs(me.fmu.get(names) - (C @ x + D @ LEVELS)) <= 1e-13 * size).all()
        me.ok("EnterEventMode")
        me.set(CHANGES)
        me.update()
        me.ok("EnterContinuousTimeMode")


def test_nominals_are_those_of_the_description(me):
    nominals = me.vector("GetNominalsOfContinuousStates")
    assert (nominals > 0).all()
    variables = me.fmu.unpacked.description.modelVariables
    if me.version == 2:
        written = [float(v.nominal) for v in variables if v.causality == "local" and v.derivative is None]
        assert nominals.tolist() == written
    else:
        assert float(me.fmu.variables["state"].nominal) == nominals.max()


def test_joints_may_change_in_event_mode(me):
    """K and C: neither states nor velocities jump, and the forces do."""
    me.set(dict(zip(INPUTS, LEVELS)))
    me.states = random_state(me)
    kept, forces = ["casing.velocity_uy", "sensors.gear", "casing.displacement_uy"], ["bearing_1.force_uy"]
    x, y, f = me.states, me.fmu.get(kept), me.fmu.get(forces)
    me.ok("EnterEventMode")
    me.set({"bearing_1.stiffness": K2, "bearing_1.damping": C2})
    assert me.update() is False
    assert np.array_equal(me.states, x)
    assert np.array_equal(me.fmu.get(kept), y)
    assert abs(me.fmu.get(forces) / f - 1) > 0.01


def test_modal_damping_may_change_in_event_mode(me, network):
    """A velocity q' = s + X d e cannot jump with a damping ratio: the states say that they have changed, once."""
    me.set(dict(zip(INPUTS, LEVELS)))
    me.states = random_state(me)
    kept = ["casing.velocity_uy", "sensors.gear", "casing.displacement_uy"]
    x, y = me.states, me.fmu.get(kept)
    me.ok("EnterEventMode")
    me.set({"gear_train.modal_damping": 0.2})
    assert me.update() is True
    assert me.update() is False
    assert me.fmu.get(kept) == pytest.approx(y, rel=1e-12)
    rate = 2 * (0.015 - 0.2) * np.sqrt(network.eigenvalues[:24]) * network.loads[0].mesh_displacement[:24] * LEVELS[0]
    assert me.states - x == pytest.approx(np.concatenate([np.zeros(27), rate, np.zeros(3)]), rel=1e-9, abs=1e-12)
    me.ok("EnterContinuousTimeMode")
    me.ok("EnterEventMode")
    assert me.update() is False


def test_before_time_passes_nothing_jumps(unpacked, unpacked3):
    """In the first event mode the states are start values, whatever the inputs and the damping."""
    for it in (Exchange(Fmu(unpacked, kind=0), 2), Exchange(Fmu3(unpacked3, exchange=True), 3)):
        it.set(dict(zip(INPUTS, LEVELS)))
        it.fmu.enter("event")
        it.set({"gear_train.modal_damping": 0.2})
        assert it.update() is False
        assert (it.states == 0).all()
        it.fmu.free()


def test_states_that_are_refused(me):
    me.states = x = random_state(me)
    before = me.fmu.serialised()
    for bad in (math.nan, math.inf):
        assert me.call("SetContinuousStates", reals([*x[:-1], bad]), me.n) == ERROR
        assert "not a finite number" in me.fmu.messages[-1]
    for count in (0, me.n - 1, me.n + 1, 2**63):
        getters = ("GetContinuousStates", me.names["derivatives"], "GetNominalsOfContinuousStates")
        for function in ("SetContinuousStates", *getters):
            room = reals([9.0] * (me.n + 1))
            assert me.call(function, room, count) == ERROR
            assert "number of continuous states" in me.fmu.messages[-1]
            assert list(room) == [9.0] * (me.n + 1)
    for bad in (math.nan, -math.inf):
        assert me.call("SetTime", bad) == ERROR
        assert "finite" in me.fmu.messages[-1]
    assert me.fmu.serialised() == before


def test_derivatives_that_overflow_are_refused(me):
    me.states = np.full(me.n, 1e308)
    assert me.call(me.names["derivatives"], (ct.c_double * me.n)(), me.n) == ERROR
    assert "overflows" in me.fmu.messages[-1]
    me.states = np.zeros(me.n)
    assert (me.derivatives == 0).all()


def test_a_state_is_a_variable_too(me):
    """In continuous-time mode it may be set as one (FMI 2.0.1, condition 5 of 3.2.3)."""
    me.states = x = random_state(me)
    name = {2: "gear_train.mode_3.v", 3: "state"}[me.version]
    x[27 + 2] = 4.25
    me.set({name: 4.25 if me.version == 2 else x})
    assert np.array_equal(me.states, x)
    assert me.fmu.get([name]).tolist() == ([4.25] if me.version == 2 else x.tolist())


def test_integrator_steps_need_nothing(me):
    flags = (ct.c_int * 2)(7, 7) if me.version == 2 else (ct.c_bool * 2)(True, True)
    size = ct.sizeof(flags) // 2
    me.ok("CompletedIntegratorStep", True, ct.byref(flags), ct.byref(flags, size))
    assert list(flags) == [0, 0]
    me.ok("GetEventIndicators", None, 0)
    assert me.call("GetEventIndicators", (ct.c_double * 1)(), 1) == ERROR
