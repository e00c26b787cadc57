"""Frequency responses for python-control: values by three ways, names, units, the sign of the feedback."""

import inspect
from pathlib import Path

import numpy as np
import pytest

import gearpath as gp

control = pytest.importorskip("control")
MODEL = Path(__file__).resolve().parents[2] / "models" / "gearbox.toml"
LINES = np.linspace(20.0, 5000.0, 120)


@pytest.fixture(scope="module")
def model():
    return gp.load(MODEL)


@pytest.fixture(scope="module")
def plant(model):
    return gp.state_space(model)


@pytest.fixture(scope="module")
def loop(model):
    """Collocated: the mesh velocity for a force at the mesh."""
    return gp.to_frd(model, LINES, "mesh.velocity", "mesh.force")


def close(found, expected, limit=1e-9):
    return abs(found - expected).max() <= limit * abs(expected).max()


def test_values_are_those_of_the_state_space_and_of_the_synthesis(model, plant):
    found = gp.to_frd(model, LINES)
    np.testing.assert_allclose(found.omega, 2 * np.pi * LINES, rtol=1e-15)
    expected = plant(1j * found.omega)
    largest = abs(expected).max(axis=2, keepdims=True)
    assert np.all(abs(found.frdata - expected) < 1e-8 * largest)
    labelled = gp.frequency_response(model, LINES)
    np.testing.assert_array_equal(np.moveaxis(found.frdata, -1, 0), labelled.values)


def test_signals_and_units_are_those_of_the_state_space(model, plant):
    found = gp.to_frd(model, LINES)
    assert found.name == plant.name == "gearbox"
    assert (found.input_labels, found.output_labels) == (plant.input_labels, plant.output_labels)
    assert (found.input_units, found.output_units) == (plant.input_units, plant.output_units)
    assert found.output_units["bearing_1/force_rx"] == "N.m"
    assert plant.state_units["casing/mode_1/v"] == "J^0.5"
    for text in (inspect.getdoc(found), inspect.getdoc(plant)):
        assert "mesh/transmission_error (m)" in text
        assert "casing/velocity_rz (rad/s)" in text


def test_states_are_energies(model):
    """J^0.5: half the squared norm of a mode's pair is its energy, fed by a force over time as F v."""
    t = np.linspace(0.0, 5e-5, 2001)
    rough = model.replace({"components.gear_train.modal_damping": 0.0})
    free = gp.state_space(rough)
    F = 100.0 * np.sin(2 * np.pi * 2e4 * t)
    run = control.forced_response(free, t, np.vstack([0 * t, F]))
    v = run.outputs[free.output_labels.index("mesh/velocity")]
    fed = np.trapezoid(F * v, t)
    rows = [i for i, name in enumerate(free.state_labels) if name.startswith("gear_train")]
    rigid = [free.state_labels.index(f"gear_train/mode_{k}/x") for k in range(1, 5)]  # without energy
    stored = 0.5 * (run.states[rows, -1] ** 2).sum() - 0.5 * (run.states[rigid, -1] ** 2).sum()
    assert stored == pytest.approx(fed, rel=0.02)  # the rest is in bearings and casing, which hardly move in 50 us


def test_loss_factors_are_exact(model):
    """(1 + i eta) K, of which the state space has only the viscous equivalent."""
    lossy = model.replace({"joints.bearing_1": lossy_bearing(model, 0.3)})
    found = gp.to_frd(lossy, LINES, ["bearing_1.force_uy"], ["mesh.force"])
    expected = gp.frequency_response(lossy, LINES, ["bearing_1.force_uy"], ["mesh.force"])
    np.testing.assert_array_equal(found.frdata[0, 0], expected.values[:, 0, 0])
    viscous = gp.state_space(lossy)["bearing_1/force_uy", "mesh/force"](1j * found.omega)
    assert not close(found.frdata[0, 0], viscous, 1e-3)


def lossy_bearing(model, eta):
    table = dict(model.to_dict()["joints"]["bearing_1"])
    table.pop("damping_time", None)
    table.pop("damping", None)
    return {**table, "loss_factor": eta}


def test_a_labelled_response_is_taken_too(model):
    labelled = gp.frequency_response(model, [3000.0, 100.0, 500.0], ["mesh.velocity", "casing.velocity_uy"])
    found = gp.to_frd(labelled.transpose("input", "frequency", "output"))
    np.testing.assert_allclose(found.omega, 2 * np.pi * np.array([100.0, 500.0, 3000.0]))
    np.testing.assert_array_equal(found.frdata[1, 0], labelled.values[[1, 2, 0], 1, 0])
    assert found.output_labels == ["mesh/velocity", "casing/velocity_uy"]
    assert found.output_units["casing/velocity_uy"] == "m/s"
    bare = gp.to_frd(labelled.drop_vars(["output_unit", "input_unit"]))
    assert set(bare.output_units.values()) == {""}


