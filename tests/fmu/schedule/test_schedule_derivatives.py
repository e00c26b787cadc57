"""Directional and adjoint derivatives by the torque, against matrices assembled by hand and differences."""

import fmu_oracle as oracle
import numpy as np
import pytest
from fmu_driver import ERROR, OK, reals
from fmu_tangent import LEVELS, Tangent
from schedule_machine import SCALE, START, TORQUE, TORQUES, interpolated

EITHER = pytest.mark.parametrize(
    ("version", "exchange"), [(2, False), (2, True), (3, False), (3, True)], ids=["cs2", "me2", "cs3", "me3"]
)
BOTH = pytest.mark.parametrize("version", [2, 3])
# Torque, and the points between which the derivative is taken: at a point the interval above it, none beyond the ends.
PLACES = [(START, 1), (11.0, 0), (10.0, 0), (25.0, 1), (40.0, 2), (99.0, 2), (100.0, None), (130.0, None), (9.0, None)]


def at(fmus, version, *, exchange=False, torque=START):
    """States and inputs that are not zero, in initialisation, and the vectors that the oracle takes."""
    it = Tangent(fmus[version], exchange=exchange)
    it.inputs = list(LEVELS)
    it.moved()
    it.fmu.enter("initialization")
    assert it.fmu.set({TORQUE: torque}) == OK
    return it, it.fmu.get(it.states), it.fmu.get(it.inputs)


def slope_of_matrices(network, place):
    """d/dT of A, B, C, D, which are linear in the matrices of the joints: exact within an interval."""
    low, high = (TORQUES[place], TORQUES[place + 1]) if place is not None else (1e3, 2e3)
    ends = [oracle.scaled_time_system(interpolated(network, torque)) for torque in (low, high)]
    return [(after - before) / (high - low) for before, after in zip(*(end[:4] for end in ends))]


@EITHER
@pytest.mark.parametrize(("torque", "place"), PLACES)
def test_time_outputs_and_state_derivatives(fmus, scheduled, version, exchange, torque, place):
    it, x, u = at(fmus, version, exchange=exchange, torque=torque)
    names = oracle.scaled_time_system(scheduled)[4]
    dA, dB, dC, dD = slope_of_matrices(scheduled, place)
    found = it.along([*it.derivatives, *names], [TORQUE], [1.0])
    wanted = np.concatenate([dA @ x + dB @ u, dC @ x + dD @ u])
    size = np.concatenate([np.abs(dA) @ np.abs(x) + np.abs(dB) @ np.abs(u), np.abs(dC) @ np.abs(x)])
    size[54:] += np.abs(dD) @ np.abs(u)
    assert (np.abs(found - wanted) <= 1e-11 * size).all()
    assert (np.count_nonzero(found) > 0) == (place is not None)
    # together with a state and an input: what the sum rule says
    both = it.along([*it.derivatives, *names], [TORQUE, "mesh.force"], [2.0, 3.0])
    alone = it.along([*it.derivatives, *names], ["mesh.force"], [3.0])
    assert both == pytest.approx(2.0 * found + alone, rel=1e-10, abs=1e-12 * np.abs(both).max())
    it.fmu.free()


@EITHER
def test_powers_and_ports(fmus, version, exchange):
    """Linear in the torque within an interval, so that wide differences are exact."""
    it, _, _ = at(fmus, version, exchange=exchange)
    unknowns = [n for n in it.over_time if n.endswith((".power", ".force", ".velocity"))]
    found, wanted = it.along(unknowns, [TORQUE], [1.0]), it.difference(unknowns, TORQUE, 1.0, 3.0)
    kinds = it.kinds(unknowns)
    for kind in np.unique(kinds):
        of = kinds == kind
        assert np.abs(found[of] - wanted[of]).max() <= 1e-11 * np.abs(it.fmu.get(unknowns)[of]).max(), kind
    assert np.count_nonzero(found) >= 2
    it.fmu.free()


