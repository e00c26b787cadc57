"""The python-control object: names, values, stability, and use with python-control's own functions."""

from pathlib import Path

import control
import numpy as np
import pytest

import gearpath as gp

MODEL = Path(__file__).resolve().parents[2] / "models" / "gearbox.toml"


@pytest.fixture(scope="module")
def model():
    return gp.load(MODEL)


@pytest.fixture(scope="module")
def plant(model):
    return gp.state_space(model)


def test_signals_are_the_fmu_variables(plant):
    assert plant.input_labels == ["mesh/transmission_error", "mesh/force"]
    assert plant.output_labels[0] == "bearing_1/force_uy"
    assert {"mount_1/force_uy", "casing/acceleration_uy", "casing/velocity_rz"} <= set(plant.output_labels)
    assert plant.state_labels[0] == "gear_train/mode_1/x"
    assert plant.state_labels[-1] == "casing/mode_3/v"


def test_frequency_response_is_the_synthesis(model, plant):
    f = np.linspace(20.0, 5000.0, 400)
    response = gp.frequency_response(model, f)
    names = [str(name).replace(".", "/") for name in response.output.values]
    assert names == plant.output_labels
    found = np.moveaxis(plant(2j * np.pi * f), -1, 0)
    largest = abs(response.values).max(axis=0)
    assert np.all(abs(found - response.values) < 1e-8 * largest)


def test_feedback_of_collocated_velocity_adds_damping(plant):
    """Negative feedback from the mesh velocity to the mesh force is passive: no pole moves to the right."""
    loop = control.feedback(plant["mesh/velocity", "mesh/force"], 50.0)
    assert loop.poles().real.max() < 0.0
    assert np.sum(loop.poles().real) < np.sum(plant.poles().real)


@pytest.mark.parametrize("make", [gp.state_space, lambda model: gp.reduce(model, order=25)])
def test_parts_keep_units_and_have_plain_names(model, make):
    """Matplotlib takes the dollars of two names in a legend, python-control's `gearbox$indexed`, for a formula."""
    whole = make(model)
    part = whole[["casing/velocity_rz", "bearing_1/force_uy"], "mesh/force"]
    assert part.name == f"{whole.name}_indexed"
    assert control.c2d(part["casing/velocity_rz", "mesh/force"], 1e-5).name == f"{whole.name}_indexed_indexed_sampled"
    assert part.output_units == {"casing/velocity_rz": "rad/s", "bearing_1/force_uy": "N"}
    assert (part.input_units, part.state_units) == ({"mesh/force": "N"}, whole.state_units)
    assert part.state_labels == whole.state_labels
    s = 2j * np.pi * 700.0
    rows = [whole.output_labels.index(name) for name in part.output_labels]
    np.testing.assert_allclose(part(s), whole(s)[rows, 1:], rtol=1e-12)


def test_forced_response_runs(plant):
    t = np.linspace(0.0, 1e-3, 101)
    response = control.forced_response(plant, t, np.vstack([0 * t, np.ones_like(t)]))
    assert np.all(np.isfinite(response.outputs))
