"""gp.reduce: orders and certificates of the models, signals, joints exchanged, balanced truncation, refusals."""

from pathlib import Path

import control
import numpy as np
import pytest

import gearpath as gp
from gearpath.statespace.reduced.passivity import is_positive_real

MODELS = Path(__file__).resolve().parents[2] / "models"
BAND = (20.0, 5000.0)


@pytest.fixture(scope="module")
def model():
    return gp.load(MODELS / "gearbox.toml")


@pytest.fixture(scope="module")
def small(model):
    return gp.reduce(model, tolerance=1e-3)


def error(model, system, band=BAND):
    """The deviation by python-control from the synthesis of the complete model, on lines of its own."""
    f = np.unique(np.concatenate([np.linspace(*band, 6000), np.geomspace(*band, 2000)]))
    H = gp.frequency_response(model, f).values
    found = np.moveaxis(system(2j * np.pi * f), -1, 0)
    gain = abs(H).max(axis=0)
    heard = gain > 1e-9 * gain.max(axis=0)  # a symmetric machine has outputs that are zero but for rounding
    return float((abs(found - H).max(axis=0) / np.where(heard, gain, np.inf)).max())


@pytest.mark.parametrize(("name", "tolerance", "most"), [("gearbox", 1e-2, 25), ("gearbox", 1e-6, 40)])
def test_the_tolerance_is_kept(name, tolerance, most):
    model = gp.load(MODELS / f"{name}.toml")
    found = gp.reduce(model, tolerance=tolerance)
    assert error(model, found) <= found.certificate.error <= tolerance
    assert found.certificate.order <= most
    assert found.nstates == 2 * found.certificate.order
    assert found.certificate.stable
    assert found.certificate.passive
    assert gp.reduce(model, order=found.certificate.order - 1).certificate.error > tolerance


def test_the_helical_gearbox_needs_a_third_of_its_coordinates():
    model = gp.load(MODELS / "helical_gearbox.toml")
    found = gp.reduce(model, tolerance=1e-2)
    assert found.certificate.order <= 55 < found.certificate.complete == 150
    assert error(model, found) <= found.certificate.error <= 1e-2
    assert found.certificate.stable
    assert found.certificate.passive


def test_signals_are_those_of_the_complete_model(model, small):
    whole = gp.state_space(model)
    assert small.input_labels == whole.input_labels
    assert small.output_labels == whole.output_labels
    assert small.state_labels[0] == "gear_train/mode_1/x"
    assert isinstance(small, control.StateSpace)
    assert small.certificate.band == BAND
    assert "order 25 of 72" in str(small.certificate)


def test_a_joint_is_exchanged_in_the_reduced_model(model, small):
    K, C = [[6e7, -9e5], [-9e5, 8e4]], [[300.0, 4.0], [4.0, 0.9]]
    changed = model.replace({"joints.bearing_2.stiffness": K, "joints.bearing_2.damping": C})
    exchanged = small.with_joint("bearing_2", K, C)
    assert error(changed, exchanged) <= exchanged.certificate.error < 1e-3
    assert exchanged.certificate.passive


def test_feedback_of_collocated_velocity_adds_damping(small):
    loop = control.feedback(small["mesh/velocity", "mesh/force"], 50.0)
    assert loop.poles().real.max() < 0.0
    assert np.sum(loop.poles().real) < np.sum(small.poles().real)


def test_loss_factors_become_viscous(model):
    lossy = model.replace({"joints.mount_1.loss_factor": 0.2})
    found = gp.reduce(lossy, tolerance=1e-3)
    f = np.linspace(*BAND, 3000)
    H = np.moveaxis(gp.state_space(lossy)(2j * np.pi * f), -1, 0)
    gain = abs(H).max(axis=0)
    deviation = abs(np.moveaxis(found(2j * np.pi * f), -1, 0) - H).max(axis=0)
    assert (deviation <= found.certificate.error * gain + 1e-9 * gain.max(axis=0)).all()


def test_balanced_truncation_is_accurate_and_tells_that_it_is_not_passive(model):
    found = gp.reduce(model, order=20, method="balanced")
    assert error(model, found) <= 1.001 * found.certificate.error < 0.2
    assert found.certificate.stable
    G = found["mesh/velocity", "mesh/force"]
    w = 2 * np.pi * np.geomspace(0.1, 1e6, 4000)
    sampled = (G(1j * w).real < -1e-6 * abs(G(1j * w)).max()).any()
    assert found.certificate.passive == (not sampled)
    with pytest.raises(gp.InputError, match="balanced truncation leaves no joint"):
        found.with_joint("bearing_1", 1e8 * np.eye(2))


