"""Exact facts of the theory: closed forms, scale laws, slopes, rank and symmetries."""

from dataclasses import replace
from math import cos, pi, radians, sin, tan

import numpy as np
import pytest
from bearing_cases import KINDS, random_displacement, random_pair, scaled

from gearpath.joints.bearings import BallBearing, RollerBearing

ANGULAR = BallBearing(14, 12.7e-3, 70e-3, 0.515, 0.525, radians(25), phase=0.3)
GROOVE = BallBearing(9, 7.938e-3, 38.5e-3, 0.52, 0.52, 0.0)
TAPER = RollerBearing(18, 0.016, 0.04, radians(14), phase=0.2)
MIRROR = np.array([1.0, 1.0, -1.0, -1.0, -1.0, 1.0])


def close(found, wanted, rel=1e-9):
    found, wanted = np.asarray(found), np.asarray(wanted)
    assert np.abs(found - wanted).max() <= rel * np.abs(wanted).max()


def rank(bearing, q):
    values = np.linalg.svd(scaled(bearing.stiffness(q), bearing.lever), compute_uv=False)
    return int((values > 1e-10 * values[0]).sum())


@pytest.mark.parametrize("uz", [2e-6, 2e-5, 1e-4])
def test_axially_loaded_ball_bearing_closed_form(uz):
    Z, A0, a0, r = 14, 0.04 * 12.7e-3, radians(25), 35e-3 + 0.015 * 12.7e-3 * cos(radians(25))
    A = np.hypot(A0 * cos(a0), A0 * sin(a0) + uz)
    a = np.arctan(tan(a0) + uz / (A0 * cos(a0)))
    Kn = ANGULAR.contact_stiffness
    d = (2 * A0 * uz * sin(a0) + uz**2) / (A + A0)
    Q, slope = Kn * d**1.5, 1.5 * Kn * d**0.5
    K = np.zeros((6, 6))
    K[2, 2] = Z * (slope * sin(a) ** 2 + Q / A * cos(a) ** 2)
    K[0, 0] = K[1, 1] = Z / 2 * (slope * cos(a) ** 2 + Q / A * sin(a) ** 2)
    K[1, 3] = K[3, 1] = Z * r / 2 * (slope - Q / A) * sin(a) * cos(a)
    K[0, 4] = K[4, 0] = -K[1, 3]
    K[3, 3] = K[4, 4] = r**2 * K[2, 2] / 2
    q = [0, 0, uz, 0, 0, 0]
    close(scaled(ANGULAR.stiffness(q), r), scaled(K, r))
    close(ANGULAR.contacts(q).angle, np.full(Z, a))
    close(ANGULAR.load(q), [0, 0, Z * Q * sin(a), 0, 0, 0])
    assert ANGULAR.lever == pytest.approx(r, rel=1e-14)


def test_stiffness_of_balls_goes_with_the_cube_root_of_small_loads_only():
    def slope(force):
        K = [ANGULAR.equilibrium({"uz": f}).stiffness[2, 2] for f in (force, 1.001 * force)]
        return np.log(K[1] / K[0]) / np.log(1.001)

    assert slope(1e-3) == pytest.approx(1 / 3, abs=1e-4)
    assert slope(1e4) > 0.35


@pytest.mark.parametrize("slices", [1, 31])
def test_stiffness_of_rollers_goes_with_the_tenth_root_of_all_loads(slices):
    bearing = replace(TAPER, slices=slices)
    for force in (1.0, 1e3, 1e5):
        pair = [bearing.equilibrium({"uz": f}).stiffness for f in (force, 7 * force)]
        close(pair[1], 7**0.1 * pair[0])


def test_axial_load_of_a_deep_groove_bearing():
    """F = Z Kn uz^4 / (2^1.5 A0^2.5), a stiffness that goes with F^(3/4), as the displacement vanishes."""
    A0 = GROOVE.groove_distance
    errors, slopes = [], []
    for uz in (0.02 * A0, 0.01 * A0):
        f = [GROOVE.load([0, 0, u, 0, 0, 0])[2] for u in (uz, 1.001 * uz)]
        K = [GROOVE.stiffness([0, 0, u, 0, 0, 0])[2, 2] for u in (uz, 1.001 * uz)]
        errors.append(f[0] / (9 * GROOVE.contact_stiffness * uz**4 / (2**1.5 * A0**2.5)) - 1)
        slopes.append(np.log(K[1] / K[0]) / np.log(f[1] / f[0]) - 0.75)
    assert abs(errors[1]) < 2e-4
    assert abs(slopes[1]) < 2e-4
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.05)  # and the rest is of second order


