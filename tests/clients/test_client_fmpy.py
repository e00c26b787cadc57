"""FMPy: co-simulation and model exchange, FMI 2 and 3.

In co-simulation FMPy sets the inputs at the beginning of a step and reads the outputs at its end, before it sets the
next inputs. In model exchange its CVode integrates with the inputs of the last output point or event: `CVodeSolver.f`
sets no inputs, and the root function that would does not run for a model without event indicators (fmpy/sundials).
So the loads are given as steps, a doubled time at each, which FMPy makes events of: then the exact zero-order hold is
the reference in model exchange too, and what is left is the solver's own error.
"""

import fmpy
import numpy as np
import pytest
from client_models import bearing_entries, bearing_matrices, other_bearing
from client_reference import FREQUENCY, LOADS, SPECTRAL, WATCHED, Steps, check, deviations, held, interpolated
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu

STEPS = Steps.random(2e-5, 250)
JUMPS = Steps.random(1e-4, 10)  # for model exchange
LIMIT = 1e-10  # the deviation found is 3e-12
LINEAR = [name for name in WATCHED if name not in SPECTRAL]
OVER = 10  # CVode holds the error of one step to the tolerance; over the run it grows to 0.7 ... 5 of it


def table(steps, parameters=None, *, jumps=False):
    """FMPy's input signals: a row for every step, or for both of its ends; `parameters` are columns row by row."""
    columns = {"time": steps.times[:-1], **dict(zip(LOADS, steps.loads.T)), **(parameters or {})}
    columns["frequency"] = np.full(len(steps.loads), FREQUENCY)
    if jumps:
        columns = {name: np.repeat(values, 2) for name, values in columns.items()}
        columns["time"][1::2] = steps.times[1:]
    signals = np.zeros(len(columns["time"]), dtype=[(name, float) for name in columns])
    for name, values in columns.items():
        signals[name] = values
    return signals


def simulate(fmu, steps, signals, **settings):
    """The outputs at the end of every step."""
    settings = {"output_interval": steps.step, "stop_time": steps.times[-1], "fmi_type": "CoSimulation"} | settings
    result = fmpy.simulate_fmu(fmu, input=signals, output=WATCHED, **settings)
    assert len(result) == len(steps.loads) + 1
    return {name: result[name][1:] for name in WATCHED}


def exchange(fmu, steps, signals, tolerance, **settings):
    """Model exchange by CVode, the outputs at the end of every step with the next step's loads."""
    return simulate(
        fmu, steps, signals, fmi_type="ModelExchange", relative_tolerance=tolerance, record_events=False, **settings
    )


def fine(steps, parts):
    """The same loads, read `parts` times a step: CVode takes no more than 500 steps from output to output."""
    return Steps(steps.step / parts, np.repeat(steps.loads, parts, axis=0))


def test_the_files_are_valid(fmu):
    assert not validate_fmu(str(fmu))


def test_co_simulation(gearbox, fmu):
    check(simulate(fmu, STEPS, table(STEPS)), held(gearbox, STEPS), LIMIT)


def test_model_exchange(gearbox, fmu):
    """The deviation is the solver's tolerance, and falls with it: 7e-6, 7e-8 and 1e-9 of the largest values."""
    steps = fine(JUMPS, 5)
    expected = held(gearbox, steps, fresh=True)
    for tolerance in (1e-5, 1e-7, 1e-9):
        found = exchange(fmu, steps, table(JUMPS, jumps=True), tolerance)
        assert max(deviations(found, expected).values()) < OVER * tolerance


def start_values(fmi):
    if fmi == "2.0":
        return bearing_entries()
    return {name: matrix.ravel().tolist() for name, matrix in bearing_matrices().items()}


def test_another_bearing_before_the_run(gearbox, fmu, fmi):
    found = simulate(fmu, STEPS, table(STEPS), start_values=start_values(fmi))
    check(found, held(other_bearing(gearbox), STEPS), LIMIT)


def test_another_bearing_before_model_exchange(gearbox, fmu, fmi):
    steps = fine(JUMPS, 5)
    found = exchange(fmu, steps, table(JUMPS, jumps=True), 1e-8, start_values=start_values(fmi))
    check(found, held(other_bearing(gearbox), steps, fresh=True), OVER * 1e-8)


def exchanged_columns(model, steps, change):
    """The entries of bearing_1 as signals: the other bearing's from step `change`."""
    old, new = bearing_entries(model), bearing_entries()
    return {name: np.where(np.arange(len(steps.loads)) < change, old[name], new[name]) for name in old}


def after(values, change):
    """All outputs from step `change`."""
    return {name: value[change:] for name, value in values.items()}


