"""Steps over time against scipy.linalg.expm and python-control: the discretisation is exact."""

from itertools import pairwise

import control
import fmu_oracle as oracle
import numpy as np
import pytest
import scipy.linalg
from fmu_driver import OK, Fmu
from fmu_helpers import export
from fmu_networks import gearbox

SCALES = np.array([1e-6, 100.0, 100.0])  # of the three loads
STEPS = 10_000


def signals(steps, seed=0):
    return np.random.default_rng(seed).normal(size=(steps, len(SCALES))) * SCALES


def names_of(network):
    return [load.name for load in network.loads]


def held(network, U, h):
    """Zero-order hold with expm of the whole step, in numpy."""
    A, B, C, D, names = oracle.time_system(network)
    n, m = B.shape
    E = scipy.linalg.expm(np.block([[A * h, B * h], [np.zeros((m, n + m))]]))
    x, y = np.zeros(n), np.empty((len(U) + 1, len(names)))
    for i, u in enumerate(U):
        y[i] = C @ x + D @ u
        x = E[:n, :n] @ x + E[:n, n:] @ u
    y[-1] = C @ x + D @ U[-1]
    return y, names, x


def error(found, wanted):
    return (np.abs(found - wanted).max(axis=0) / np.abs(wanted).max(axis=0)).max()


@pytest.mark.parametrize("h", [1e-6, 1e-5, 5e-5, 1e-4])
def test_held_inputs(fmu, network, h):
    U = signals(STEPS)
    wanted, names, _ = held(network, U, h)
    assert error(fmu.run(names_of(network), U, h, names), wanted) < 1e-10


@pytest.mark.parametrize("h", [1e-6, 1e-5, 5e-5, 1e-4])
def test_held_inputs_python_control(fmu, network, h):
    U = signals(STEPS, seed=1)
    A, B, C, D, names = oracle.time_system(network)
    sampled = control.sample_system(control.ss(A, B, C, D), h, method="zoh")
    wanted = control.forced_response(sampled, T=np.arange(STEPS) * h, U=U.T).outputs.T
    assert error(fmu.run(names_of(network), U, h, names)[:-1], wanted) < 1e-10


@pytest.mark.parametrize("h", [1e-6, 1e-5, 5e-5, 1e-4])
def test_linear_inputs_python_control(fmu, network, h):
    """With input derivatives the inputs are straight lines over each step, as in python-control."""
    U = signals(2001, seed=2)
    A, B, C, D, names = oracle.time_system(network)
    wanted = control.forced_response(control.ss(A, B, C, D), T=np.arange(len(U)) * h, U=U.T).outputs.T
    slopes = np.diff(U, axis=0) / h
    found = fmu.run(names_of(network), U[:-1], h, names, slopes=slopes)
    # at 1e-4 s it is python-control that is off by 2e-10, see the test in extended precision
    assert error(found, wanted) < 1e-9


@pytest.mark.skipif(np.finfo(np.longdouble).eps > 1e-18, reason="long double is no wider than double here")
@pytest.mark.parametrize("h", [1e-5, 1e-4])
def test_linear_inputs_in_extended_precision(fmu, network, h):
    """Finer than the other references."""
    U = signals(2001, seed=2)
    wanted, names = oracle.first_order_hold(network, U, h)
    found = fmu.run(names_of(network), U[:-1], h, names, slopes=np.diff(U, axis=0) / h)
    assert error(found, wanted) < 2e-12


def test_extrapolated_input_is_held_afterwards(fmu):
    name, h = "actuators.shaker", 1e-4
    assert fmu.set({name: 2.0}) == OK
    assert fmu.set_slopes({name: 1e4}) == OK
    assert fmu.step(0.0, h) == OK
    assert fmu.get([name])[0] == pytest.approx(3.0, rel=1e-15)
    assert fmu.step(h, h) == OK
    assert fmu.get([name])[0] == pytest.approx(3.0, rel=1e-15)
    assert fmu.set_slopes({name: 1e4}) == OK
    assert fmu.set({name: 5.0}) == OK  # in this order as well
    assert fmu.step(2 * h, h) == OK
    assert fmu.get([name])[0] == pytest.approx(6.0, rel=1e-15)