@pytest.mark.parametrize("lam", [0.3, 5.0])
@pytest.mark.parametrize("bearing", [ANGULAR, replace(GROOVE, radial_clearance=3e-6), TAPER])
def test_lengths_and_square_roots_of_forces_scale_together(bearing, lam):
    lengths = ("ball_diameter", "pitch_diameter", "roller_length", "pitch_radius", "radial_clearance")
    larger = replace(bearing, **{k: lam * getattr(bearing, k) for k in lengths if hasattr(bearing, k)})
    q = random_displacement(bearing, np.random.default_rng(4)) + np.array([2e-05, 0, 0, 0, 0, 0])
    u, t = np.array([1.0, 1, 1, 0, 0, 0]), np.array([0.0, 0, 0, 1, 1, 1])
    K, scale = bearing.stiffness(q), lam * np.outer(u, u) + lam**2 * (np.outer(u, t) + np.outer(t, u))
    scale += lam**3 * np.outer(t, t)
    close(larger.load(q * (lam * u + t)), bearing.load(q) * (lam**2 * u + lam**3 * t))
    assert np.abs(K).max() > 0
    close(scaled(larger.stiffness(q * (lam * u + t)), larger.lever), scaled(K * scale, larger.lever))


@pytest.mark.parametrize("angle", [0.0, 0.25])
@pytest.mark.parametrize("slices", [1, 8, 31])
def test_load_of_rollers_without_clearance_is_homogeneous(angle, slices):
    """K q = n f, n = 10/9."""
    bearing = RollerBearing(15, 0.02, 0.05, angle, slices)
    for seed in range(20):
        q = np.random.default_rng(seed).normal(size=6) * [1e-5, 1e-5, 1e-5, 1e-4, 1e-4, 0]
        f = bearing.load(q)
        if f.any():
            unit = np.array([1, 1, 1, 0.05, 0.05, 1])
            close(bearing.stiffness(q) @ q / unit, 10 / 9 * f / unit, 1e-12)


def test_axial_stiffness_of_a_radially_loaded_deep_groove_bearing():
    """Kzz = sum Q / A, all of it from the change of the contact angles."""
    q = np.array([1.3e-5, 0.4e-5, 0, 0, 0, 0])
    psi = 2 * pi * np.arange(9) / 9
    d = np.maximum(q[0] * np.cos(psi) + q[1] * np.sin(psi), 0)
    Q = GROOVE.contact_stiffness * d**1.5
    assert GROOVE.stiffness(q)[2, 2] == pytest.approx((Q / (0.04 * 7.938e-3 + d)).sum(), rel=1e-9)


def test_rank():
    q, tilted = np.array([3e-5, 1e-5, 8e-5, 0, 0, 0]), np.array([3e-5, 1e-5, 8e-5, 1e-4, -2e-4, 0])
    for at in (q, tilted):
        assert rank(replace(TAPER, slices=1), at) == 3
        assert rank(TAPER, at) == 5
        assert rank(replace(TAPER, contact_angle=0.0, slices=1), at) == 2
        assert rank(replace(TAPER, contact_angle=0.0), at) == 4
        assert rank(ANGULAR, at) == 5
    block = scaled(replace(TAPER, slices=1).stiffness([0, 0, 5e-5, 0, 0, 0]), TAPER.lever)[np.ix_([1, 3], [1, 3])]
    assert abs(np.linalg.det(block)) < 1e-12 * np.abs(block).max() ** 2


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(5))
def test_turning_the_cage_turns_load_and_stiffness(kind, seed):
    rng = np.random.default_rng(seed)
    bearing, _ = random_pair(kind, rng)
    q, phi = random_displacement(bearing, rng) + np.array([3e-05, 0, 0, 0, 0, 0]), 0.77
    c, s = cos(phi), sin(phi)
    R = np.kron(np.eye(2), [[c, -s, 0], [s, c, 0], [0, 0, 1]])
    turned, unit = bearing.turned(phi), np.array([1, 1, 1, bearing.lever, bearing.lever, 1])
    close(turned.load(R @ q) / unit, R @ bearing.load(q) / unit)
    close(scaled(turned.stiffness(R @ q), bearing.lever), scaled(R @ bearing.stiffness(q) @ R.T, bearing.lever), 1e-8)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(5))
