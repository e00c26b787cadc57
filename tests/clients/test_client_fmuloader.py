"""fmuloader: every function of FMI 2 and 3 by itself; co-simulation, model exchange, state, derivatives.

Of FMI 3 it writes arrays but reads none: `get_float64` and the sensitivities of the derivatives have room for one value
a reference. So matrices are seen through the state (`get_continuous_states` and its like take their length) and through
seeds, which may be arrays. Its `instantiate_co_simulation` keeps no reference to the callback of the intermediate
update (`iu_cb` is local there), which must therefore not be given: interpolation is tested in FMI 2 only.
"""

import numpy as np
import pytest
from client_models import bearing_entries, bearing_matrices, other_bearing
from client_packages import client
from client_reference import LOADS, WATCHED, Steps, Tones, check, held, interpolated
from scipy.integrate import solve_ivp

import gearpath as gp

client("fmuloader")

from fmuloader.fmi3 import Fmi3Error  # noqa: E402
from fmuloader_gearbox import running  # noqa: E402

STEPS = Steps.random(2e-5, 250)
LIMIT = 1e-10  # the deviation found is 3e-12
ENTRIES = 1e-12  # of matrices: the deviation found is rounding
NAMES = ("A", "B", "C", "D")


@pytest.fixture
def run(fmu, fmi, tmp_path):
    return lambda **settings: running(fmu, fmi, tmp_path, **settings)


@pytest.fixture
def other(fmi):
    """The parameters of the other bearing."""
    return bearing_entries() if fmi == "2.0" else bearing_matrices()


def steps_of(gearbox, first=0, last=None):
    """Do the steps; rows of outputs at the end of each."""
    rows = []
    for time, loads in list(zip(STEPS.times, STEPS.loads))[first:last]:
        gearbox.set(dict(zip(LOADS, loads)))
        gearbox.own.do_step(time, STEPS.step)
        rows.append(gearbox.get(WATCHED))
    return rows


def named(rows):
    return dict(zip(WATCHED, np.array(rows).T))


def same(matrix, expected):
    np.testing.assert_allclose(matrix, expected, rtol=0.0, atol=ENTRIES * np.max(np.abs(expected)))


def test_co_simulation(gearbox, run):
    with run() as instance:
        check(named(steps_of(instance)), held(gearbox, STEPS), LIMIT)


def test_another_bearing_before_the_run(gearbox, run, other):
    with run(start=other) as instance:
        check(named(steps_of(instance)), held(other_bearing(gearbox), STEPS), LIMIT)


def test_reset(gearbox, run, other):
    """After a reset it is as new: parameters, state, inputs."""
    with run(start=other) as instance:
        steps_of(instance, last=20)
        instance.own.reset()
        instance.initialise({})
        check(named(steps_of(instance)), held(gearbox, STEPS), LIMIT)


def test_interpolated_loads(gearbox, exported, tmp_path):
    """FMI 2: the inputs' first derivatives."""
    loads = np.vstack([np.zeros(2), STEPS.loads])
    rows = []
    with running(exported["2.0"], "2.0", tmp_path) as instance:
        inputs = [instance.references[name] for name in LOADS]
        for k, time in enumerate(STEPS.times[:-1]):
            instance.own.set_real(inputs, loads[k].tolist())
            instance.own.set_real_input_derivatives(inputs, [1, 1], ((loads[k + 1] - loads[k]) / STEPS.step).tolist())
            instance.own.do_step(time, STEPS.step)
            rows.append(instance.get(WATCHED))
    check(named(rows), interpolated(gearbox, STEPS.times, loads), LIMIT)


def test_state_is_taken_back_and_carried_on(run, other):
    """From a stored state the same steps give the same doubles, in this instance and in another."""
    half = len(STEPS.loads) // 2
    with run(start=other) as instance:
        steps_of(instance, last=half)
        state = instance.own.get_fmu_state()
        blob = instance.own.serialize_fmu_state(state)
        straight = steps_of(instance, first=half)
        instance.own.set_fmu_state(state)
        assert steps_of(instance, first=half) == straight
        instance.own.free_fmu_state(state)
    with run() as fresh:  # the parameters come with the state
        state = fresh.own.deserialize_fmu_state(blob)
        fresh.own.set_fmu_state(state)
        fresh.own.free_fmu_state(state)
        assert steps_of(fresh, first=half) == straight


def test_model_exchange(gearbox, run):
    """Smooth loads at every evaluation, integrated by scipy's DOP853; the reference is exact."""
    tones, interval, count, tolerance = Tones(), 5e-5, 10, 1e-9
    with run(exchange=True) as instance:

        def rates(time, state):
            instance.own.set_time(time)
            instance.own.set_continuous_states(state)
            instance.set(dict(zip(LOADS, tones(time))))
            return instance.rates()

        nominals = np.array(instance.own.get_nominals_of_continuous_states(144))
        times = interval * np.arange(count + 1)
        solution = solve_ivp(
            rates,
            (0.0, times[-1]),
            instance.own.get_continuous_states(144),
            "DOP853",
            times,
            rtol=tolerance,
            atol=tolerance * nominals,
        )
        assert solution.success
        rows = []
        for time, state in zip(times, solution.y.T):
            rates(time, state)
            assert instance.own.completed_integrator_step() == (False, False)
            rows.append(instance.get(WATCHED))
    check(named(rows), tones.response(gearbox, interval, count), 10 * tolerance)


