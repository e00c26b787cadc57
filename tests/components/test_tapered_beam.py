"""Tapered shafts: static deflection and frequencies of cones in closed form, convergence, the limit of no taper."""

import numpy as np
import pytest
import scipy.linalg
from scipy import integrate
from scipy.optimize import brentq
from scipy.special import iv, jv, kv, yv

from gearpath.components import DOFS, Material, Section, Shaft
from gearpath.components.beam import BEAMS, beam_element, beam_shapes
from gearpath.components.dofs import rigid_motion
from gearpath.components.shaft_mesh import mesh_shaft
from gearpath.components.tapered_beam import tapered_element, tapered_shapes

STEEL = Material(2.07e11, 0.3, 7850.0)
E, G, KAPPA = STEEL.youngs_modulus, STEEL.shear_modulus, 0.886
L, D1, D2 = 0.3, 0.02, 0.05  # a cone, thick at its far end
CONE = Section(L, D1, outer_end=D2)
X1, X2 = D1 * L / (D2 - D1), D2 * L / (D2 - D1)  # its ends, counted from the apex


def clamped_at_the_thick_end(section, elements, dofs, beam="timoshenko", kappa=KAPPA):
    mesh = mesh_shaft(Shaft(STEEL, (0, 0, 0), (section,), kappa, (elements,), (), beam), [], dofs)
    keep = slice(0, mesh.size - len(dofs))
    return mesh.stiffness[keep, keep], mesh.mass[keep, keep]


@pytest.mark.parametrize("elements", [1, 3])
def test_deflection_of_a_tapered_cantilever_is_exact(elements):
    """Loads at the thin end, bending 64 P L^3 / (3 pi E D1 D2^3) (Gere, Mechanics of Materials, 9.7) and others."""
    K, _ = clamped_at_the_thick_end(CONE, elements, DOFS)
    tip = np.linalg.inv(K)[:6, :6]
    bending, shear = 64 * L**3 / (3 * np.pi * E * D1 * D2**3), 4 * L / (np.pi * KAPPA * G * D1 * D2)
    np.testing.assert_allclose([tip[0, 0], tip[1, 1]], bending + shear, rtol=1e-10)
    np.testing.assert_allclose(tip[2, 2], 4 * L / (np.pi * E * D1 * D2), rtol=1e-10)
    k = (D2 - D1) / L
    cubes = (1 / D1**3 - 1 / D2**3) / (3 * k)  # int ds/D^4
    np.testing.assert_allclose(tip[5, 5], 32 / (np.pi * G) * cubes, rtol=1e-10)
    np.testing.assert_allclose([tip[3, 3], tip[4, 4]], 64 / (np.pi * E) * cubes, rtol=1e-10)
    first = ((1 / D1**2 - 1 / D2**2) / 2 - D1 * (1 / D1**3 - 1 / D2**3) / 3) / k**2  # int s ds/D^4
    np.testing.assert_allclose([-tip[0, 4], tip[1, 3]], 64 / (np.pi * E) * first, rtol=1e-10)


def test_hollow_taper_against_quadrature():
    """Both diameters vary, the shear coefficient with them (Cowper's): the integrals of the unit-load method."""
    section, nu = Section(L, 0.04, 0.01, 0.06, 0.05), 0.3
    K, _ = clamped_at_the_thick_end(section, 2, ("uy", "rx"), kappa=None)

    def compliance(s):
        D, d = 0.04 + 0.02 * s / L, 0.01 + 0.04 * s / L
        m2 = (d / D) ** 2
        kappa = 6 * (1 + nu) * (1 + m2) ** 2 / ((7 + 6 * nu) * (1 + m2) ** 2 + (20 + 12 * nu) * m2)
        A, I = np.pi * (D**2 - d**2) / 4, np.pi * (D**4 - d**4) / 64  # noqa: E741
        return s**2 / (E * I) + 1 / (kappa * G * A)

    expected = integrate.quad(compliance, 0, L, epsabs=0, epsrel=1e-12)[0]
    assert np.linalg.inv(K)[0, 0] == pytest.approx(expected, rel=1e-9)


def frequencies(section, elements, dofs, count, beam="timoshenko"):
    values = scipy.linalg.eigh(*clamped_at_the_thick_end(section, elements, dofs, beam), eigvals_only=True)
    return np.sqrt(values[:count])