def test_mirrored_bearing(kind, seed):
    """z -> -z: uz, rx and ry change their signs; rollers have their profile from the other end."""
    rng = np.random.default_rng(seed)
    bearing, _ = random_pair(kind, rng)
    q, other = random_displacement(bearing, rng) + np.array([3e-05, 0, 0, 0, 0, 0]), bearing.mirrored()
    unit = np.array([1, 1, 1, bearing.lever, bearing.lever, 1])
    close(other.load(MIRROR * q) / unit, MIRROR * bearing.load(q) / unit)
    wanted = bearing.stiffness(q) * np.outer(MIRROR, MIRROR)
    close(scaled(other.stiffness(MIRROR * q), bearing.lever), scaled(wanted, bearing.lever), 1e-8)
    assert other.contact_angle == -bearing.contact_angle


@pytest.mark.parametrize("clearance", [5e-6, 2e-5])
def test_clearance_is_a_free_contact_angle(clearance):
    """(0, r_L) at uz + A0 sin(a_f) is (a_f, 0) at uz, cos(a_f) = 1 - r_L / A0, but for lever and curvature."""
    A0 = GROOVE.groove_distance
    free = float(np.arccos(1 - clearance / A0))
    loose, angular = replace(GROOVE, radial_clearance=clearance), replace(GROOVE, contact_angle=free)
    for q in ([4e-6, 2e-6, 3e-5, 0, 0, 0], [2e-5, -3e-5, 1e-6, 0, 0, 0], [0, 0, 1e-5, 0, 0, 0]):
        shifted = np.array(q) + np.array([0, 0, A0 * sin(free), 0, 0, 0])
        close(loose.contacts(shifted).angle, angular.contacts(q).angle)
        K, wanted = loose.stiffness(shifted)[:3, :3], angular.stiffness(q)[:3, :3]
        close(K / loose.contact_stiffness, wanted / angular.contact_stiffness)


@pytest.mark.parametrize("slices", [1, 2, 7, 31, 200])
def test_cylindrical_bearing_with_interference(slices):
    """Kthth = (Z/2) Q' (L^2/12) (1 - 1/n_s^2)."""
    Z, L, gap = 12, 0.018, 6e-6
    bearing = RollerBearing(Z, L, 0.035, 0.0, slices, -gap, contact_stiffness=3e8)
    K = bearing.stiffness(np.zeros(6))
    slope = 10 / 9 * 3e8 * gap ** (1 / 9)
    wanted = Z / 2 * slope * L**2 / 12 * (1 - 1 / slices**2)
    assert K[3, 3] == pytest.approx(wanted, rel=1e-9, abs=1e-12 * slope * L**2)
    assert K[4, 4] == pytest.approx(wanted, rel=1e-9, abs=1e-12 * slope * L**2)
    assert K[0, 0] == pytest.approx(Z / 2 * slope, rel=1e-9)


def test_stiffness_depends_on_where_the_balls_stand():
    """6205 with 10 um of diametral clearance, 1 kN along x: Kyy from 3.66e7 to 5.86e7 N/m with the phase."""
    bearing, load = BallBearing(9, 7.938e-3, 38.5e-3, 0.52, 0.52, 0.0, radial_clearance=5e-6), {"ux": 1000.0}
    K = [bearing.turned(2 * pi / 9 * i / 24).equilibrium(load).stiffness[1, 1] for i in range(24)]
    assert min(K) == pytest.approx(3.66e7, rel=0.002)
    assert max(K) == pytest.approx(5.86e7, rel=0.002)
    average = bearing.phase_average(load, samples=24)
    assert average[1, 1] == pytest.approx(np.mean(K), rel=1e-9)
    q = [2e-5, 0, 0, 0, 0, 0]
    mean = np.mean([bearing.turned(2 * pi / 9 * i / 16).stiffness(q) for i in range(16)], axis=0)
    close(bearing.phase_average(q), mean)
