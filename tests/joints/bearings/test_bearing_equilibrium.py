"""Displacements under load: residuals by the oracle, reactions, refusals and warnings."""

from dataclasses import replace

import bearing_oracles as oracles
import numpy as np
import pytest
from bearing_cases import KINDS, random_displacement, random_pair
from scipy.integrate import quad_vec

from gearpath.errors import InputError
from gearpath.joints.bearings import BallBearing, RollerBearing, back_to_back

NAMES = ("ux", "uy", "uz", "rx", "ry")
ANGULAR = BallBearing(14, 12.7e-3, 70e-3, 0.515, 0.525, 0.45)
CYLINDER = RollerBearing(13, 0.012, 0.04, 0.0)


def _cases(number):
    """Random bearings of all kinds under random loads that they can carry, at random free degrees of freedom."""
    rng = np.random.default_rng(20)
    while number:
        ours, oracle = random_pair(KINDS[number % 5], rng)
        q = random_displacement(ours, rng)
        chosen = np.sort(rng.choice(5, int(rng.integers(1, 6)), replace=False))
        kept = np.where(np.isin(np.arange(5), chosen), q[:5], 0.0)
        f = oracles.load(oracle, kept).real
        unit = np.array([1, 1, 1, ours.lever, ours.lever])
        if np.abs(f / unit)[chosen].max() > 1e-3 * np.abs(f / unit).max() and np.abs(f).max() > 1.0:
            number -= 1
            yield ours, oracle, chosen, f, unit


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_a_thousand_random_loads_from_a_cold_start():
    iterations = []
    for ours, oracle, chosen, f, unit in _cases(1000):
        found = ours.equilibrium({NAMES[i]: float(f[i]) for i in chosen})
        carried = oracles.load(oracle, found.displacement[:5]).real
        size = np.abs(f / unit)[chosen].max()
        assert np.abs((carried - f) / unit)[chosen].max() < 1e-9 * size
        assert found.residual < 1e-9
        held = np.setdiff1d(np.arange(6), chosen)
        assert not found.displacement[held].any()
        assert np.abs(found.load[:5] - carried).max() <= 1e-9 * np.abs(carried).max()
        iterations.append(found.iterations)
    median = np.median(iterations)
    assert median <= 12, f"median {median}, most {max(iterations)} linear solves"


def test_result_holds_what_it_says():
    found = ANGULAR.equilibrium({"ux": 2000.0, "uz": 3000.0})
    q = found.displacement
    np.testing.assert_array_equal(found.stiffness, ANGULAR.stiffness(q))
    np.testing.assert_array_equal(found.element_loads, ANGULAR.contacts(q).load)
    np.testing.assert_array_equal(found.contact_angles, ANGULAR.contacts(q).angle)
    assert found.loaded == (found.element_loads > 0).sum() == 14 - (found.element_loads == 0).sum()
    assert found.load[[0, 2]] == pytest.approx([2000, 3000], rel=1e-9)
    assert abs(found.load[4]) > 1.0  # the reaction of the tilt that was held
    again = ANGULAR.equilibrium({"ux": 2000.0, "uz": 3000.0}, start=q)
    assert again.iterations == 0
    moved = ANGULAR.equilibrium({"ux": 2000.0, "uz": 3000.0}, start=q + 1e-5)  # what is held returns to zero
    np.testing.assert_allclose(moved.displacement, q, atol=1e-13)
    with_tilt = ANGULAR.equilibrium({"ux": 2000.0, "uz": 3000.0, "ry": found.load[4], "uy": 0.0, "rx": 0.0})
    np.testing.assert_allclose(with_tilt.displacement, q, atol=1e-12)


def test_an_unsupported_direction_without_load_stays():
    found = CYLINDER.equilibrium({"ux": 1000.0, "uz": 0.0})
    assert found.displacement[2] == 0.0
    assert found.load[0] == pytest.approx(1000.0, rel=1e-9)