def test_bearing_exchanged_in_co_simulation(gearbox, exported):
    """FMI 2: FMPy sets tunable parameters like inputs, at every step."""
    half = len(STEPS.loads) // 2
    found = simulate(exported["2.0"], STEPS, table(STEPS, exchanged_columns(gearbox, STEPS, half)))
    models = [gearbox] * half + [other_bearing(gearbox)] * (len(STEPS.loads) - half)
    expected = held(models, STEPS)
    check(found, expected, LIMIT, LINEAR)
    check(after(found, half), after(expected, half), LIMIT)


def test_bearing_exchanged_in_model_exchange(gearbox, exported):
    """FMI 2: FMPy makes an event of the change, sets the parameters in event mode and reads after it."""
    parts, half = 5, len(JUMPS.loads) // 2
    steps = fine(JUMPS, parts)
    columns = exchanged_columns(gearbox, JUMPS, half)
    found = exchange(exported["2.0"], steps, table(JUMPS, columns, jumps=True), 1e-8)
    models = [gearbox] * (half * parts) + [other_bearing(gearbox)] * (len(steps.loads) - half * parts)
    expected = held(models, steps, fresh=True)
    check(found, expected, OVER * 1e-8, LINEAR)
    check(after(found, half * parts), after(expected, half * parts), OVER * 1e-8)


def test_matrices_exchanged_in_co_simulation(gearbox, exported):
    """FMI 3, by FMPy's callback after a step: of array signals FMPy cannot find the events (`Input.findEvents`)."""
    half = len(STEPS.loads) // 2
    references = {v.name: v.valueReference for v in fmpy.read_model_description(exported["3.0"]).modelVariables}

    def exchange_bearing(time, recorder):
        if round(time / STEPS.step) == half:
            for name, matrix in bearing_matrices().items():
                recorder.fmu.setFloat64([references[name]], matrix.ravel().tolist())
        return True

    found = simulate(exported["3.0"], STEPS, table(STEPS), step_finished=exchange_bearing)
    models = [gearbox] * half + [other_bearing(gearbox)] * (len(STEPS.loads) - half)
    expected = held(models, STEPS)
    # the callback comes after the reading: the new power ratio is seen one step later
    check(found, expected, LIMIT, LINEAR)
    check(after(found, half), after(expected, half), LIMIT)


@pytest.fixture
def slave(fmu, fmi, tmp_path):
    """An FMPy slave call by call, and the references of the variables."""
    description = fmpy.read_model_description(fmu)
    kind = FMU2Slave if fmi == "2.0" else FMU3Slave
    folder = fmpy.extract(fmu, tmp_path / "unpacked")
    instance = kind(
        guid=description.guid,
        unzipDirectory=folder,
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="gearbox",
    )
    yield instance, {variable.name: variable.valueReference for variable in description.modelVariables}
    instance.terminate()
    instance.freeInstance()


def test_interpolated_loads(gearbox, slave, fmi):
    """Loads that run straight through the step: exact first-order hold.

    FMI 2 by the inputs' derivatives, set on the slave, since `simulate_fmu(set_input_derivatives=True)` works for
    exactly nine inputs only (simulation.py, `derivatives=(value_type * 9)()`). FMI 3 by FMPy's intermediate update.
    """
    instance, references = slave
    loads = np.vstack([np.zeros(2), STEPS.loads])
    inputs, outputs, rows = [references[name] for name in LOADS], [references[name] for name in WATCHED], []
    now = {}

    def update(_environment, time, set_requested, *_flags):
        if set_requested:
            share = (time - now["start"]) / STEPS.step
            instance.setFloat64(inputs, now["from"] + share * (now["to"] - now["from"]))

    if fmi == "2.0":
        instance.instantiate()
        instance.setupExperiment(startTime=0.0)
        instance.enterInitializationMode()
        instance.setReal([references["frequency"]], [FREQUENCY])
    else:
        instance.instantiate(intermediateUpdate=update, requiredIntermediateVariables=inputs)
        instance.enterInitializationMode(startTime=0.0)
        instance.setFloat64([references["frequency"]], [FREQUENCY])
    instance.exitInitializationMode()
    for k, time in enumerate(STEPS.times[:-1]):
        now = {"start": time, "from": loads[k], "to": loads[k + 1]}
        if fmi == "2.0":
            instance.setReal(inputs, loads[k])
            instance.setRealInputDerivatives(inputs, [1, 1], (loads[k + 1] - loads[k]) / STEPS.step)
        else:
            instance.setFloat64(inputs, loads[k])
        instance.doStep(time, STEPS.step)
        rows.append(instance.getReal(outputs) if fmi == "2.0" else instance.getFloat64(outputs))
    check(dict(zip(WATCHED, np.array(rows).T)), interpolated(gearbox, STEPS.times, loads), LIMIT)
