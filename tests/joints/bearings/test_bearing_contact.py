"""Contact constants against complete elliptic integrals, the circular closed form, Brewe and Hamrock, Palmgren."""

import numpy as np
import pytest
from bearing_oracles import ball_constant, hertz
from scipy.special import ellipe, ellipk

from gearpath.joints.bearings import BallBearing, RollerBearing
from gearpath.joints.bearings.contact import (
    LINE,
    axis_ratio,
    effective_modulus,
    in_series,
    line_constant,
    point_contact,
    semi_major_axis,
)

MODULUS = effective_modulus(206e9, 0.3)
RATIOS = np.geomspace(1.3, 300.0, 25)


def test_effective_modulus_of_steel_on_steel():
    assert pytest.approx(1 / (2 * (1 - 0.3**2) / 206e9), rel=1e-14) == MODULUS


@pytest.mark.parametrize("ratio", RATIOS)
def test_point_contact_equals_the_form_in_complete_elliptic_integrals(ratio):
    Rx = 4e-3
    assert point_contact(Rx, ratio * Rx, MODULUS) == pytest.approx(
        hertz((1 / Rx, 1 / (ratio * Rx)), MODULUS), rel=1e-11
    )


def test_circular_contact_closed_form():
    """Sphere on a plane: Q = 4/3 E* sqrt(R) d^1.5, a^3 = 3 Q R / (4 E*)."""
    R, Q = 5e-3, 300.0
    for radius in (R, R * (1 + 1e-9)):
        assert point_contact(R, radius, MODULUS) == pytest.approx(4 / 3 * MODULUS * np.sqrt(R), rel=1e-8)
        assert semi_major_axis(R, radius, MODULUS, Q) == pytest.approx((3 * Q * R / (4 * MODULUS)) ** (1 / 3), rel=1e-8)
    assert axis_ratio(R, R) == 1.0


@pytest.mark.parametrize("ratio", RATIOS)
def test_contact_ellipse_closed_form(ratio):
    """a = (6 k^2 E Q / (pi sum E'))^(1/3) with 1/E* in place of 2 / E', k^2 = 1 / m (Hamrock and Brewe's notation)."""
    Rx, Q = 4e-3, 800.0
    m = axis_ratio(Rx, ratio * Rx)
    second = ellipe(1 - m)
    R = 1 / (1 / Rx + 1 / (ratio * Rx))
    wanted = (3 * second * Q * R / (np.pi * m * MODULUS)) ** (1 / 3)
    assert semi_major_axis(Rx, ratio * Rx, MODULUS, Q) == pytest.approx(wanted, rel=1e-10)
    # the ratio of the axes solves (k^2 E - K) / (K - E) = Ry / Rx, Hertz's condition
    first = ellipk(1 - m)
    assert (second / m - first) / (first - second) == pytest.approx(ratio, rel=1e-9)


@pytest.mark.parametrize("ratio", np.geomspace(1.3, 100.0, 12))
def test_brewe_and_hamrock_fit_within_nine_percent(ratio):
    """k = 1.0339 (Ry/Rx)^0.636, E = 1.0003 + 0.5968 Rx/Ry, F = 1.5277 + 0.6023 ln(Ry/Rx)."""
    Rx, Ry = 4e-3, 4e-3 * ratio
    k, second, first = 1.0339 * ratio**0.636, 1.0003 + 0.5968 / ratio, 1.5277 + 0.6023 * np.log(ratio)
    R, fitted = 1 / (1 / Rx + 1 / Ry), 2 * MODULUS
    approximate = np.pi * k * fitted * np.sqrt(R * second / (4.5 * first**3))
    assert point_contact(Rx, Ry, MODULUS) == pytest.approx(approximate, rel=0.09)


def test_ball_bearing_has_both_contacts_in_series():
    geometry = (9.525e-3, 46e-3, 0.515, 0.53)
    for angle in (0.0, 0.4, -0.4, np.pi / 2):
        ours = BallBearing(9, *geometry, angle)
        assert ours.contact_stiffness == pytest.approx(ball_constant(*geometry, angle), rel=1e-11)
    soft = BallBearing(9, *geometry, 0.4, youngs_modulus=310e9, poisson_ratio=0.26)
    assert soft.contact_stiffness == pytest.approx(ball_constant(*geometry, 0.4, 310e9, 0.26), rel=1e-11)


def test_displacements_of_contacts_in_series_add():
    inner, outer, Q = 3e9, 5e9, 1234.0
    for n in (1.5, LINE):
        both = (Q / inner) ** (1 / n) + (Q / outer) ** (1 / n)
        assert (Q / in_series(inner, outer, n)) ** (1 / n) == pytest.approx(both, rel=1e-13)


def test_line_contact_iso_and_palmgren():
    """Palmgren: d[mm] = 3.84e-5 Q^0.9 / L^0.8 a contact, two of them 37310 L^(8/9); ISO/TS 16281 is 4 % softer."""
    L, Q = 17.0, 2500.0  # mm, N
    palmgren = Q / (2 * 3.84e-5 * Q**0.9 / L**0.8) ** LINE  # N/mm^(10/9)
    assert palmgren == pytest.approx(37310 * L ** (8 / 9), rel=2e-4)
    iso = line_constant(L * 1e-3) / 1e3**LINE
    assert iso == pytest.approx(35948 * L ** (8 / 9), rel=1e-12)
    assert iso / palmgren == pytest.approx(35948 / 37310, rel=2e-4)
    roller = RollerBearing(8, L * 1e-3, 0.05, 0.0, slices=1)
    d = (Q / (35948 * L ** (8 / 9))) ** 0.9 * 1e-3  # m
    assert roller.contacts([d, 0, 0, 0, 0, 0]).load[0] == pytest.approx(Q, rel=1e-12)
    assert RollerBearing(8, 0.017, 0.05, 0.0, contact_stiffness=4e8).roller_stiffness == 4e8
