"""FMI 3 co-simulation: the same doubles as FMI 2, any step size, and runs that repeat themselves."""

import numpy as np
import pytest
from fmi3_driver import Fmu3
from fmu_driver import OK, Fmu

INPUTS = ["mesh.transmission_error", "mesh.force", "actuators.shaker"]


def signals(steps, seed=0):
    return np.random.default_rng(seed).normal(size=(steps, 3)) * [1e-6, 100.0, 100.0]


def names_of(network):
    return [output.name for output in network.outputs]


def run(fmu, U, h, names, start=0.0):
    y = []
    for i, u in enumerate(U):
        assert fmu.set(dict(zip(INPUTS, u))) == OK
        y.append(fmu.get(names))
        assert fmu.step(start + i * h, h) == OK, fmu.messages
    return np.array([*y, fmu.get(names)])


@pytest.mark.parametrize("h", [1e-6, 1e-5, 1e-4])
def test_both_versions_give_the_same_doubles(fmu, fmu3, network, h):
    """Also after a joint was changed, when the propagator is a dense one."""
    names, U = [*names_of(network), "alpha", "frf.casing.velocity_uy.re"], signals(100)
    assert np.array_equal(run(fmu, U, h, names), run(fmu3, U, h, names))
    K = 0.4 * network.joints[2].stiffness
    assert fmu.set({f"bearing_3.stiffness[{i + 1},{k + 1}]": K[i, k] for i, k in ((0, 0), (0, 1), (1, 1))}) == OK
    assert fmu3.set({"bearing_3.stiffness": K}) == OK
    two, three = run(fmu, U, h, names, 100 * h), run(fmu3, U, h, names, 100 * h)
    assert np.array_equal(two, three)
    states = [v.name for v in fmu.unpacked.description.modelVariables if v.causality == "local" and not v.derivative]
    assert np.array_equal(fmu.get(states), fmu3.get(["state"]))


def test_reset_and_run_again_is_bit_identical(fmu3, network):
    names, U = names_of(network), signals(200)
    first = run(fmu3, U, 1e-5, names)
    end = fmu3.serialised()
    fmu3.set({"bearing_1.stiffness": np.diag([2e8, 1e4]), "gear_train.modal_damping": 0.5, "frequency": 33.0})
    run(fmu3, U, 3e-5, names, start=200 * 1e-5)
    assert fmu3.call("fmi3Reset") == OK
    fmu3.start()
    assert fmu3.get(["frequency", "gear_train.modal_damping", "time"]).tolist() == [500.0, 0.015, 0.0]
    assert np.array_equal(run(fmu3, U, 1e-5, names), first)
    assert fmu3.serialised() == end


def test_clock_over_many_steps(fmu3):
    """The importer may multiply or accumulate its times."""
    h, t = 1e-6, 0.0
    for _ in range(5000):
        assert fmu3.step(t, h) == OK
        t += h
    assert t != 5000 * h
    assert fmu3.step(5000 * h, h) == OK


def test_both_interfaces_and_versions_in_one_process(unpacked, unpacked3):
    """Four instances side by side share nothing."""
    stepping = [Fmu(unpacked), Fmu3(unpacked3)]
    exchange = [Fmu(unpacked, kind=0), Fmu3(unpacked3, exchange=True)]
    for k, instance in enumerate((*stepping, *exchange)):
        instance.set({"mesh.force": float(k)})
        instance.enter("stepping" if instance in stepping else "continuous")
    for i in range(10):
        for instance in stepping:
            assert instance.step(i * 1e-5, 1e-5) == OK
    two, three = (instance.get(["casing.velocity_uy", "mesh.force"]) for instance in stepping)
    assert two.tolist() == [0.0, 0.0]
    assert three[0] != 0
    for k, instance in enumerate(exchange, start=2):
        assert instance.get(["casing.velocity_uy", "mesh.force"]).tolist() == [0.0, float(k)]
    for instance in (*stepping, *exchange):
        instance.free()