@BOTH
@pytest.mark.parametrize("torque", [START, 80.0, 10.0])
def test_outputs_over_frequency(fmus, scheduled, version, torque):
    """Against differences of one dense solve; at a point on the side above it."""
    it, _, _ = at(fmus, version, torque=torque)
    names = it.over_frequency
    hertz, h = 640.0, 1e-3
    assert it.fmu.set({"frequency": hertz}) == OK
    assert it.fmu.set({TORQUE: torque}) == OK

    def response(offset):
        found = oracle.frequency_response(interpolated(scheduled, torque + offset), hertz)
        return np.array([found[n] for n in names])

    if torque == TORQUES[0]:
        v = [response(k * h) for k in range(5)]
        wanted = (-25 * v[0] + 48 * v[1] - 36 * v[2] + 16 * v[3] - 3 * v[4]) / (12 * h)
    else:
        wanted = (response(-2 * h) - 8 * response(-h) + 8 * response(h) - response(2 * h)) / (12 * h)
    found, kinds, values = it.along(names, [TORQUE], [1.0]), it.kinds(names), np.abs(it.fmu.get(names))
    for kind in np.unique(kinds):
        of = kinds == kind
        size = 1e-6 * np.abs(wanted[of]).max() + 1e-11 * values[of].max() / h
        assert np.abs(found[of] - wanted[of]).max() <= size, kind
        assert np.abs(wanted[of]).max() > 100 * size  # so that it is no comparison of rounding
    both = it.along(names, [TORQUE, "frequency"], [0.5, 2.0])
    parts = 0.5 * found + 2.0 * it.along(names, ["frequency"], [1.0])
    assert both == pytest.approx(parts, rel=1e-9, abs=1e-9 * np.abs(parts).max())
    it.fmu.free()


@pytest.mark.parametrize("exchange", [False, True], ids=["cs", "me"])
def test_adjoint_is_the_transpose(fmus, exchange):
    it, _, _ = at(fmus, 3, exchange=exchange)
    matrices = [f"system.{name}" for name in "ABCD"]
    unknowns = [*it.outputs, *it.derivatives, *matrices, "bearing_1.stiffness", "bearing_2.damping"]
    knowns = [TORQUE, *it.inputs, "frequency", "bearing_3.stiffness", "bearing_1.damping", "state"]
    J = it.jacobian(unknowns, knowns)
    assert np.count_nonzero(J[:, 0]) > 100
    weights = np.random.default_rng(1).normal(size=len(J))
    found = it.adjoint(unknowns, knowns, weights)
    assert (np.abs(found - weights @ J) <= 1e-12 * (np.abs(weights) @ np.abs(J))).all()
    it.fmu.free()


def test_the_matrices_themselves(fmus, scheduled):
    """A, B, C, D and the scheduled matrices as unknowns."""
    it, _, _ = at(fmus, 3)
    wanted = slope_of_matrices(scheduled, 1)
    for name, slope in zip("ABCD", wanted):
        found = it.along([f"system.{name}"], [TORQUE], [1.0]).reshape(slope.shape)
        assert np.abs(found - slope).max() <= 1e-10 * np.abs(slope).max(), name  # B is large beside its slope
        assert np.abs(slope).max() > 0
    table = scheduled.schedule.stiffness["bearing_1"]
    slope = (table[2] - table[1]) / (TORQUES[2] - TORQUES[1])
    found = it.along(["bearing_1.stiffness"], [TORQUE], [1.0]).reshape(2, 2)
    assert np.abs((found - slope) / np.outer(SCALE, SCALE)).max() < 1e-14
    it.fmu.free()


@BOTH
def test_no_derivative_by_what_follows(fmus, version):
    it, _, _ = at(fmus, version)
    known = it.fmu.references(["bearing_1.stiffness" if version == 3 else "bearing_1.stiffness[1,1]"])
    unknown, one = it.fmu.references(["bearing_1.force_uy"]), reals([1.0] * 4)
    arguments = [unknown, 1, known, 1, one, 4, one, 1] if version == 3 else [unknown, 1, known, 1, one, one]
    assert it.fmu.call(f"fmi{version}GetDirectionalDerivative", *arguments) == ERROR
    assert "take the derivative by that" in it.fmu.messages[-1]
    it.fmu.free()
