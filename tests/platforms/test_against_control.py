"""The C host's results against python-control and the frequency-domain solver: Gearpath's C code in no part of them."""

import control
import numpy as np
import pytest
from platform_scenarios import (
    CHANGE_AT,
    LOADS,
    NEW_DAMPING,
    NEW_STIFFNESS,
    STATES,
    co_simulation,
    held_inputs,
    interpolation,
    new_bearing,
)
from platform_script import Script, values

import gearpath as gp

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("platforms")]


@pytest.fixture(scope="module")
def replaced(model):
    """The model with the new bearing, built anew."""
    changes = {"stiffness": NEW_STIFFNESS, "damping": NEW_DAMPING}
    return model.replace({f"joints.bearing_2.{name}": matrix.tolist() for name, matrix in changes.items()})


@pytest.fixture(scope="module")
def systems(model, replaced):
    """python-control's systems before and after the change."""
    return gp.state_space(model), gp.state_space(replaced)


def linear(system) -> list[str]:
    """The FMU's names of a system's outputs: python-control has slashes for dots."""
    return [name.replace("/", ".") for name in system.output_labels]


def columns(fmu, output, names):
    """The named scalar outputs (lines, names) of a run that read all outputs."""
    table, order = np.array(values(output)), fmu.names("output")
    starts = np.cumsum([0, *(fmu.size[name] for name in order)])
    return table[:, [starts[order.index(name)] for name in names]]


def error(found, wanted):
    """Largest deviation of each output, in units of its largest value; the worst."""
    return (np.abs(found - wanted).max(axis=0) / np.abs(wanted).max(axis=0)).max()


def held(system, inputs, h, x):
    """Outputs before each step and the state after the last, by python-control's zero-order hold."""
    discrete = control.sample_system(system, h, "zoh")
    padded = np.vstack([inputs, inputs[-1:]])
    response = control.forced_response(discrete, inputs=padded.T, initial_state=x, squeeze=False)
    return response.outputs.T, response.states[:, -1]


def test_held_inputs_and_a_bearing_exchanged_in_mid_run(fmu, machine, run, systems):
    inputs, h = held_inputs(2 * CHANGE_AT), 1e-5
    script = Script(fmu, machine)
    co_simulation(script, inputs, h, CHANGE_AT)
    found = columns(fmu, run(script), linear(systems[0]))
    first, x = held(systems[0], inputs[:CHANGE_AT], h, np.zeros(STATES))
    second, _ = held(systems[1], inputs[CHANGE_AT:], h, x)
    assert error(found[: CHANGE_AT - 1], first[: CHANGE_AT - 1]) < 1e-11
    wanted = np.vstack([first[:CHANGE_AT], second])
    assert error(found, wanted) < 1e-9
    assert error(second, held(systems[0], inputs[CHANGE_AT:], h, x)[0]) > 1e-2, "the new bearing changes the results"


def test_interpolated_inputs(fmu, machine, run, systems):
    """A first-order hold, as python-control's `forced_response` of a continuous system assumes it."""
    corners, h = held_inputs(60), 2e-5
    script = Script(fmu, machine)
    interpolation(script, corners, h)
    found = columns(fmu, run(script), linear(systems[0]))
    times = h * np.arange(len(corners))
    wanted = control.forced_response(systems[0], times, corners.T, squeeze=False).outputs.T
    assert error(found, wanted) < 1e-11


def test_the_power_ratio_follows_the_new_bearing(fmu, machine, run, model, replaced):
    frequencies = np.array([20.0, 333.0, 1100.0, 2750.0, 4900.0])
    script = Script(fmu, machine)
    co_simulation(script, held_inputs(1), 1e-5, 0)
    for f in frequencies:
        script.set({"frequency": f})
        script.get(["alpha"])
    alpha = np.array([v[0] for v in values(run(script))[2:]])
    wanted = gp.power_flow(replaced, frequencies).alpha.values
    np.testing.assert_allclose(alpha, wanted, rtol=1e-9)
    assert (np.abs(gp.power_flow(model, frequencies).alpha.values / wanted - 1) > 1e-3).any()


def exchange(fmu, machine, h, steps, loads):
    """The state after `steps` Runge-Kutta steps from rest, and its derivatives."""
    script = Script(fmu, machine)
    script.start("me")
    script.set(dict(zip(LOADS, loads)))
    script.integrate(0.0, h, steps, STATES)
    script.call("states", STATES)
    script.call("derivatives", STATES)
    return script