def test_power_is_force_times_receiver_velocity(fmu, network):
    inputs, U = names_of(network), signals(200)
    joint = network.joints[0]
    casing = network.components["casing"]
    # the casing's three rates follow from three velocities of its points
    probes = [o for o in network.outputs if o.quantity == "velocity" and o.name.startswith(("bearing", "casing"))]
    rows = np.array([o.row[casing] for o in probes])
    names = ["bearing_1.power", "bearing_1.force_uy", "bearing_1.force_rx", *(o.name for o in probes)]
    y = fmu.run(inputs, U, 5e-5, names)
    rates = np.linalg.lstsq(rows, y[:, 3:].T, rcond=None)[0]
    expected = ((joint.receiver[:, casing] @ rates) * y[:, 1:3].T).sum(axis=0)
    assert np.abs(y[:, 0] - expected).max() < 1e-9 * np.abs(expected).max()


@pytest.mark.parametrize("h", [1e-3, 0.03, 1.0])
def test_long_steps_settle_to_the_static_solution(fmu, network, h):
    """No instability and no loss of the slow modes: a constant force ends in K^-1 f."""
    force = {"actuators.shaker": 100.0}
    A, B, C, D, names = oracle.time_system(network)
    steps = int(np.ceil(2.0 / h))
    assert fmu.set(force) == OK
    for i in range(steps):
        assert fmu.step(i * h, h) == OK
    u = np.array([0.0, 0.0, 100.0])
    # the modes of the floating source train are rigid: the shaker moves them with the casing
    x = np.linalg.lstsq(A, -B @ u, rcond=None)[0]
    for name in ("casing.displacement_uy", "mount_1.force_uy"):
        i = names.index(name)
        assert fmu.get([name])[0] == pytest.approx((C @ x + D @ u)[i], rel=1e-7)


def test_steps_of_any_size(fmu, network):
    """Variable steps, more kinds than are cached, against numpy."""
    rng = np.random.default_rng(3)
    A, B, C, D, names = oracle.time_system(network)
    sizes = rng.choice([1e-6, 3e-6, 1e-5, 2.5e-5, 7e-5, 1e-4], size=300)
    u, x, t = SCALES, np.zeros(len(A)), 0.0
    maps = {}
    for h in set(sizes):
        n, m = B.shape
        maps[h] = scipy.linalg.expm(np.block([[A * h, B * h], [np.zeros((m, n + m))]]))
    fmu.set(dict(zip(names_of(network), u)))
    for h in sizes:
        assert fmu.step(t, h) == OK
        t += h
        x = maps[h][: len(A), : len(A)] @ x + maps[h][: len(A), len(A) :] @ u
    wanted = C @ x + D @ u
    assert np.abs(fmu.get(names) - wanted).max() <= 1e-10 * np.abs(wanted).max()


def test_jitter_of_the_step_size_does_not_discretise_again(unpacked):
    """Steps computed as t1 - t0: one discretisation, and the log says so."""
    fmu = Fmu(unpacked, logging=1)
    fmu.start(start=3.0)
    grid = 3.0 + np.arange(501) * 1e-5
    for a, b in pairwise(grid):
        assert fmu.step(float(a), float(b - a)) == OK
    assert sum("discretised" in message for message in fmu.messages) == 1
    fmu.free()


