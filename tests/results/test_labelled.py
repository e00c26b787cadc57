"""The labelled results: names, units, wrong input."""

from pathlib import Path

import numpy as np
import pytest

import gearpath as gp
from gearpath.results import labelled

MODEL = Path(__file__).resolve().parents[2] / "models" / "gearbox.toml"


@pytest.fixture(scope="module")
def model():
    return gp.load(MODEL)


@pytest.fixture(scope="module")
def flow(model):
    return gp.power_flow(model, [100.0, 1000.0, 3000.0])


def test_alpha_of_the_default_model(flow):
    assert [f"{a:.6g}" for a in flow.alpha.values] == ["0.922844", "0.0312096", "0.000380829"]


def test_parts_add_up(flow):
    np.testing.assert_allclose(flow.alpha, flow.path_alpha.sum("path"), rtol=1e-13)
    np.testing.assert_allclose(flow.alpha, flow.alpha_force + flow.alpha_moment, rtol=1e-13)
    np.testing.assert_allclose(flow.transmitted_power, flow.alpha * flow.input_power, rtol=1e-13)
    np.testing.assert_allclose(flow.dissipated_power.sum("element"), flow.input_power, rtol=1e-8)


def test_power_follows_from_force_and_velocity(flow):
    """P = 1/2 Re(v^H F), positive into the receiver, from the published phasors."""
    power = 0.5 * np.real(np.conj(flow.velocity_receiver) * flow.force)
    np.testing.assert_allclose(power, flow.path_alpha * flow.input_power, rtol=1e-12)


def test_every_quantity_has_units_and_every_path_its_names(flow):
    assert all(variable.attrs["units"] for variable in flow.data_vars.values())
    assert list(flow.path.values[:2]) == ["bearing_1.uy", "bearing_1.rx"]
    assert list(flow.force_unit.values[:2]) == ["N", "N.m"]
    assert set(flow.element.values) == {"gear_train", "casing"} | {
        f"{k}_{i}" for k in ("bearing", "mount") for i in (1, 2, 3, 4)
    }


def test_a_rigid_casing_dissipates_nothing(flow):
    assert np.all(flow.dissipated_power.sel(element="casing") == 0.0)


def test_ratios_are_0_where_no_power_enters(model, monkeypatch):
    """Not the watts of the path; the transmitted power stays what it is."""
    solve = labelled.power_flow

    def unfed(*arguments):
        found = solve(*arguments)
        found.input_power[1] = 0.0
        return found

    whole = gp.power_flow(model, [100.0, 1000.0, 3000.0])
    monkeypatch.setattr(labelled, "power_flow", unfed)
    flow = gp.power_flow(model, [100.0, 1000.0, 3000.0])
    for name in ("alpha", "alpha_force", "alpha_moment", "path_alpha"):
        assert np.all(flow[name].isel(frequency=1) == 0.0), name
        assert np.all(flow[name].isel(frequency=[0, 2]) == whole[name].isel(frequency=[0, 2])), name
    assert np.array_equal(flow.transmitted_power, whole.transmitted_power)


@pytest.mark.parametrize("frequencies", [[0.0], [-5.0], [np.nan], [np.inf], [], [[1.0, 2.0]], "many"])
def test_frequencies_that_cannot_be_are_refused(model, frequencies):
    with pytest.raises(gp.InputError, match="frequencies: "):
        gp.power_flow(model, frequencies)


@pytest.mark.parametrize(
    ("outputs", "inputs", "hint"),
    [
        (["bearing_1.force_u"], None, "did you mean 'bearing_1.force_uy'"),
        (["bearing_1.power"], None, "use gearpath.power_flow for powers"),
        (None, ["mesh.fource"], "did you mean 'mesh.force'"),
    ],
)
def test_wrong_names_get_a_hint(model, outputs, inputs, hint):
    with pytest.raises(gp.InputError, match=hint):
        gp.frequency_response(model, [100.0], outputs, inputs)


def test_scalar_frequency_and_order_of_names(model):
    H = gp.frequency_response(model, 100.0, ["casing.velocity_uy", "bearing_1.force_uy"], "mesh.force")
    assert H.dims == ("frequency", "output", "input")
    assert list(H.output.values) == ["casing.velocity_uy", "bearing_1.force_uy"]
    assert list(H.output_unit.values) == ["m/s", "N"]


def test_bounded_memory_for_many_lines(model):
    """Results for 100,000 lines take 57 MB; the working set on top of them stays small."""
    import tracemalloc

    f = np.linspace(20.0, 5000.0, 100_000)
    gp.power_flow(model, f[:10])
    tracemalloc.start()
    flow = gp.power_flow(model, f)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < flow.nbytes + 40e6