def roots(function, low, high, count):
    grid = np.linspace(low, high, 2000)
    values = np.array([function(x) for x in grid])
    at = np.flatnonzero(values[:-1] * values[1:] < 0)[:count]
    return np.array([brentq(function, grid[k], grid[k + 1], xtol=1e-13) for k in at])


def cone_cantilever(count):
    """Angular frequencies of the Euler-Bernoulli cone clamped at its thick end (Kirchhoff 1879), by Bessel functions.

    With x from the apex, D^2(x^4 D^2 w) = p^4 x^2 w, p^4 = w^2 rho A2 X2^2 / (E I2), is solved by z^-2 Z2(z), Z one of
    J, Y, I, K and z = 2 p sqrt(x); derivatives shift the order, D^k w = (-+ 2 p^2)^k z^(-2-k) Z(2+k).
    Clamped: w = D w = 0; free: D^2 w = D^3 w = 0.
    """
    solutions = ((jv, -1.0), (yv, -1.0), (iv, 1.0), (kv, -1.0))

    def determinant(p):
        rows = []
        for x, orders in ((X2, (2, 3)), (X1, (4, 5))):
            z = 2.0 * p * np.sqrt(x)
            rows += [[sign**n * Z(n, z) for Z, sign in solutions] for n in orders]
        return np.linalg.det(np.array(rows) / abs(np.array(rows)).max(axis=0))

    p = roots(determinant, 1.0 / np.sqrt(X2), 12.0 / np.sqrt(X2), count)
    end = CONE.at(1.0)
    return p**2 * np.sqrt(E * end.area_moment / (STEEL.density * end.area)) / X2


def test_bending_frequencies_of_a_cone_converge_to_the_bessel_functions_as_h_to_the_fourth():
    exact = cone_cantilever(3)
    errors = np.array([frequencies(CONE, n, ("uy", "rx"), 3, "euler") / exact - 1 for n in (8, 16, 32)])
    assert np.all((errors > 0.0) & (errors[-1] < 1e-5))  # from above: the shape functions are admissible
    orders = np.log2(errors[:-1] / errors[1:])
    assert np.all((orders > 3.5) & (orders < 4.5))


def test_a_sharp_cone_has_its_known_frequencies():
    """Euler-Bernoulli cone to a point: w = (8.719, 21.15, 38.45) sqrt(E I/(rho A)) / L^2 of the clamp (Kirchhoff)."""
    sharp = Section(0.998 * L, 0.002 * D2, outer_end=D2)  # without its last 0.2 %, which hardly move anything
    end = sharp.at(1.0)
    unit = np.sqrt(E * end.area_moment / (STEEL.density * end.area)) / L**2
    found = frequencies(sharp, 60, ("uy", "rx"), 3, "euler")
    np.testing.assert_allclose(found / unit, [8.719, 21.15, 38.45], rtol=3e-4)


def test_axial_and_torsional_frequencies_of_a_cone():
    """Fixed at the thick end: D(x^2 D u) = -k^2 x^2 u and D(x^4 D phi) = -k^2 x^4 phi."""

    def axial(k):  # u = sin(k (X2 - x)) / x, D u = 0 at X1
        return k * X1 * np.cos(k * (X2 - X1)) + np.sin(k * (X2 - X1))

    def torsional(k):  # phi = x^-1.5 Z1.5(k x), D phi = -k x^-1.5 Z2.5(k x)
        return jv(2.5, k * X1) * yv(1.5, k * X2) - yv(2.5, k * X1) * jv(1.5, k * X2)

    for dof, equation, speed in (("uz", axial, np.sqrt(E / 7850.0)), ("rz", torsional, np.sqrt(G / 7850.0))):
        exact = speed * roots(equation, 0.5 / L, 12.0 / L, 3)
        errors = np.array([frequencies(CONE, n, (dof,), 3) / exact - 1 for n in (8, 16, 32)])
        assert np.all((errors > 0.0) & (errors[-1] < 3e-3))
        orders = np.log2(errors[:-1] / errors[1:])
        assert np.all((orders > 1.8) & (orders < 2.2)), dof


