"""Exported gearboxes against `gp.state_space`, which the FMU's C core knows nothing of."""

from pathlib import Path

import numpy as np
import pytest

import gearpath as gp

MODELS = Path(__file__).resolve().parents[3] / "models"
LINES = 2j * np.pi * np.geomspace(5.0, 5000.0, 60)
METHODS = ("derivatives", "differences")


@pytest.fixture(scope="module")
def model():
    return gp.load(MODELS / "gearbox.toml")


@pytest.fixture(scope="module")
def plant(model):
    return gp.state_space(model)


@pytest.fixture(scope="module")
def fmus(model, tmp_path_factory):
    folder = tmp_path_factory.mktemp("gearboxes")
    return {fmi: gp.export_fmu(model, folder / f"{fmi}.fmu", fmi=fmi, documentation=False) for fmi in ("2.0", "3.0")}


def compare(found, plant):
    """Transfers relative to their largest value, and poles relative to the fastest."""
    H, expected = found[plant.output_labels, plant.input_labels](LINES), plant(LINES)
    largest = abs(expected).max(axis=2, keepdims=True)
    assert np.all(abs(H - expected) <= 1e-9 * largest)
    poles, wanted = found.poles(), plant.poles()
    assert poles.shape == wanted.shape
    apart = abs(poles[:, None] - wanted).min(axis=0)
    assert apart.max() < 1e-9 * abs(wanted).max()
    elastic = abs(wanted) > 100.0
    assert np.all(apart[elastic] < 1e-9 * abs(wanted[elastic]))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("fmi", ["2.0", "3.0"])
def test_transfers_and_poles_are_those_of_the_state_space(fmus, plant, fmi, method):
    found = gp.linearize(fmus[fmi], inputs=["mesh.transmission_error", "mesh.force"], method=method)
    assert found.method == method
    assert found.warnings == ()
    compare(found, plant)


def test_names_may_be_those_of_python_control(fmus):
    """A slash for a dot, in all four places."""
    point = {"start_values": {"mesh.force": 10.0}, "states": {"gear_train.mode_5.v": 0.02}}
    asked = {"inputs": ["mesh.force"], "outputs": ["bearing_1.force_uy", "gear_train.mode_5.v"]}
    slashed = {key: [name.replace(".", "/") for name in names] for key, names in asked.items()}
    slashed |= {k: {name.replace(".", "/"): x for name, x in values.items()} for k, values in point.items()}
    dotted, same = gp.linearize(fmus["2.0"], **asked, **point), gp.linearize(fmus["2.0"], **slashed)
    np.testing.assert_array_equal(np.hstack([same.C, same.D]), np.hstack([dotted.C, dotted.D]))
    np.testing.assert_array_equal(same.x0, dotted.x0)
    assert dotted.u0 == same.u0 == [10.0]


@pytest.mark.parametrize("fmi", ["2.0", "3.0"])
def test_both_methods_agree_at_a_nonlinear_point(fmus, fmi):
    """Powers are products of forces and velocities; alpha is a function of the input `frequency`."""
    name = "gear_train.mode_5.v" if fmi == "2.0" else "state[1]"
    point = {"start_values": {"frequency": 700.0, "mesh.force": 3.0}, "states": {name: 0.02}}
    given, found = (gp.linearize(fmus[fmi], method=method, **point) for method in METHODS)
    row, column = given.output_labels.index("alpha"), given.input_labels.index("frequency")
    assert given.D[row, column] != 0.0
    assert abs(given.C[given.output_labels.index("bearing_1/power")]).max() > 0.0
    a, b = (np.block([[system.A, system.B], [system.C, system.D]]) for system in (given, found))
    rounding = 1e-10 * abs(np.concatenate([given.dx0, given.y0]))[:, None]  # of the values that are subtracted
    assert np.all(abs(a - b) <= 1e-6 * abs(a).max(axis=1, keepdims=True) + rounding)
    assert given.error < 1e-6


def test_slope_of_alpha_is_that_of_the_power_flow(model, fmus):
    """d alpha / d frequency against power flows a little beside."""
    found = gp.linearize(fmus["2.0"], inputs="frequency", outputs="alpha", start_values={"frequency": 700.0})
    flow = gp.power_flow(model, 700.0 + 0.05 * np.array([-2.0, -1.0, 1.0, 2.0])).alpha.values
    assert found.D[0, 0] == pytest.approx(flow @ [1, -8, 8, -1] / (12 * 0.05), rel=1e-7)


def test_parameters_change_the_linearization(model, fmus):
    K, C = [[5e7, 1e5], [1e5, 3e4]], [[90.0, 1.0], [1.0, 0.2]]
    changed = model.replace({"joints.bearing_1.stiffness": K, "joints.bearing_1.damping": C})
    entries = [(0, 0), (0, 1), (1, 1)]
    values = {
        "2.0": {
            f"bearing_1.{what}[{i + 1},{k + 1}]": matrix[i][k]
            for what, matrix in (("stiffness", K), ("damping", C))
            for i, k in entries
        },
        "3.0": {"bearing_1.stiffness": K, "bearing_1.damping": C},
    }
    for fmi, start in values.items():
        found = gp.linearize(fmus[fmi], start_values=start)
        compare(found, gp.state_space(changed))


def test_a_mesh_source_turns(tmp_path):
    """With a speed the shaft angle is a state that grows; its derivative follows the speed."""
    model = gp.load(MODELS / "helical_gearbox.toml")
    path = gp.export_fmu(model, tmp_path / "helical.fmu", documentation=False)
    found = gp.linearize(path, inputs="mesh.speed", outputs="mesh.harmonic_1.frequency")
    angle = found.state_labels.index("mesh/angle")
    assert found.dx0[angle] == pytest.approx(found.u0[0] * 2 * np.pi / 60, rel=1e-12)
    assert found.B[angle, 0] == pytest.approx(2 * np.pi / 60, rel=1e-12)
    assert found.D[0, 0] == pytest.approx(model.system.source.teeth / 60, rel=1e-12)
    later = gp.linearize(path, inputs="mesh.speed", outputs="mesh.harmonic_1.frequency", time=1e-3)
    assert later.x0[angle] == pytest.approx(1e-3 * found.dx0[angle], rel=1e-6)
