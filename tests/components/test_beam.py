"""The Timoshenko element: static exactness, closed-form frequencies, mass, rigid-body motion."""

import numpy as np
import pytest
import scipy.linalg
from scipy.optimize import brentq

from gearpath.components import DOFS, Material, Section, Shaft
from gearpath.components.beam import BEAMS, beam_element, cubic_shapes
from gearpath.components.dofs import rigid_motion
from gearpath.components.shaft_mesh import mesh_shaft

STEEL = Material(2.07e11, 0.3, 7850.0)
KAPPA = 0.886


def element(length=0.2, diameter=0.05):
    section = Section(length, diameter)
    return section, *beam_element("timoshenko", section, STEEL, length, KAPPA)


@pytest.mark.parametrize("diameter", [0.005, 0.05, 0.2])
def test_one_element_has_the_exact_tip_deflection_of_a_thick_cantilever(diameter):
    section, K, _ = element(0.2, diameter)
    E, G, A, I, L = STEEL.youngs_modulus, STEEL.shear_modulus, section.area, section.area_moment, 0.2  # noqa: E741
    tip = np.linalg.inv(K[6:, 6:])
    for u, theta, sign in ((0, 4, 1.0), (1, 3, -1.0)):
        assert tip[u, u] == pytest.approx(L**3 / (3 * E * I) + L / (KAPPA * G * A), rel=1e-10)
        assert tip[theta, u] == pytest.approx(sign * L**2 / (2 * E * I), rel=1e-10)
        assert tip[theta, theta] == pytest.approx(L / (E * I), rel=1e-10)
    assert tip[2, 2] == pytest.approx(L / (E * A), rel=1e-12)
    assert tip[5, 5] == pytest.approx(L / (G * 2 * I), rel=1e-12)


def test_rigid_motion_costs_nothing_and_carries_the_whole_inertia():
    section, K, M = element()
    both = np.vstack([rigid_motion(np.array([0.0, 0.0, z])) for z in (-0.1, 0.1)])
    np.testing.assert_allclose(K @ both, 0.0, atol=1e-9 * abs(K).max())
    mass = STEEL.density * section.area * 0.2
    slender = STEEL.density * section.area_moment * 0.2 + mass * 0.2**2 / 12
    polar = STEEL.density * 2 * section.area_moment * 0.2
    expected = np.diag([mass, mass, mass, slender, slender, polar])
    np.testing.assert_allclose(both.T @ M @ both, expected, rtol=1e-12, atol=1e-14)


def test_shape_functions_reproduce_the_end_motions():
    for xi, columns in ((0.0, slice(0, 6)), (1.0, slice(6, 12))):
        N, _ = cubic_shapes(xi, 0.3, 0.7)
        expected = np.zeros((6, 12))
        expected[:, columns] = np.eye(6)
        np.testing.assert_allclose(N, expected, atol=1e-15)


def test_shape_function_slopes_are_derivatives():
    step = 1e-6
    for xi in (0.2, 0.7):
        _, slope = cubic_shapes(xi, 0.3, 0.7)
        ahead, behind = (cubic_shapes(xi + s, 0.3, 0.7)[0] for s in (step, -step))
        np.testing.assert_allclose(slope, (ahead - behind) / (2 * step * 0.3), atol=1e-6)


def free_free(shaft, plane, elements, beam="timoshenko"):
    mesh = mesh_shaft(Shaft(STEEL, (0, 0, 0), (shaft,), KAPPA, (elements,), (), beam), [], plane)
    values = scipy.linalg.eigh(mesh.stiffness, mesh.mass, eigvals_only=True)
    return np.sqrt(np.maximum(values, 0.0)) / (2 * np.pi)


def exact_timoshenko_free_free(section, length, count):
    """Natural frequencies (Hz) of the free-free Timoshenko beam from its characteristic determinant.

    The transfer matrix of (w, theta, M, Q) over the length must have a singular force block.
    """
    E, G, A, I = STEEL.youngs_modulus, STEEL.shear_modulus, section.area, section.area_moment  # noqa: E741

    def determinant(f):
        w = 2 * np.pi * f
        system = np.array(
            [
                [0, 1, 0, 1 / (KAPPA * G * A)],
                [0, 0, 1 / (E * I), 0],
                [0, -STEEL.density * I * w**2, 0, -1],
                [-STEEL.density * A * w**2, 0, 0, 0],
            ]
        )
        scale = np.array([1.0, 1.0, 1e5, 1e6])
        T = scipy.linalg.expm(length * (system * scale[None, :] / scale[:, None]))
        return np.linalg.det(T[2:, :2])

    grid = np.linspace(50.0, 20000.0, 4000)
    signs = np.array([determinant(f) for f in grid])
    crossings = np.flatnonzero(signs[:-1] * signs[1:] < 0)[:count]
    return np.array([brentq(determinant, grid[k], grid[k + 1], xtol=1e-9) for k in crossings])


