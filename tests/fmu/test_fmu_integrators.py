"""Integrators at work on the model exchange of both versions of FMI."""

import fmu_oracle as oracle
import numpy as np
import scipy.integrate
import scipy.linalg
from fmu_networks import C2, CHANGES, K2

INPUTS = ["mesh.transmission_error", "mesh.force", "actuators.shaker"]
LEVELS = np.array([1e-6, 30.0, 50.0])


def held(A, B, u, x, t):
    n, m = B.shape
    E = scipy.linalg.expm(np.block([[A * t, B * t], [np.zeros((m, n + m))]]))
    return E[:n, :n] @ x + E[:n, n:] @ u


def integrate(me, start, stop, x, forces=None, rtol=1e-10):
    """scipy's DOP853 through the C functions, with inputs `forces(t)` if given."""

    def slope(t, state):
        me.ok("SetTime", t)
        if forces is not None:
            me.set(dict(zip(INPUTS, forces(t))))
        me.states = state
        return me.derivatives

    nominals = me.vector("GetNominalsOfContinuousStates")
    found = scipy.integrate.solve_ivp(slope, (start, stop), x, "DOP853", rtol=rtol, atol=1e-3 * rtol * nominals)
    assert found.success
    slope(stop, found.y[:, -1])
    return found.y[:, -1]


def close(found, wanted, scale, tolerance):
    assert np.abs((found - wanted) / scale).max() <= tolerance * np.abs(wanted / scale).max()


def test_an_integrator_reaches_the_exact_solution(me, network):
    """Held inputs, a bearing that is exchanged on the way, against matrix exponentials of the two systems."""
    nominals, t1, t2 = me.vector("GetNominalsOfContinuousStates"), 1e-4, 2e-4
    me.set(dict(zip(INPUTS, LEVELS)))
    x = integrate(me, 0.0, t1, np.zeros(me.n))
    A, B, C, D, names = oracle.scaled_time_system(network)
    exact = held(A, B, LEVELS, np.zeros(me.n), t1)
    close(x, exact, nominals, 1e-8)
    me.ok("EnterEventMode")
    me.set({"bearing_1.stiffness": K2, "bearing_1.damping": C2})
    assert me.update() is False
    me.ok("EnterContinuousTimeMode")
    x = integrate(me, t1, t2, me.states)
    A, B, C, D, names = oracle.scaled_time_system(network.with_joint("bearing_1", K2, C2))
    exact = held(A, B, LEVELS, exact, t2 - t1)
    close(x, exact, nominals, 1e-8)
    y = C @ exact + D @ LEVELS
    size = np.abs(C) @ np.abs(exact) + np.abs(D) @ LEVELS
    assert (np.abs(me.fmu.get(names) - y) <= 1e-8 * size).all()
    if me.version == 3:
        assert me.fmu.get(["time"])[0] == t2


def test_inputs_over_time(me, network):
    """Sines, against the exponential of the system with an oscillator added."""
    w, stop = 2 * np.pi * 3000.0, 1e-4
    x = integrate(me, 0.0, stop, np.zeros(me.n), lambda t: LEVELS * np.sin(w * t))
    A, B, *_ = oracle.scaled_time_system(network)
    drive = np.column_stack([B @ LEVELS, np.zeros(me.n)])
    M = np.block([[A, drive], [np.zeros((2, me.n)), np.array([[0.0, w], [-w, 0.0]])]])
    exact = scipy.linalg.expm(M * stop) @ np.concatenate([np.zeros(me.n), [0.0, 1.0]])
    close(x, exact[: me.n], me.vector("GetNominalsOfContinuousStates"), 1e-8)


def test_reset_and_run_again_is_bit_identical(me):
    first = integrate(me, 0.0, 2e-5, np.zeros(me.n), lambda t: LEVELS * (1 + t))
    end = me.fmu.serialised()
    me.ok("EnterEventMode")
    me.set(CHANGES | {"frequency": 77.0})
    me.update()
    me.ok("EnterContinuousTimeMode")
    integrate(me, 2e-5, 3e-5, me.states)
    me.ok("Reset")
    me.fmu.enter("continuous")
    assert np.array_equal(integrate(me, 0.0, 2e-5, np.zeros(me.n), lambda t: LEVELS * (1 + t)), first)
    assert me.fmu.serialised() == end