@pytest.mark.parametrize(
    ("bearing", "load", "words"),
    [
        (CYLINDER, {"ux": 100.0, "uz": 5.0}, "comes apart along uz"),
        (RollerBearing(13, 0.012, 0.04, 0.3), {"uz": -100.0}, "cannot carry uz = -100"),
        (RollerBearing(13, 0.012, 0.04, 0.3), {"uz": 0.0, "ux": 100.0}, "comes apart along uz"),
        (RollerBearing(13, 0.012, 0.04, 0.0, slices=1), {"rx": 3.0}, "comes apart along rx"),
        (ANGULAR, {"uz": 0.0}, "zero leaves a bearing without preload"),
        (ANGULAR, {}, "names no degree of freedom"),
        (ANGULAR, {"uz": float("nan")}, "uz: nan must be a finite number"),
        (ANGULAR, {"uz": float("inf")}, "uz: inf must be a finite number"),
        (ANGULAR, {"uz": "much"}, "uz: 'much' must be a finite number"),
        (ANGULAR, {"fz": 3.0}, "no degree of freedom 'fz'; use ux, uy, uz, rx, ry"),
        (ANGULAR, {"rz": 3.0}, "turns freely about its axis"),
        (ANGULAR, [1.0, 2.0], "by name"),
    ],
)
def test_loads_that_are_refused(bearing, load, words):
    with pytest.raises(InputError) as caught:
        bearing.equilibrium(load)
    assert words in str(caught.value)


@pytest.mark.parametrize("start", [np.zeros(5), np.zeros((2, 6)), [0, 0, np.nan, 0, 0, 0]])
def test_start_and_speed_are_checked(start):
    with pytest.raises(InputError):
        ANGULAR.equilibrium({"uz": 100.0}, start=start)
    with pytest.raises(InputError, match="speed: nan"):
        ANGULAR.equilibrium({"uz": 100.0}, speed=float("nan"))


def test_interference_and_preload_need_no_outer_load():
    tight = RollerBearing(13, 0.012, 0.04, 0.0, radial_clearance=-5e-6)
    assert tight.equilibrium({"ux": 0.0}).loaded == 13
    pair = back_to_back(ANGULAR, 0.03, 2e-5)
    start = pair.equilibrium({"uz": 0.0}, start=[0, 0, 3e-6, 0, 0, 0])
    assert abs(start.displacement[2]) < 1e-13
    small = pair.equilibrium({"uz": 1e-3})  # a millionth of what the balls carry
    assert small.displacement[2] == pytest.approx(1e-3 / start.stiffness[2, 2], rel=1e-5)


def test_centrifugal_warning_starts_at_two_percent_of_the_load():
    D, pitch, load = 12.7e-3, 70e-3, {"uz": 500.0}
    still = ANGULAR.equilibrium(load)
    assert still.notes == ()
    mass, gamma = 7800 * np.pi / 6 * D**3, D * np.cos(still.contact_angles[0]) / pitch
    cage = np.sqrt(0.02 * still.element_loads[0] / (mass * pitch / 2))
    speed = cage / (0.5 * (1 - gamma)) * 30 / np.pi
    assert ANGULAR.equilibrium(load, speed=0.999 * speed).notes == ()
    with pytest.warns(UserWarning, match=r"centrifugal force on an element is 0\.02 of"):
        found = ANGULAR.equilibrium(load, speed=-1.001 * speed)
    assert len(found.notes) == 1
    with pytest.warns(UserWarning, match="at most"):
        CYLINDER.equilibrium({"ux": 100.0}, speed=20000.0)
    assert CYLINDER.equilibrium({"ux": 100.0}, speed=20.0).notes == ()


def test_ellipse_and_wrong_side_warnings():
    with pytest.warns(UserWarning, match="cut off at 52 degrees"):
        ANGULAR.equilibrium({"uz": 2e5})
    with pytest.warns(UserWarning, match="other side of the groove"):
        found = ANGULAR.equilibrium({"uz": -500.0})
    assert (found.contact_angles < 0).all()
    other = ANGULAR.mirrored()
    assert other.equilibrium({"uz": -500.0}).notes == ()


def test_phase_average_under_load_warns_once():
    with pytest.warns(UserWarning, match="contact ellipse") as caught:
        ANGULAR.phase_average({"uz": 2e5}, samples=6)
    inner_and_outer = 2
    assert len(caught) <= inner_and_outer
    with pytest.raises(InputError, match="samples: 0"):
        ANGULAR.phase_average({"uz": 100.0}, samples=0)


def test_phase_average_covers_one_pitch_evenly():
    """The mean over the angle of the first ball, by quadrature; half a pitch, or uneven places, would miss it."""
    few = replace(ANGULAR, balls=5, contact_angle=0.3)
    q, pitch = np.array([2e-5, 1e-5, 5e-6, 0, 0, 0]), 2.0 * np.pi / 5

    def mean(end):
        return quad_vec(lambda phase: replace(few, phase=phase).stiffness(q), 0.0, end, epsrel=1e-6)[0] / end

    whole = mean(pitch)
    size = np.abs(whole[:3, :3]).max()
    assert np.abs(few.phase_average(q, samples=256) - whole)[:3, :3].max() < 1e-4 * size
    assert np.abs(mean(0.5 * pitch) - whole)[:3, :3].max() > 1e-2 * size