def test_thick_beam_frequencies_converge_to_the_exact_timoshenko_solution_as_h_squared():
    section, length = Section(0.25, 0.05), 0.25
    exact = exact_timoshenko_free_free(section, length, 3)
    errors = np.array([free_free(section, ("uy", "rx"), n)[2:5] / exact - 1 for n in (16, 32, 64)])
    assert np.all(abs(errors[-1]) < 2e-3)
    orders = np.log2(abs(errors[:-1]) / abs(errors[1:]))
    assert np.all((orders > 1.8) & (orders < 2.2))


def test_slender_beam_tends_to_euler_bernoulli():
    section, length = Section(1.0, 0.004), 1.0
    beta_l = np.array([4.730040745, 7.853204624, 10.995607838])
    stiffness = STEEL.youngs_modulus * section.area_moment / (STEEL.density * section.area)
    exact = (beta_l / length) ** 2 * np.sqrt(stiffness) / (2 * np.pi)
    np.testing.assert_allclose(free_free(section, ("ux", "ry"), 64)[2:5], exact, rtol=3e-4)


def test_axial_and_torsional_frequencies():
    section, length = Section(0.5, 0.03), 0.5
    for dof, speed in (("uz", np.sqrt(2.07e11 / 7850)), ("rz", np.sqrt(STEEL.shear_modulus / 7850))):
        np.testing.assert_allclose(free_free(section, (dof,), 200)[1], speed / (2 * length), rtol=1e-4)


def test_a_probe_between_nodes_reads_the_static_deflection_curve():
    """Between the nodes of a single element the cantilever's cubic and shear line are exact."""
    section, length, force = Section(0.2, 0.05), 0.2, 1000.0
    mesh = mesh_shaft(Shaft(STEEL, (0, 0, 0), (section,), KAPPA, (1,)), [], ("uy", "rx"))
    q = np.zeros(4)
    q[2:] = np.linalg.solve(mesh.stiffness[2:, 2:], [force, 0.0])
    z = 0.37 * length
    E, G, A, I = STEEL.youngs_modulus, STEEL.shear_modulus, section.area, section.area_moment  # noqa: E741
    expected = force * (z**2 * (3 * length - z) / (6 * E * I) + z / (KAPPA * G * A))
    assert (mesh.motion(z) @ q)[DOFS.index("uy")] == pytest.approx(expected, rel=1e-10)
    slope = force * (length * z - z**2 / 2) / (E * I)
    assert (mesh.motion(z) @ q)[DOFS.index("rx")] == pytest.approx(-slope, rel=1e-10)


@pytest.mark.parametrize(
    ("inner", "expected"),
    [
        (0.0, 6 * 1.3 / (7 + 6 * 0.3)),  # solid
        (0.045, 0.533),  # m = 0.9
        (0.05 * (1 - 1e-9), 2 * 1.3 / (4 + 3 * 0.3)),  # Cowper's thin-walled tube
    ],
)
def test_cowper_coefficient(inner, expected):
    assert Section(0.2, 0.05, inner).cowper_coefficient(0.3) == pytest.approx(
        expected, rel=1e-3 if inner == 0.045 else 1e-8
    )


def test_left_out_shear_coefficient_is_that_of_each_section():
    """Tip of a cantilever, one half hollow: bending of both, and shear with a coefficient of its own in each.

    The probe reads the curve within the hollow element with the same coefficient.
    """
    hollow, solid, force = Section(0.1, 0.05, 0.045), Section(0.1, 0.05), 1000.0
    mesh = mesh_shaft(Shaft(STEEL, (0, 0, 0), (hollow, solid), None, (1,)), [], ("uy", "rx"))
    q = np.zeros(6)
    q[2:] = np.linalg.solve(mesh.stiffness[2:, 2:], [0.0, 0.0, force, 0.0])
    m2 = 0.9**2
    kappa = 6 * 1.3 * (1 + m2) ** 2 / (8.8 * (1 + m2) ** 2 + 23.6 * m2)
    E, G = STEEL.youngs_modulus, STEEL.shear_modulus
    EI = E * hollow.area_moment, E * solid.area_moment
    shear = 0.1 / (kappa * G * hollow.area), 0.1 / (6 * 1.3 / 8.8 * G * solid.area)
    tip = (0.2**3 - 0.1**3) / (3 * EI[0]) + 0.1**3 / (3 * EI[1]) + sum(shear)
    assert q[4] == pytest.approx(force * tip, rel=1e-10)
    z = 0.04
    expected = force * (z**2 * (3 * 0.2 - z) / (6 * EI[0]) + shear[0] * z / 0.1)
    assert (mesh.motion(z) @ q)[DOFS.index("uy")] == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("beam", BEAMS)