def test_balanced_truncation_by_tolerance(model):
    found = gp.reduce(model, tolerance=1e-2, method="balanced", band=(100.0, 3000.0))
    assert error(model, found, (100.0, 3000.0)) <= found.certificate.error <= 1e-2


def resonator(w, zeta, sign=1.0):
    """sign s / (s^2 + 2 zeta w s + w^2)."""
    return np.array([[0, w], [-w, -2 * zeta * w]]), np.array([[0.0], [1.0]]), np.array([[0.0, sign]])


@pytest.mark.parametrize(
    ("parts", "feedthrough", "passive"),
    [
        ([(10.0, 0.01, 1.0)], 0.0, True),
        ([(10.0, 0.01, 1.0), (4000.0, 1e-4, 1.0)], 0.0, True),
        ([(10.0, 0.01, 1.0), (4000.0, 1e-4, -1e-3)], 0.0, False),  # half a hertz wide, negative
        ([(10.0, 0.01, -1.0)], 0.0, False),
        ([(10.0, 0.01, 1.0)], -1e-3, False),
        ([(10.0, 0.01, -1.0)], 5.0 * (1.0 + 1e-3), True),  # 1 / (2 zeta w) = 5 is just made up for
        ([(10.0, 0.01, -1.0)], 5.0 * (1.0 - 1e-3), False),
    ],
)
def test_positive_realness_in_closed_form(parts, feedthrough, passive):
    """sum of s_k s / (s^2 + 2 zeta w s + w^2) + D: the real part at w is s_k / (2 zeta w) + D."""
    found = [resonator(*part) for part in parts]
    n = 2 * len(found)
    A = np.zeros((n, n))
    for k, (part, _, _) in enumerate(found):
        A[2 * k : 2 * k + 2, 2 * k : 2 * k + 2] = part
    B, C = np.vstack([b for _, b, _ in found]), np.hstack([c for _, _, c in found])
    assert is_positive_real(A, B, C, np.array([[feedthrough]])) == passive


def test_an_unstable_system_is_not_positive_real():
    A, B, C = resonator(10.0, -0.01)
    assert not is_positive_real(A, B, C, np.zeros((1, 1)))


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        ({"order": 20, "tolerance": 1e-3}, "give one of the two"),
        ({"order": 0}, "order: 0 is not a number of coordinates"),
        ({"order": 2.5}, "order: 2.5 is not"),
        ({"order": True}, "order: True is not"),
        ({"tolerance": 0.0}, "tolerance: 0.0 is not a relative error"),
        ({"tolerance": float("nan")}, "tolerance: nan is not"),
        ({"tolerance": "1e-3"}, "tolerance: '1e-3' is not"),
        ({"order": 20, "method": "magic"}, "there is no method 'magic'"),
        ({"order": 20, "band": (500.0, 100.0)}, "band: 500 to 100 Hz is none"),
        ({"order": 20, "band": (0.0, 100.0)}, "band: 0 to 100 Hz is none"),
        ({"order": 20, "band": 100.0}, "is not a pair of frequencies"),
        ({"order": 2, "method": "craig_bampton"}, "constraint modes"),
        ({"order": "a"}, "order: 'a' is not"),
        ({"band": ("a", 5.0)}, "is not a pair of frequencies"),
    ],
)
def test_requests_that_do_not_fit(model, request_, words):
    with pytest.raises(gp.InputError, match=words):
        gp.reduce(model, **request_)


@pytest.mark.parametrize("function", [gp.reduce, gp.state_space])
def test_what_is_no_model(function):
    with pytest.raises(gp.InputError, match=r"model: str is no Model; give what gearpath\.load returns"):
        function("models/gearbox.toml")


def test_without_ports_nothing_can_be_taken_out():
    A = np.array([[-1.0]])
    assert is_positive_real(A, np.zeros((1, 0)), np.zeros((0, 1)), np.zeros((0, 0)))


def test_a_free_machine_cannot_be_balanced():
    with pytest.raises(gp.InputError, match="every motion dies away"):
        gp.reduce(gp.load(MODELS / "helical_gearbox.toml"), order=40, method="balanced")