def test_model_exchange_converges_with_fourth_order(fmu, machine, run, systems):
    """Against the exact solution: halving the step takes the error down by 16 until rounding shows."""
    system, loads, stop = systems[0], np.array([2e-6, 30.0]), 2e-5
    times = np.array([0.0, stop])
    exact = control.forced_response(system, times, np.tile(loads[:, None], 2), squeeze=False).states[:, -1]
    errors = []
    for steps in (40, 80, 160):
        output = run(exchange(fmu, machine, stop / steps, steps, loads))
        x, dx = values(output, "states")[0], values(output, "derivatives")[0]
        slope = system.A @ x + system.B @ loads
        assert np.abs(dx - slope).max() < 1e-12 * (np.abs(system.A) @ np.abs(x) + np.abs(system.B) @ loads).max()
        errors.append(np.abs(x - exact).max() / np.abs(exact).max())
    assert errors[-1] < 1e-6
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (np.abs(orders - 4) < 0.3).all(), (orders, errors)


def test_a_bearing_exchanged_in_event_mode(fmu, machine, run, systems):
    x, loads = np.random.default_rng(3).normal(size=STATES), np.array([1e-6, 10.0])
    script = Script(fmu, machine)
    script.start("me")
    script.set(dict(zip(LOADS, loads)))
    for change in (False, True):
        if change:
            script.call("event")
            script.set(new_bearing(fmu.fmi))
            script.call("update")
            script.call("continuous")
        script.set_states(x)
        script.call("derivatives", STATES)
        script.get(fmu.names("output"))
    output = run(script)
    dx, y = values(output, "derivatives"), columns(fmu, output, linear(systems[0]))
    for k, system in enumerate(systems):
        slope = system.A @ x + system.B @ loads
        assert np.abs(dx[k] - slope).max() < 1e-12 * np.abs(slope).max()
        result = system.C @ x + system.D @ loads
        np.testing.assert_allclose(y[k], result, rtol=1e-10, atol=1e-12 * np.abs(result).max())
    assert np.abs(dx[1] - dx[0]).max() > 1e-3 * np.abs(dx[0]).max()


def test_directional_derivatives(fmu, machine, run, systems):
    """In model exchange those of the state derivatives and of the linear outputs are A, B, C and D times the seed."""
    system, rng = systems[0], np.random.default_rng(5)
    dx, du = rng.normal(size=STATES), rng.normal(size=2)
    arrays = fmu.fmi == "3.0"
    slopes = ["der(state)"] if arrays else [name for name in fmu.reference if name.startswith("der(")]
    states = [name[4:-1] for name in slopes]
    script = Script(fmu, machine)
    script.start("me")
    for unknowns in (slopes, linear(system)):
        script.derivative("directional", unknowns, [*states, *LOADS], [*dx, *du])
    found = values(run(script), "directional")
    for result, over_x, over_u in ((found[0], system.A, system.B), (found[1], system.C, system.D)):
        wanted = over_x @ dx + over_u @ du
        scale = np.abs(over_x) @ np.abs(dx) + np.abs(over_u) @ np.abs(du)
        assert (np.abs(result - wanted) < 1e-11 * scale).all()


def test_adjoint_derivatives_and_matrices(fmus, machine, run, systems):
    """FMI 3: w (J v) = (J^T w) v, and system.A to system.D are python-control's."""
    fmu, system, rng = fmus["3.0"], systems[0], np.random.default_rng(6)
    unknowns, knowns = ["der(state)", *linear(system)], ["state", *LOADS]
    v, w = rng.normal(size=STATES + 2), rng.normal(size=STATES + len(linear(system)))
    script = Script(fmu, machine)
    script.start("me")
    script.derivative("directional", unknowns, knowns, v)
    script.derivative("adjoint", unknowns, knowns, w)
    for name in "ABCD":
        script.get([f"system.{name}"])
    output = run(script)
    forward, backward = values(output, "directional")[0], values(output, "adjoint")[0]
    assert abs(w @ forward - backward @ v) < 1e-12 * (np.abs(w) @ np.abs(forward))
    for found, wanted in zip(values(output), (system.A, system.B, system.C, system.D)):
        assert np.abs(found.reshape(wanted.shape) - wanted).max() < 1e-12 * np.abs(wanted).max()