def test_every_theory_moves_rigidly_at_no_cost_and_carries_its_mass(beam):
    section = Section(0.2, 0.05)
    K, M = beam_element(beam, section, STEEL, 0.2, KAPPA)
    both = np.vstack([rigid_motion(np.array([0.0, 0.0, z])) for z in (-0.1, 0.1)])
    np.testing.assert_allclose(K @ both, 0.0, atol=1e-9 * abs(K).max())
    mass = STEEL.density * section.area * 0.2
    rotary = 0.0 if beam == "euler" else STEEL.density * section.area_moment * 0.2
    energy = both.T @ M @ both
    np.testing.assert_allclose(np.diag(energy)[:3], mass, rtol=1e-12)
    np.testing.assert_allclose(np.diag(energy)[3:5], rotary + mass * 0.2**2 / 12, rtol=1e-12)


def tip(beam, elements, section):
    """Tip deflection of a cantilever under a unit tip force, of so many elements."""
    shaft = Shaft(STEEL, (0, 0, 0), (section,), KAPPA, (elements,), (), beam)
    K = mesh_shaft(shaft, [], ("uy", "rx")).stiffness[2:, 2:]
    load = np.zeros(len(K))
    load[-2] = 1.0
    return np.linalg.solve(K, load)[-2]


def test_one_euler_element_is_exact_without_shear():
    section = Section(0.2, 0.05)
    assert tip("euler", 1, section) == pytest.approx(0.2**3 / (3 * 2.07e11 * section.area_moment), rel=1e-11)


def test_one_mindlin_element_with_reduced_integration_has_its_known_deflection():
    """L / (kappa G A) + L^3 / (4 E I): the shear exact, the bending of a linear rotation (Hughes 1987)."""
    section, L = Section(0.2, 0.05), 0.2
    expected = L / (KAPPA * STEEL.shear_modulus * section.area) + L**3 / (4 * 2.07e11 * section.area_moment)
    assert tip("mindlin_reduced", 1, section) == pytest.approx(expected, rel=1e-11)


@pytest.mark.parametrize("beam", ["mindlin_reduced", "mindlin_full"])
def test_mindlin_deflection_converges_to_the_thick_beam_as_h_squared(beam):
    section, L = Section(0.2, 0.05), 0.2
    exact = L / (KAPPA * STEEL.shear_modulus * section.area) + L**3 / (3 * 2.07e11 * section.area_moment)
    errors = np.array([abs(tip(beam, n, section) / exact - 1) for n in (32, 64, 128)])
    orders = np.log2(errors[:-1] / errors[1:])
    assert np.all((orders > 1.9) & (orders < 2.1))


def test_full_integration_locks_where_reduced_integration_does_not():
    slender = Section(0.2, 0.002)
    exact = 0.2**3 / (3 * 2.07e11 * slender.area_moment)
    assert tip("mindlin_full", 8, slender) < 0.02 * exact
    assert tip("mindlin_reduced", 8, slender) == pytest.approx(exact, rel=0.01)


def test_mindlin_frequencies_converge_to_the_exact_timoshenko_solution_and_euler_does_not():
    section, length = Section(0.25, 0.05), 0.25
    exact = exact_timoshenko_free_free(section, length, 3)
    for beam in ("mindlin_reduced", "mindlin_full"):
        errors = np.array([free_free(section, ("uy", "rx"), n, beam)[2:5] / exact - 1 for n in (32, 64, 128)])
        orders = np.log2(abs(errors[:-1]) / abs(errors[1:]))
        assert np.all((orders > 1.8) & (orders < 2.2))
    euler = free_free(section, ("uy", "rx"), 128, "euler")[2:5] / exact - 1
    assert np.all(euler > [0.05, 0.2, 0.3])


def test_euler_free_free_frequencies_are_the_closed_form():
    section, length = Section(0.5, 0.03), 0.5
    beta_l = np.array([4.730040745, 7.853204624, 10.995607838])
    stiffness = STEEL.youngs_modulus * section.area_moment / (STEEL.density * section.area)
    exact = (beta_l / length) ** 2 * np.sqrt(stiffness) / (2 * np.pi)
    np.testing.assert_allclose(free_free(section, ("uy", "rx"), 32, "euler")[2:5], exact, rtol=1e-5)