def test_thick_cone_frequencies_agree_with_many_short_constant_sections():
    """A second method, for Timoshenko: 200 steps, with an error of order h^2."""
    steps = tuple(CONE.part(k / 200, (k + 1) / 200).at(0.5) for k in range(200))
    mesh = mesh_shaft(Shaft(STEEL, (0, 0, 0), steps, KAPPA, (1,)), [], ("uy", "rx"))
    values = scipy.linalg.eigh(mesh.stiffness[:-2, :-2], mesh.mass[:-2, :-2], eigvals_only=True)
    np.testing.assert_allclose(frequencies(CONE, 50, ("uy", "rx"), 3), np.sqrt(values[:3]), rtol=1e-3)


@pytest.mark.parametrize("beam", BEAMS)
def test_a_vanishing_taper_is_the_constant_element(beam):
    constant, almost = Section(L, 0.05, 0.02), Section(L, 0.05, 0.02, 0.05 * (1 + 1e-13), 0.02)
    assert almost.tapered
    pairs = zip(tapered_element(beam, almost, STEEL, L, KAPPA), beam_element(beam, constant, STEEL, L, KAPPA))
    for found, expected in pairs:
        scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
        np.testing.assert_allclose(found / scale, expected / scale, atol=1e-11)
    shapes = tapered_shapes(beam, 0.3, almost, STEEL, L, KAPPA)
    np.testing.assert_allclose(shapes, beam_shapes(beam, 0.3, constant, STEEL, L, KAPPA)[0], atol=1e-11)


@pytest.mark.parametrize("beam", BEAMS)
def test_rigid_motion_costs_nothing_and_carries_the_mass_of_the_frustum(beam):
    K, M = tapered_element(beam, CONE, STEEL, L, KAPPA)
    both = np.vstack([rigid_motion(np.array([0.0, 0.0, z])) for z in (0.0, L)])
    np.testing.assert_allclose(K @ both, 0.0, atol=1e-9 * abs(K).max())
    moved = both.T @ M @ both
    mass = STEEL.density * np.pi * L / 12 * (D1**2 + D1 * D2 + D2**2)
    np.testing.assert_allclose(np.diag(moved)[:3], mass, rtol=1e-12)
    centre = L / 4 * (D1**2 + 2 * D1 * D2 + 3 * D2**2) / (D1**2 + D1 * D2 + D2**2)  # of a frustum, from its thin end
    np.testing.assert_allclose([moved[0, 4], -moved[1, 3]], mass * centre, rtol=1e-12)
    polar = STEEL.density * np.pi / 32 * L * (D2**5 - D1**5) / (5 * (D2 - D1))
    assert moved[5, 5] == pytest.approx(polar, rel=1e-12)


def test_a_probe_within_a_tapered_element_reads_the_exact_deflection():
    """Clamped at the thick end, force at the thin one: the deflection by quadrature of the unit-load integral."""
    mesh = mesh_shaft(Shaft(STEEL, (0, 0, 0), (CONE,), KAPPA, (2,)), [], ("uy", "rx"))
    q = np.zeros(mesh.size)
    q[:-2] = np.linalg.solve(mesh.stiffness[:-2, :-2], np.eye(mesh.size - 2)[0])
    for at in (0.2 * L, 0.77 * L):

        def compliance(s, at=at):
            here = CONE.at(s / L)
            return s * (s - at) / (E * here.area_moment) + 1 / (KAPPA * G * here.area)

        expected = integrate.quad(compliance, at, L, epsabs=0, epsrel=1e-12)[0]
        assert (mesh.motion(at) @ q)[1] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("beam", ["mindlin_reduced", "mindlin_full"])
def test_mindlin_cones_converge_to_the_exact_deflection_as_h_squared(beam):
    exact = 64 * L**3 / (3 * np.pi * E * D1 * D2**3) + 4 * L / (np.pi * KAPPA * G * D1 * D2)
    tips = [np.linalg.inv(clamped_at_the_thick_end(CONE, n, ("uy", "rx"), beam)[0])[0, 0] for n in (32, 64, 128)]
    errors = abs(np.array(tips) / exact - 1)
    orders = np.log2(errors[:-1] / errors[1:])
    assert np.all((orders > 1.9) & (orders < 2.1))


def test_parts_and_equal_ends():
    assert not Section(L, 0.05, 0.02, 0.05, 0.02).tapered
    part = CONE.part(0.25, 0.75)
    assert (part.length, part.outer, part.outer_end) == pytest.approx((0.15, 0.0275, 0.0425))
