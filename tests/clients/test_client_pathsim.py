"""PathSim with pathsim-fmi: model exchange by PathSim's own solvers, FMI 2 and 3; co-simulation.

The loads are sources, evaluated at every stage of the solver. What pathsim-fmi 0.1.1 cannot do:

- It reads all outputs with room for one value each (`FMUWrapper.get_real`), so those of FMI 3 that are arrays are kept
  out of the ports as well; `CoSimulationFMU` reads them when it is made, so FMI 3 co-simulation is by its wrapper. Nor
  does `start_values` take arrays: matrices are set in event mode, by its wrapper.
- The two lists of the Jacobian are exchanged (`_build_state_derivative_maps`: FMPy's `derivative` is the attribute of
  the derivative, not of the state), so its implicit solvers cannot run FMI 2; in FMI 3 it does not find that there are
  directional derivatives. The Jacobian is tested with the lists put right; the solvers here are explicit.
"""

import numpy as np
import pytest
from client_models import SCALARS, bearing_entries, bearing_matrices, other_bearing, other_scalars
from client_packages import client
from client_reference import FREQUENCY, LOADS, WATCHED, Steps, Tones, check, held

import gearpath as gp

client("pathsim_fmi")

from pathsim import Connection, Simulation  # noqa: E402
from pathsim.blocks import Constant, Scope, Source  # noqa: E402
from pathsim.solvers import RKDP87  # noqa: E402
from pathsim_fmi import CoSimulationFMU, ModelExchangeFMU  # noqa: E402
from pathsim_fmi.wrapper import FMUWrapper  # noqa: E402

TONES, INTERVAL, COUNT = Tones(), 5e-5, 8
TOLERANCE = 1e-8
STEPS = Steps.random(2e-5, 100)
LIMIT = 1e-10  # of steps: the deviation found is 3e-12


def block_of(fmu, **start):
    """The block with those ports that PathSim can serve."""
    block = ModelExchangeFMU(str(fmu), start_values={"frequency": FREQUENCY, **start})
    wrapper = block.fmu_wrapper
    wrapper.output_refs = {name: wrapper.output_refs[name] for name in WATCHED}
    block.inputs, block.outputs = wrapper.create_port_registers()
    return block


def simulate(block):
    """The outputs at 0, 1, 2 ... COUNT times the interval, to the solver's tolerance."""
    sources = [Source(lambda time, load=load: TONES(time)[load]) for load in range(len(LOADS))]
    sources.append(Constant(FREQUENCY))
    scope = Scope(sampling_period=INTERVAL)
    connections = [Connection(source, block[name]) for source, name in zip(sources, [*LOADS, "frequency"])]
    connections += [Connection(block[name], scope[place]) for place, name in enumerate(WATCHED)]
    simulation = Simulation(
        [*sources, block, scope],
        connections,
        dt=1e-6,
        Solver=RKDP87,
        tolerance_lte_rel=TOLERANCE,
        tolerance_lte_abs=TOLERANCE * 1e-9,
        log=False,
    )
    simulation.run(INTERVAL * (COUNT + 0.5), adaptive=True)
    times, values = scope.read()
    np.testing.assert_allclose(times, INTERVAL * np.arange(COUNT + 1), rtol=0.0, atol=1e-15)
    return dict(zip(WATCHED, values))


def test_model_exchange(gearbox, fmu):
    check(simulate(block_of(fmu)), TONES.response(gearbox, INTERVAL, COUNT), TOLERANCE)


def test_another_bearing_before_the_run(gearbox, exported):
    found = simulate(block_of(exported["2.0"], **bearing_entries()))
    check(found, TONES.response(other_bearing(gearbox), INTERVAL, COUNT), TOLERANCE)


def test_other_scalars_before_the_run(gearbox, exported):
    found = simulate(block_of(exported["3.0"], **SCALARS))
    check(found, TONES.response(other_scalars(gearbox), INTERVAL, COUNT), TOLERANCE)


def test_other_matrices_before_the_run(gearbox, exported):
    """FMI 3: the arrays, in the event mode before the first step."""
    block = block_of(exported["3.0"])
    wrapper = block.fmu_wrapper
    wrapper.enter_event_mode()
    for name, matrix in bearing_matrices().items():
        wrapper.set_real([wrapper.variable_map[name].valueReference], matrix.ravel())
    assert not wrapper.update_discrete_states().discrete_states_need_update
    wrapper.enter_continuous_time_mode()
    check(simulate(block), TONES.response(other_bearing(gearbox), INTERVAL, COUNT), TOLERANCE)


def test_jacobian(gearbox, exported):
    """FMI 2: pathsim-fmi's Jacobian from directional derivatives, its lists put right, is A."""
    wrapper = block_of(exported["2.0"]).fmu_wrapper
    assert wrapper.provides_jacobian
    wrapper._state_refs, wrapper._derivative_refs = wrapper._derivative_refs, wrapper._state_refs
    A = gp.state_space(gearbox).A
    np.testing.assert_allclose(wrapper.get_state_jacobian(), A, rtol=0.0, atol=1e-12 * np.max(np.abs(A)))


def test_co_simulation(gearbox, exported):
    """FMI 2 by the block, which does the step from t at once when t is reached: it shows the step's end."""
    block = CoSimulationFMU(str(exported["2.0"]), dt=STEPS.step)

    def loads(time):
        return STEPS.loads[min(round(time / STEPS.step), len(STEPS.loads) - 1)]

    sources = [Source(lambda time, load=load: loads(time)[load]) for load in range(len(LOADS))]
    blocks = [*sources, Constant(FREQUENCY)]
    scope = Scope(sampling_period=STEPS.step)
    connections = [Connection(source, block[name]) for source, name in zip(blocks, [*LOADS, "frequency"])]
    connections += [Connection(block[name], scope[place]) for place, name in enumerate(WATCHED)]
    simulation = Simulation([*blocks, block, scope], connections, dt=STEPS.step, log=False)
    simulation.run(STEPS.times[-1])
    found = dict(zip(WATCHED, scope.read()[1][:, : len(STEPS.loads)]))
    check(found, held(gearbox, STEPS), LIMIT)


@pytest.mark.parametrize("other", [False, True])
def test_co_simulation_by_the_wrapper(gearbox, fmu, other):
    wrapper = FMUWrapper(str(fmu), mode="cosimulation")
    wrapper.initialize({"frequency": FREQUENCY, **(SCALARS if other else {})})
    inputs, outputs = ([wrapper.variable_map[name].valueReference for name in names] for names in (LOADS, WATCHED))
    rows = []
    for time, loads in zip(STEPS.times, STEPS.loads):
        wrapper.set_real(inputs, loads)
        assert not wrapper.do_step(time, STEPS.step).early_return
        rows.append(wrapper.get_real(outputs))
    check(dict(zip(WATCHED, np.array(rows).T)), held(other_scalars(gearbox) if other else gearbox, STEPS), LIMIT)