def test_parameters_change_during_the_run(fmu, network):
    """Two systems, one state: piecewise against numpy."""
    U, h = signals(1000), 2e-5
    K, C = 0.3 * network.joints[0].stiffness, 2.0 * network.joints[0].damping
    K[0, 1] = K[1, 0] = -0.2 * K[0, 1]
    second = network.with_joint("bearing_1", K, C).with_joint("mount_3", 5e6 * np.ones((1, 1)), np.zeros((1, 1)))
    object.__setattr__(second, "modal_damping", {"gear_train": 0.1})
    y1, names, x = held(network, U[:500], h)
    A, B, Cm, D, _ = oracle.time_system(second)
    # q is continuous, and so is q' = s + X d e, with the input of the moment of the change
    n, m = B.shape
    change = oracle.modal_damping_matrix(network) - oracle.modal_damping_matrix(second)
    x[n // 2 :] += change * network.loads[0].mesh_displacement * U[499, 0]
    E = scipy.linalg.expm(np.block([[A * h, B * h], [np.zeros((m, n + m))]]))
    y2 = []
    for u in U[500:]:
        y2.append(Cm @ x + D @ u)
        x = E[:n, :n] @ x + E[:n, n:] @ u
    y2.append(Cm @ x + D @ U[-1])
    found1 = fmu.run(names_of(network), U[:500], h, names)
    assert error(found1, y1) < 1e-9
    changes = {f"bearing_1.stiffness[{i},{k}]": K[i - 1, k - 1] for i, k in ((1, 1), (1, 2), (2, 2))}
    changes |= {f"bearing_1.damping[{i},{k}]": C[i - 1, k - 1] for i, k in ((1, 1), (1, 2), (2, 2))}
    changes |= {"mount_3.stiffness": 5e6, "mount_3.damping": 0.0, "gear_train.modal_damping": 0.1}
    assert fmu.set(changes) == OK
    found2 = fmu.run(names_of(network), U[500:], h, names, start=500 * h)
    assert error(found2, np.array(y2)) < 1e-9


@pytest.mark.parametrize("zeta", [0.03, 0.0])
def test_a_change_of_modal_damping_moves_nothing_at_rest(fmu, zeta):
    """At rest under a held transmission error: a velocity does not jump with a damping ratio, nor later.

    The steps of 20 us have a fixed point of their own, 1e-7 off by rounding with any damping ratio.
    """
    names = ["sensors.gear", "bearing_1.force_uy", "bearing_3.force_rx", "casing.velocity_uy"]
    fmu.set({"mesh.transmission_error": 1e-6})
    kick = abs(fmu.get(names))
    assert fmu.step(0.0, 1e-3) == OK
    kick = np.maximum(kick, abs(fmu.get(names)))
    assert fmu.step(1e-3, 30.0) == OK  # exact steps: one is enough to come to rest
    rest = fmu.get(names)
    assert fmu.set({"gear_train.modal_damping": zeta}) == OK
    assert (abs(fmu.get(names) - rest) < 1e-9 * kick).all()
    for k in range(50):
        assert (abs(fmu.get(names) - rest) < 1e-5 * kick).all(), k
        assert fmu.step(30.001 + k * 2e-5, 2e-5) == OK


def test_modal_damping_set_before_the_first_step_is_that_of_the_start(unpacked):
    """Reading outputs in between does not matter: the first step starts at rest with all inputs 0."""
    found = []
    for read in (False, True):
        fmu = Fmu(unpacked)
        fmu.start()
        fmu.set({"mesh.transmission_error": 1e-6})
        if read:
            fmu.get(["sensors.gear"])
        fmu.set({"gear_train.modal_damping": 0.1})
        fmu.step(0.0, 1e-5)
        found.append(fmu.get(["sensors.gear", "bearing_1.force_uy"]).tolist())
        fmu.free()
    assert found[0] == found[1]


def test_two_instances_do_not_share_anything(unpacked, network):
    a, b = Fmu(unpacked, name=b"a"), Fmu(unpacked, name=b"b")
    soft = network.with_joint("mount_1", 1e6 * np.ones((1, 1)), network.joints[4].damping)
    for instance in (a, b):
        instance.start()
    assert b.set({"mount_1.stiffness": 1e6}) == OK
    U, h = signals(50), 5e-5
    inputs = names_of(network)
    ya, yb = [], []
    names = held(network, U, h)[1]
    for i, u in enumerate(U):  # interleaved
        for instance, y in ((a, ya), (b, yb)):
            assert instance.set(dict(zip(inputs, u))) == OK
            y.append(instance.get(names))
            assert instance.step(i * h, h) == OK
    assert error(np.array(ya), held(network, U, h)[0][:-1]) < 1e-10
    assert error(np.array(yb), held(soft, U, h)[0][:-1]) < 1e-10
    a.free()
    b.free()


def test_reset_and_run_again_is_bit_identical(fmu, network):
    U, names = signals(300), [o.name for o in network.outputs]
    first = fmu.run(names_of(network), U, 1e-5, names)
    fmu.set({"bearing_1.stiffness[1,1]": 2e8, "gear_train.modal_damping": 0.5, "frequency": 33.0})
    fmu.run(names_of(network), U, 3e-5, names, start=300 * 1e-5)
    assert fmu.call("fmi2Reset") == OK
    fmu.start()
    assert fmu.get(["frequency", "gear_train.modal_damping"]).tolist() == [500.0, 0.015]
    assert np.array_equal(fmu.run(names_of(network), U, 1e-5, names), first)


def test_free_rigid_body_drifts_exactly(tmp_path):
    """Jordan blocks: without stiffness to the ground a constant force gives x = F t^2 / 2 m, for any step."""
    network = gearbox()
    object.__setattr__(network, "modal_damping", {"gear_train": 0.015})
    for joint in network.joints:
        network = network.with_joint(joint.name, 0 * joint.stiffness, 0 * joint.damping)
    fmu = Fmu(Fmu.unpack(export(network, tmp_path / "free.fmu"), tmp_path / "free"))
    for h in (1e-6, 1e-4, 0.1):
        fmu.call("fmi2Reset")
        fmu.start()
        fmu.set({"actuators.shaker": 12.0})
        for i in range(100):
            assert fmu.step(i * h, h) == OK
        rates = fmu.get(["casing.displacement_uy", "casing.velocity_uy", "casing.acceleration_uy"])
        t = 100 * h
        assert rates == pytest.approx([t * t / 2, t, 1.0], rel=1e-11)
    fmu.free()


@pytest.mark.slow
def test_a_thousand_instances(unpacked):
    instances = [Fmu(unpacked, name=str(i).encode()) for i in range(1000)]
    for i, instance in enumerate(instances):
        instance.start()
        assert instance.set({"actuators.shaker": float(i)}) == OK
        assert instance.step(0.0, 1e-4) == OK
    found = np.array([instance.get(["casing.velocity_uy"])[0] for instance in instances])
    assert found == pytest.approx(found[1] * np.arange(1000), rel=1e-12)
    for instance in instances:
        instance.free()


def test_the_oldest_step_size_is_forgotten(unpacked):
    """Four are kept; a fifth takes the place of the one not used for longest."""
    fmu, t = Fmu(unpacked, logging=1), 0.0
    fmu.start()
    for h, formed in [(1, 1), (2, 2), (3, 3), (4, 4), (1, 4), (5, 5), (1, 5), (3, 5), (4, 5), (2, 6), (5, 7)]:
        assert fmu.step(t, h * 1e-5) == OK
        t += h * 1e-5
        assert sum("discretised" in message for message in fmu.messages) == formed, h
    fmu.free()


@pytest.mark.parametrize("names", [["alpha"], ["casing.velocity_uy"], ["gear_train.mode_2.v"]])
def test_reading_changes_nothing(unpacked, names):
    """After a damping ratio was set, and before the next input: the change belongs to the inputs of its own moment."""
    ends = []
    for reads in (False, True):
        fmu = Fmu(unpacked)
        fmu.start()
        assert fmu.set({"mesh.transmission_error": 1e-6}) == OK
        assert fmu.step(0.0, 1e-5) == OK
        for i, zeta in enumerate((0.2, 0.05, 0.015), start=1):
            assert fmu.set({"gear_train.modal_damping": zeta}) == OK
            if reads:
                fmu.get(names)
            assert fmu.set({"mesh.transmission_error": i * 1e-6}) == OK
            assert fmu.step(i * 1e-5, 1e-5) == OK
        ends.append(fmu.get(list(fmu.reference)).tolist())
        fmu.free()
    assert ends[0] == ends[1]


def test_inputs_and_parameters_of_one_call_have_no_order(unpacked):
    ends = []
    for order in (1, -1):
        fmu = Fmu(unpacked)
        fmu.start()
        assert fmu.set({"mesh.transmission_error": 1e-6}) == OK
        assert fmu.step(0.0, 1e-5) == OK
        values = {"mesh.transmission_error": 3e-6, "gear_train.modal_damping": 0.2}
        assert fmu.set(dict(list(values.items())[::order])) == OK
        ends.append(fmu.get(list(fmu.reference)).tolist())
        fmu.free()
    assert ends[0] == ends[1]


@pytest.mark.parametrize("start", [0.0, 1e6, 1e9])
def test_late_times_keep_step_sizes_apart(unpacked, network, start):
    """At 1e9 s doubles are 1e-7 s apart; steps of 1 and 2 us (powers of 2, exact there) are still told apart."""
    fmu, sizes = Fmu(unpacked), [2.0**-19, 2.0**-20] * 20
    fmu.start(start=start)
    assert fmu.set({"mesh.force": 100.0}) == OK
    t = start
    for h in sizes:
        assert fmu.step(t, h) == OK, fmu.messages
        t += h
    A, B, C, D, names = oracle.time_system(network)
    x = np.zeros(len(A))
    u = np.array([100.0 if load.name == "mesh.force" else 0.0 for load in network.loads])
    for h in sizes:
        E = scipy.linalg.expm(np.block([[A * h, B * h], [np.zeros((3, len(A) + 3))]]))
        x = E[: len(A), : len(A)] @ x + E[: len(A), len(A) :] @ u
    found, wanted = fmu.get(names), C @ x + D @ u
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-9 * np.abs(wanted).max())
    fmu.free()
