"""Torque that changes in a running FMU, against python-control and against matrices assembled by hand."""

import fmu_oracle as oracle
import numpy as np
import pytest
import scipy.linalg
from fmu_driver import ERROR, OK
from fmu_exchange import Exchange
from fmu_networks import C2
from fmu_piecewise import Piece, Stepper, is_modal, simulate
from schedule_machine import START, TORQUE, interpolated, new, read_matrix

BOTH = pytest.mark.parametrize("version", [2, 3])
COURSE = [START, 60.0, 25.0, 700.0, -3.0, 39.999, START, 100.0]  # in between, points, beyond both ends, the start again
LENGTH = 25
INPUTS = ["mesh.transmission_error", "mesh.force", "actuators.shaker"]


def signals(count, seed=3):
    return np.random.default_rng(seed).normal(size=(count, 3)) * [1e-6, 1.0, 1.0]


def deviation(found, wanted):
    size = np.abs(wanted).max(axis=0)
    assert (found[:, size == 0] == 0).all()
    return np.max(np.abs(found - wanted)[:, size > 0] / size[size > 0])


@BOTH
@pytest.mark.parametrize("linear", [False, True], ids=["held", "linear"])
@pytest.mark.parametrize("h", [5e-6, 3e-5])
def test_co_simulation(fmus, scheduled, version, linear, h):
    """Every output, powers too, while the torque jumps; python-control goes on with the other system's state."""
    pieces = [Piece(interpolated(scheduled, torque)) for torque in COURSE]
    u = signals(LENGTH * len(COURSE) + 1)
    wanted, names = simulate(pieces, [LENGTH] * len(COURSE), u, h, linear=linear), pieces[0].names
    it = Stepper(fmus[version])
    changes = {LENGTH * k: {TORQUE: torque} for k, torque in enumerate(COURSE) if k}
    found = it.run(INPUTS, u, h, names, changes, linear=linear)
    assert deviation(found, wanted) < 1e-9
    apart = simulate(pieces[:1], [len(u) - 1], u, h, linear=linear)
    assert deviation(found, apart) > 1e-2  # the torque matters at all
    it.fmu.free()


@BOTH
def test_by_exponentials_assembled_by_hand(fmus, scheduled, version):
    """Held inputs, nothing of ours in the oracle: x(t + h) of each torque's own matrices by scipy."""
    h, u, x, wanted = 2e-5, signals(40), None, []
    it = Stepper(fmus[version])
    course = np.repeat([12.0, 77.0], 20)
    for i, torque in enumerate(course):
        A, B, C, D, names = oracle.scaled_time_system(interpolated(scheduled, torque))
        n, m = B.shape
        x = np.zeros(n) if x is None else x
        wanted.append(C @ x + D @ u[i])
        if i in (0, 20):
            E = scipy.linalg.expm(np.block([[A * h, B * h], [np.zeros((m, n + m))]]))
        x = E[:n, :n] @ x + E[:n, n:] @ u[i]
    found = it.run(INPUTS, u, h, names, {0: {TORQUE: 12.0}, 20: {TORQUE: 77.0}}, linear=False)
    assert deviation(found, np.array(wanted)) < 1e-9
    it.fmu.free()


@BOTH
def test_the_modal_form_at_the_start_torque(fmus, version):
    """The cheap form of a step belongs to the start torque, and comes back with it, whatever was in between."""
    fmu, t = new(fmus[version], version), 0.0
    for torque in (START, 60.0, START, 1e6, START):
        assert fmu.set({TORQUE: torque}) == OK
        assert fmu.step(t, 1e-5) == OK
        t += 1e-5
        assert is_modal(fmu.serialised()) == (torque == START)
    fmu.free()