def random_point(instance, rng):
    state, loads = rng.standard_normal(144), rng.standard_normal(2)
    instance.own.set_time(0.1)
    instance.own.set_continuous_states(state)
    instance.set(dict(zip(LOADS, loads)))
    return state, loads


def test_rates_are_those_of_the_state_space_model(gearbox, run, other):
    """x' = A x + B u in the states of `gp.state_space`, also after another bearing was set in event mode."""
    rng = np.random.default_rng(5)
    with run(exchange=True) as instance:
        for model in (gearbox, other_bearing(gearbox)):
            plant = gp.state_space(model)
            for _ in range(3):
                state, loads = random_point(instance, rng)
                same(instance.rates(), plant.A @ state + plant.B @ loads)
                names = [label.replace("/", ".") for label in plant.output_labels]
                outputs = np.array(instance.get(names))
                expected = plant.C @ state + plant.D @ loads
                np.testing.assert_allclose(outputs, expected, rtol=1e-9, atol=1e-12 * np.max(np.abs(expected)))
            instance.own.enter_event_mode()
            instance.set(other)
            instance.events()


@pytest.mark.parametrize("exchange", [False, True])
def test_directional_derivatives_fmi_2(gearbox, exported, tmp_path, exchange):
    """A, B, C, D column by column."""
    plant = gp.state_space(gearbox)
    states = [label.replace("/", ".") for label in plant.state_labels]
    outputs = [label.replace("/", ".") for label in plant.output_labels]
    with running(exported["2.0"], "2.0", tmp_path, exchange=exchange) as instance:
        places = {
            name: [instance.references[variable] for variable in variables]
            for name, variables in {
                "rates": [f"der({state})" for state in states],
                "states": states,
                "inputs": LOADS,
                "outputs": outputs,
            }.items()
        }

        def columns(unknowns, knowns):
            seeds = np.eye(len(places[knowns])).tolist()
            derivative = instance.own.get_directional_derivative
            return np.transpose([derivative(places[unknowns], places[knowns], seed) for seed in seeds])

        same(columns("rates", "states"), plant.A)
        same(columns("rates", "inputs"), plant.B)
        for found, expected in ((columns("outputs", "states"), plant.C), (columns("outputs", "inputs"), plant.D)):
            for row, exact in zip(found, expected):  # forces and velocities differ by orders of magnitude
                same(row, exact)


@pytest.mark.parametrize("exchange", [False, True])
def test_directional_and_adjoint_derivatives_fmi_3(gearbox, exported, tmp_path, exchange):
    """C and D along seeds, B and D against them: scalar sensitivities, seeds that are arrays where there are any."""
    plant, rng = gp.state_space(gearbox), np.random.default_rng(6)
    with running(exported["3.0"], "3.0", tmp_path, exchange=exchange) as instance:
        references = instance.references
        inputs = [references[name] for name in LOADS]
        outputs = [references[label.replace("/", ".")] for label in plant.output_labels]
        along, against = instance.own.get_directional_derivative, instance.own.get_adjoint_derivative
        for _ in range(3):
            state, loads = rng.standard_normal(144), rng.standard_normal(2)
            sizes = np.abs(plant.C) @ np.abs(state)
            assert np.all(np.abs(along(outputs, [references["state"]], state) - plant.C @ state) <= ENTRIES * sizes)
            sizes = np.abs(plant.D) @ np.abs(loads)
            assert np.all(np.abs(along(outputs, inputs, loads) - plant.D @ loads) <= ENTRIES * sizes)
            same(against([references["der(state)"]], inputs, state), state @ plant.B)
            weights = rng.standard_normal(len(outputs))
            same(against(outputs, inputs, weights), weights @ plant.D)


def test_a_read_without_room_changes_nothing(gearbox, exported, tmp_path, capfd, caplog):
    """FMI 3: what fmuloader cannot do is an error with a sentence, and the run goes on."""
    with running(exported["3.0"], "3.0", tmp_path) as instance:
        rows = steps_of(instance, last=100)
        with pytest.raises(Fmi3Error, match="fmi3GetFloat64 returned ERROR"):
            instance.get(["bearing_1.force"])
        assert any("values in all" in record.getMessage() for record in caplog.records)
        caplog.clear()
        capfd.readouterr()
        rows += steps_of(instance, first=100)
    check(named(rows), held(gearbox, STEPS), LIMIT)
