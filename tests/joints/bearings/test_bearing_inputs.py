"""Every constructor argument is checked, and the message names it; damping."""

import numpy as np
import pytest

from gearpath.errors import InputError
from gearpath.joints.bearings import BallBearing, RollerBearing, loss_factor_damping, proportional_damping

BALL = {
    "balls": 9,
    "ball_diameter": 8e-3,
    "pitch_diameter": 40e-3,
    "inner_conformity": 0.52,
    "outer_conformity": 0.52,
    "contact_angle": 0.3,
}
ROLLER = {"rollers": 9, "roller_length": 0.01, "pitch_radius": 0.03, "contact_angle": 0.1, "slices": 5}
NAN, INF = float("nan"), float("inf")


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("balls", [0, -1, 2.5, True, "9", None, 16]),
        ("ball_diameter", [0.0, -1.0, NAN, INF, "a", None]),
        ("pitch_diameter", [0.0, -1.0, NAN, INF, "a"]),
        ("inner_conformity", [0.5, 1.0, NAN, "a", 52.0]),
        ("outer_conformity", [0.5, 1.0, NAN, None]),
        ("contact_angle", [40.0, -2.0, NAN, "a"]),
        ("radial_clearance", [1e-6, NAN, "a"]),
        ("youngs_modulus", [0.0, NAN, -206e9]),
        ("poisson_ratio", [-0.1, 0.5, NAN]),
        ("phase", [NAN, INF, None]),
        ("reference", ["middle", None]),
    ],
)
def test_ball_bearings_that_cannot_be(name, values):
    for value in values:
        with pytest.raises(InputError) as caught:
            BallBearing(**{**BALL, name: value})
        assert str(caught.value).startswith(f"{name}: ")


@pytest.mark.parametrize("clearance", [10.0, 0.4e-3, -0.4e-3])
def test_clearance_beyond_the_grooves(clearance):
    with pytest.raises(InputError, match=r"radial_clearance: .* micrometres"):
        BallBearing(**{**BALL, "contact_angle": 0.0, "radial_clearance": clearance})


def test_a_single_ball_larger_than_its_circle():
    with pytest.raises(InputError, match="do not fit"):
        BallBearing(1, 0.05, 0.04, 0.52, 0.52, 0.0)


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("rollers", [0, 1.5, None]),
        ("roller_length", [0.0, NAN, "a"]),
        ("pitch_radius", [0.0, -1.0, INF]),
        ("contact_angle", [np.pi / 2, 15.0, NAN, "a"]),
        ("slices", [0, 3.0, True]),
        ("radial_clearance", [5.0, -5.0, NAN]),
        ("profile", [[0.0], [0, 0, 0, 0, -1e-6], [0, 0, 0, 0, NAN], 3.0, "abcde", lambda x: x, lambda x: x * x + INF]),
        ("phase", [NAN, "a"]),
        ("contact_stiffness", [0.0, -1.0, NAN, "a"]),
    ],
)
def test_roller_bearings_that_cannot_be(name, values):
    for value in values:
        with pytest.raises(InputError) as caught:
            RollerBearing(**{**ROLLER, name: value})
        assert str(caught.value).startswith(name)


def test_profile_as_array_and_as_function():
    places = 0.01 * (np.arange(5) - 2) / 5
    bent = RollerBearing(**ROLLER, profile=lambda x: x**2)
    np.testing.assert_array_equal(
        RollerBearing(**ROLLER, profile=places**2).stiffness([2e-5, 0, 0, 0, 1e-4, 0]),
        bent.stiffness([2e-5, 0, 0, 0, 1e-4, 0]),
    )


def test_damping_dissipates_what_it_says():
    """A cycle of amplitude x takes pi w x^T C x; a loss factor means pi eta x^T K x at its frequency."""
    K = BallBearing(**BALL).stiffness([1e-5, 0, 3e-5, 0, 0, 0])
    x, w = np.array([1e-6, 2e-6, 0, 1e-5, 0, 0]), 2 * np.pi * 700.0
    C = loss_factor_damping(K, 0.04, 700.0)
    assert np.pi * w * x @ C @ x == pytest.approx(np.pi * 0.04 * x @ K @ x, rel=1e-12)
    np.testing.assert_allclose(proportional_damping(K, 2e-6), K * 2e-6, rtol=1e-14)


@pytest.mark.parametrize(
    ("make", "name"),
    [
        (lambda: proportional_damping(np.eye(6), -1.0), "time"),
        (lambda: proportional_damping(np.eye(6), NAN), "time"),
        (lambda: loss_factor_damping(np.eye(6), -0.1, 50.0), "loss_factor"),
        (lambda: loss_factor_damping(np.eye(6), NAN, 50.0), "loss_factor"),
        (lambda: loss_factor_damping(np.eye(6), 0.1, 0.0), "frequency"),
    ],
)
def test_damping_that_is_refused(make, name):
    with pytest.raises(InputError, match=f"^{name}: "):
        make()