@BOTH
def test_a_slope_counts_from_the_end_of_the_step(fmus, version):
    """The torque is held over the step, and is then what the slope (FMI 3: the value for the end) says: bit for bit."""
    u, course = signals(30), np.linspace(15.0, 90.0, 31)
    found = []
    for sloping in (False, True):
        it = Stepper(fmus[version])
        it.fmu.set({TORQUE: course[0]})
        names = [*INPUTS, "bearing_1.force_uy", "bearing_2.power", "casing.acceleration_uy", "alpha", TORQUE]
        rows = []
        for i in range(len(u)):
            it.set(dict(zip(INPUTS, u[i])))
            if not sloping:
                it.set({TORQUE: course[i]})
            elif version == 2:
                assert it.fmu.set_slopes({TORQUE: (course[i + 1] - course[i]) / 1e-5}) == OK
            else:
                it.ends = {TORQUE: course[i + 1]}
            assert it.fmu.step(i * 1e-5, 1e-5) == OK
            if not sloping:
                it.set({TORQUE: course[i + 1]})
            rows.append(it.fmu.get(names))
        found.append(np.array(rows))
        it.fmu.free()
    assert np.abs(found[0] - found[1]).max(axis=0) / np.abs(found[0]).max(axis=0) == pytest.approx(0.0, abs=1e-11)


@BOTH
def test_model_exchange_follows_at_once(fmus, scheduled, version):
    """x' = A(T) x + B(T) u in continuous-time mode, without an event, at states and inputs that are not zero."""
    fmu = new(fmus[version], version, exchange=True)
    it, rng = Exchange(fmu, version), np.random.default_rng(5)
    nominal = it.vector("GetNominalsOfContinuousStates")
    for torque in (START, 11.0, 40.0, 99.0, 250.0, 0.0, START):
        A, B, C, D, names = oracle.scaled_time_system(interpolated(scheduled, torque))
        x, u = nominal * rng.normal(size=54), signals(1, 8)[0]
        it.set({TORQUE: torque} | dict(zip(INPUTS, u)))
        it.states = x
        terms = np.abs(A) @ np.abs(x) + np.abs(B) @ np.abs(u)
        assert (np.abs(it.derivatives - (A @ x + B @ u)) <= 1e-12 * terms).all()
        terms = np.abs(C) @ np.abs(x) + np.abs(D) @ np.abs(u)
        assert (np.abs(fmu.get(names) - (C @ x + D @ u)) <= 1e-12 * terms).all()
        before = it.states
        it.set({TORQUE: torque + 1.0})
        assert (it.states == before).all()
    fmu.free()


@BOTH
def test_beside_tunable_parameters(fmus, scheduled, version):
    """Torque, another bearing and the damping of a joint whose stiffness follows change at once."""
    base = interpolated(scheduled, 80.0)
    joint = base.joints[0]
    other = base.with_joint("bearing_1", joint.stiffness, C2).with_joint("bearing_4", 2 * joint.stiffness, C2)
    pieces, u = [Piece(interpolated(scheduled, START)), Piece(other)], signals(61)
    wanted, names = simulate(pieces, [30, 30], u, 1e-5, linear=False), pieces[0].names
    it = Stepper(fmus[version])
    change = {
        TORQUE: 80.0,
        "bearing_4.stiffness": 2 * joint.stiffness,
        "bearing_1.damping": C2,
        "bearing_4.damping": C2,
    }
    found = it.run(INPUTS, u, 1e-5, names, {30: change}, linear=False)
    assert deviation(found, wanted) < 1e-9
    it.fmu.free()


def test_indefinite_damping_does_not_stop_the_stiffness(fmus, scheduled):
    """The entry is taken back with a sentence; the stiffness of the same joint follows all the same."""
    fmu = new(fmus[2], 2)
    before = read_matrix(fmu, 2, "bearing_1.damping")
    assert fmu.set({"bearing_1.damping[1,2]": 1e6, TORQUE: 77.0}) == OK
    assert fmu.step(0.0, 1e-5) == ERROR
    assert "damping matrix of bearing_1 is not positive semidefinite" in fmu.messages[-1]
    assert (read_matrix(fmu, 2, "bearing_1.damping") == before).all()
    K = interpolated(scheduled, 77.0).joints[0].stiffness
    assert read_matrix(fmu, 2, "bearing_1.stiffness") == pytest.approx(K, rel=1e-14)
    assert fmu.step(0.0, 1e-5) == OK
    fmu.free()


def test_overflowing_slopes_are_refused(fmus):
    fmu = new(fmus[2], 2)
    assert fmu.set_slopes({TORQUE: 1e308}) == OK
    assert fmu.step(0.0, 1e3) == ERROR
    assert "overflows within this step" in fmu.messages[-1]
    assert fmu.get([TORQUE]).tolist() == [START]
    fmu.free()
