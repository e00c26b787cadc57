"""Model exchange and derivatives of a linear system against its matrices."""

import control
import fmpy
import numpy as np
import pytest
from fmpy.fmi2 import FMU2Model
from fmu_driver import OK
from linear_cases import derivative, dotted, exchanging, random_system, started, unpacked_of

import gearpath as gp

FMIS = ["2.0", "3.0"]


def wide(names, values):
    return dict(zip(dotted(names), values))


@pytest.mark.parametrize("fmi", FMIS)
@pytest.mark.parametrize("n", [0, 1, 5, 8, 60])
def test_equations(n, fmi, tmp_path):
    """x' = A x + B u and y = C x + D u to the last digits of the sums; states go in and out unchanged."""
    system = random_system(n, inputs=3, outputs=2, seed=1)
    fmu = started(unpacked_of(system, tmp_path, fmi), exchange=True)
    it, rng = exchanging(fmu, n), np.random.default_rng(n)
    x, u = rng.normal(size=n), rng.normal(size=3)
    assert fmu.set(wide(system.input_labels, u)) == OK
    it.states = x
    assert it.states.tolist() == x.tolist()
    size = abs(system.A) @ abs(x) + abs(system.B) @ abs(u)
    assert (abs(it.derivatives - (system.A @ x + system.B @ u)) <= 1e-15 * (n + 3) * size).all()
    derivatives = [f"der({name})" for name in dotted(system.state_labels)]
    assert fmu.get(derivatives).tolist() == it.derivatives.tolist()
    assert fmu.get(dotted(system.state_labels)).tolist() == x.tolist()
    wanted = system.C @ x + system.D @ u
    assert abs(fmu.get(dotted(system.output_labels)) - wanted).max() < 1e-13 * abs(wanted).max()
    nominal = {v.name: float(v.nominal) for v in fmu.unpacked.description.modelVariables if v.nominal}
    assert it.vector("GetNominalsOfContinuousStates").tolist() == [nominal[s] for s in dotted(system.state_labels)]
    fmu.free()


@pytest.mark.parametrize("fmi", FMIS)
@pytest.mark.parametrize("exchange", [False, True])
def test_derivatives_are_the_matrices(fmi, exchange, tmp_path):
    """Column by column in the one direction, row by row (FMI 3) in the other, in either interface."""
    system = random_system(5, inputs=2, outputs=3, seed=2)
    fmu = started(unpacked_of(system, tmp_path, fmi), exchange=exchange)
    states = dotted(system.state_labels)
    unknowns = [*(f"der({name})" for name in states), *dotted(system.output_labels)]
    knowns = [*states, *dotted(system.input_labels)]
    whole = np.block([[system.A, system.B], [system.C, system.D]])
    for k, column in enumerate(np.eye(len(knowns))):
        assert derivative(fmu, unknowns, knowns, column).tolist() == whole[:, k].tolist()
    seed = np.random.default_rng(0).normal(size=len(knowns))
    assert abs(derivative(fmu, unknowns, knowns, seed) - whole @ seed).max() < 1e-14 * abs(whole).sum(axis=1).max()
    if fmi == "3.0":
        for k, row in enumerate(np.eye(len(unknowns))):
            assert derivative(fmu, unknowns, knowns, row, adjoint=True).tolist() == whole[k].tolist()
    fmu.free()


def test_matrices_can_be_read(tmp_path):
    system = random_system(3, inputs=2, outputs=4)
    fmu = started(unpacked_of(system, tmp_path, "3.0"))
    for letter in "ABCD":
        assert fmu.array(f"system.{letter}").tolist() == getattr(system, letter).tolist()
    assert fmu.set({"system.A": system.A}) != OK
    assert "is a result and cannot be set" in fmu.messages[-1]
    fmu.free()


@pytest.mark.parametrize("fmi", FMIS)
def test_an_integrator_finds_the_same_response(fmi, tmp_path):
    """fmpy's CVode against python-control's exact simulation of a step."""
    system = random_system(4, inputs=1, outputs=2, seed=4)
    path = gp.export_fmu(system, tmp_path / "it.fmu", fmi=fmi)
    found = fmpy.simulate_fmu(
        str(path), fmi_type="ModelExchange", stop_time=0.02, output_interval=1e-4, relative_tolerance=1e-9,
        start_values={"mount_1.force_uy": 1.0},
    )  # fmt: skip
    wanted = control.forced_response(system, found["time"], np.ones((1, len(found)))).outputs
    for name, row in zip(system.output_labels, wanted):
        assert abs(found[name] - row).max() < 1e-6 * abs(row).max()


def test_states_change_in_continuous_time_only_through_the_solver(tmp_path):
    """What is set before the simulation is where it starts, and events change nothing."""
    system = random_system(3, seed=6)
    unpacked = unpacked_of(system, tmp_path)
    x = {"filter.z_1": 0.25, "filter.z_2": -1.5, "filter.z_3": 4.0}
    fmu = started(unpacked, exchange=True, initial=x)
    it = exchanging(fmu, 3)
    assert it.states.tolist() == list(x.values())
    it.ok("EnterEventMode")
    assert not it.update()
    it.ok("EnterContinuousTimeMode")
    assert it.states.tolist() == list(x.values())
    fmu.free()


def test_the_gain_has_no_states(tmp_path):
    path = gp.export_fmu(control.tf([2.5], [1.0], name="gain", inputs="e", outputs="u"), tmp_path / "gain.fmu")
    description = fmpy.read_model_description(str(path))
    assert description.modelExchange
    assert description.numberOfContinuousStates == 0
    folder = fmpy.extract(str(path), str(tmp_path / "gain"))
    fmu = FMU2Model(guid=description.guid, unzipDirectory=folder, modelIdentifier="gain", instanceName="it")
    fmu.instantiate()
    fmu.setupExperiment(startTime=0.0)
    fmu.enterInitializationMode()
    fmu.setReal([0], [3.0])
    fmu.exitInitializationMode()
    assert fmu.getReal([1]) == [7.5]
    fmu.terminate()
    fmu.freeInstance()