@pytest.mark.parametrize(
    ("options", "match"),
    [
        ({"frequencies_hz": [10.0, 20.0, 10.0]}, "10 Hz is given more than once"),
        ({"frequencies_hz": [-1.0]}, "-1 Hz is not allowed"),
        ({"outputs": "casing.velocity_yu"}, "did you mean 'casing.velocity_uy'"),
        ({"frequencies_hz": [10.0], "smooth": True}, "one frequency cannot be interpolated"),
        ({"frequencies_hz": "a"}, "frequencies"),
        ({"outputs": 5}, "outputs: 5 names none"),
        ({"inputs": []}, r"inputs: \[\] names none; give one name or several, or leave it out for all"),
    ],
)
def test_requests_that_do_not_fit(model, options, match):
    with pytest.raises(gp.InputError, match=match):
        gp.to_frd(model, **options)


def test_responses_that_do_not_fit(model):
    labelled = gp.frequency_response(model, [100.0, 200.0])
    with pytest.raises(gp.InputError, match="dimensions are frequency, input instead of"):
        gp.to_frd(labelled.sel(output="mesh.velocity"))
    with pytest.raises(gp.InputError, match="select from it with"):
        gp.to_frd(labelled, outputs="mesh.velocity")


@pytest.mark.parametrize("sign", [-1, 1])
def test_feedback_keeps_the_sign(plant, loop, sign):
    """python-control 0.10 forgets it; the state space does not."""
    path = control.tf([50.0, 0.0], [1.0, 2000.0])
    siso = plant["mesh/velocity", "mesh/force"]
    for other in (1e4, path, control.tf2ss(path), control.frd(path, loop.omega)):
        found = control.feedback(loop, other, sign)
        same = control.feedback(siso, other if isinstance(other, float) else control.tf2ss(path), sign)
        assert close(found.frdata[0, 0], same(1j * found.omega), 1e-8)
    opposite = control.feedback(siso, control.tf2ss(path), -sign)
    assert not close(control.feedback(loop, path, sign).frdata[0, 0], opposite(1j * loop.omega), 1e-3)


def test_feedback_through_several_signals(model, plant):
    """Two velocities back to two inputs by a matrix, positive."""
    names = ["mesh.velocity", "casing.velocity_uy"]
    found = gp.to_frd(model, LINES, names).feedback([[0.0, 1e-9], [20.0, -3.0]], 1)
    signals = [name.replace(".", "/") for name in names]
    same = control.feedback(plant[signals, plant.input_labels], np.array([[0.0, 1e-9], [20.0, -3.0]]), 1)
    expected = same(1j * found.omega)
    assert np.all(abs(found.frdata - expected) < 1e-8 * abs(expected).max(axis=2, keepdims=True))
    assert found.output_labels == signals
    assert found.output_units == {"mesh/velocity": "m/s", "casing/velocity_uy": "m/s"}


def test_parts_keep_names_units_and_the_sign(model, loop):
    part = gp.to_frd(model, LINES, smooth=True)["mesh/velocity", "mesh/force"]
    assert part.name == "gearbox_indexed"
    np.testing.assert_array_equal(part.frdata, loop.frdata)
    assert part.input_units == {"mesh/force": "N"}
    whole = gp.to_frd(model, LINES, "mesh.velocity", "mesh.force", smooth=True)
    assert part(1j * 777.0) == pytest.approx(whole(1j * 777.0), rel=1e-9)
    np.testing.assert_allclose(part.feedback(3.0, 1).frdata, loop.frdata / (1 - 3.0 * loop.frdata), rtol=1e-10)
    omega, values = loop
    assert omega is loop[0]
    np.testing.assert_array_equal(values, loop.frdata[0, 0])


def test_smooth_interpolates(model, plant):
    fine = gp.to_frd(model, np.linspace(80.0, 120.0, 40), "mesh.velocity", "mesh.force", smooth=True)
    s = 2j * np.pi * 101.3
    assert fine(s) == pytest.approx(plant["mesh/velocity", "mesh/force"](s), rel=1e-5)
    with pytest.raises(ValueError, match="not all frequencies"):
        gp.to_frd(model, [80.0, 120.0], "mesh.velocity", "mesh.force")(s)
