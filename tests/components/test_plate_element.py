"""The plate element: constant states on distorted grids, no mode without energy, bending in the plane, inertia."""

import numpy as np
import pytest

from gearpath.components import Material
from gearpath.components.node_mesh import scatter
from gearpath.components.plate_element import plate_elements

STEEL = Material(2.07e11, 0.3, 7850.0)
KAPPA = 5 / 6
E, NU, G = STEEL.youngs_modulus, STEEL.poisson_ratio, STEEL.shear_modulus
SKEWED = np.array([[0.0, 0.0], [0.9, 0.1], [1.2, 0.8], [-0.2, 1.1]])

# MacNeal and Harder's patch: five distorted elements, four free nodes inside a rectangle
PATCH = np.array(
    [[0, 0], [0.24, 0], [0.24, 0.12], [0, 0.12], [0.04, 0.02], [0.18, 0.03], [0.16, 0.08], [0.08, 0.08]], float
)
QUADS = np.array([[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 5, 6, 7]])
AREA = 0.24 * 0.12


def patch(thickness):
    return scatter(plate_elements(PATCH[QUADS], STEEL, thickness, KAPPA)[0], QUADS, 8).toarray()


def in_plane(a, b, c, d):
    """u = a x + b y, v = c x + d y and their rotation."""
    x, y = PATCH.T
    q = np.zeros((8, 6))
    q[:, 0], q[:, 1], q[:, 5] = a * x + b * y, c * x + d * y, (c - b) / 2
    return q.ravel()


def bent(a, b, c):
    """w = -(a x^2 + b y^2 + c x y)/2 with fibres that stay normal: theta_2 = -w,x and theta_1 = w,y."""
    x, y = PATCH.T
    q = np.zeros((8, 6))
    q[:, 2] = -(a * x**2 + b * y**2 + c * x * y) / 2
    q[:, 3], q[:, 4] = -(b * y + c * x / 2), a * x + c * y / 2
    return q.ravel()


def stored(strain, stiffness):
    """Energy per area of a strain in plane stress."""
    C = stiffness / (1 - NU**2) * np.array([[1, NU, 0], [NU, 1, 0], [0, 0, (1 - NU) / 2]])
    return np.array(strain) @ C @ np.array(strain) / 2


@pytest.mark.parametrize("thickness", [1e-4, 1e-3, 0.02])
@pytest.mark.parametrize(
    ("q", "energy"),
    [
        (in_plane(1e-3, 0, 0, 0), lambda h: stored([1e-3, 0, 0], E * h)),
        (in_plane(0, 0, 0, 1e-3), lambda h: stored([0, 1e-3, 0], E * h)),
        (in_plane(1e-3, 5e-4, 3e-4, -2e-4), lambda h: stored([1e-3, -2e-4, 8e-4], E * h)),
        (bent(1, 0, 0), lambda h: stored([1, 0, 0], E * h**3 / 12)),
        (bent(0, 1, 0), lambda h: stored([0, 1, 0], E * h**3 / 12)),
        (bent(0.3, -0.7, 1.1), lambda h: stored([0.3, -0.7, 1.1], E * h**3 / 12)),
    ],
)
def test_constant_strain_and_curvature_are_exact_on_a_distorted_patch(q, energy, thickness):
    """The free nodes find the exact solution from the edges, and the energy is that of the closed form."""
    K = patch(thickness)
    free, fixed = slice(24, 48), slice(0, 24)
    found = np.linalg.solve(K[free, free], -K[free, fixed] @ q[fixed])
    np.testing.assert_allclose(found, q[free], atol=1e-8 * abs(q).max())
    assert q @ K @ q / 2 == pytest.approx(AREA * energy(thickness), rel=1e-6)


def test_constant_shear_strain_has_the_energy_of_the_closed_form():
    q = np.zeros((8, 6))
    q[:, 2], q[:, 3] = 1e-3 * PATCH[:, 0], 4e-4
    energy = KAPPA * G * 0.01 * (1e-3**2 + 4e-4**2) / 2 * AREA
    assert q.ravel() @ patch(0.01) @ q.ravel() / 2 == pytest.approx(energy, rel=1e-10)


@pytest.mark.parametrize("corners", [SKEWED, SKEWED * [1.0, 0.02], np.array([[0, 0], [1, 0], [1, 0.3], [0, 0.3]])])
@pytest.mark.parametrize("thickness", [1e-3, 0.1])
def test_exactly_six_motions_cost_no_energy_and_every_motion_has_mass(corners, thickness):
    K, M = (matrix[0] for matrix in plate_elements(corners[None], STEEL, thickness, KAPPA))
    scale = np.sqrt(np.diag(M))
    stiffness, mass = (np.linalg.eigvalsh(matrix / np.outer(scale, scale)) for matrix in (K, M))
    assert abs(stiffness[:6]).max() < 1e-11 * stiffness[-1]
    assert stiffness[6] > 1e3 * abs(stiffness[:6]).max()
    assert mass[0] > 1e-3


def strip(length, depth, count):
    """Corners (nodes) and elements of a strip, one element deep."""
    x = np.repeat(np.linspace(0, length, count + 1), 2)
    nodes = np.stack([x, np.tile([-depth / 2, depth / 2], count + 1)], axis=1)
    return nodes, 2 * np.arange(count)[:, None] + np.array([0, 2, 3, 1])


def cantilever(load):
    """Tip motion [u, v, theta] averaged over both tip nodes of a 10-element strip, clamped at x = 0."""
    nodes, elements = strip(1.0, 0.1, 10)
    K = scatter(plate_elements(nodes[elements], STEEL, 0.01, KAPPA)[0], elements, len(nodes)).toarray()
    kept = np.array([6 * n + k for n in range(2, len(nodes)) for k in (0, 1, 5)])
    kept = np.concatenate([[5, 11, 1], kept])  # the clamp holds u of both nodes and v of one: no restraint of Poisson
    force = np.zeros(len(K))
    force[-12:].reshape(2, 6)[:, [0, 1, 5]] = load
    q = np.zeros(len(K))
    q[kept] = np.linalg.solve(K[np.ix_(kept, kept)], force[kept])
    return q[-12:].reshape(2, 6)[:, [0, 1, 5]].mean(axis=0)


def test_pure_bending_in_the_plane_is_exact_one_element_deep():
    """No parasitic shear: moment by a couple of axial forces; slope and drilling rotation are both M L / (E I)."""
    second_moment, moment = 0.01 * 0.1**3 / 12, 100.0
    _, v, theta = cantilever([[moment / 0.1, 0, 0], [-moment / 0.1, 0, 0]])
    assert theta == pytest.approx(moment / (E * second_moment), rel=1e-9)
    assert v == pytest.approx(moment / (2 * E * second_moment), rel=1e-2)


def test_a_strip_carries_shear_in_its_plane():
    second_moment, force = 0.01 * 0.1**3 / 12, 100.0
    _, v, _ = cantilever([[0, force / 2, 0]] * 2)
    expected = force / (3 * E * second_moment) + force / (KAPPA * G * 0.001)
    assert v == pytest.approx(expected, rel=5e-3)


def test_a_moment_about_the_normal_bends_the_strip():
    """Applied to the drilling rotations it does the same work as a couple of forces."""
    second_moment, moment = 0.01 * 0.1**3 / 12, 100.0
    _, v, _ = cantilever([[0, 0, moment / 2]] * 2)
    assert v == pytest.approx(moment / (2 * E * second_moment), rel=2e-2)


def test_mass_and_inertia_of_an_element_are_exact():
    corners, h = np.array([[0, 0], [0.3, 0], [0.3, 0.2], [0, 0.2]]) - [0.15, 0.1], 0.05
    M = plate_elements(corners[None], STEEL, h, KAPPA)[1][0]
    rigid = np.zeros((4, 6, 6))
    rigid[:] = np.eye(6)
    x, y = corners.T
    rigid[:, 0, 5], rigid[:, 1, 5], rigid[:, 2, 3], rigid[:, 2, 4] = -y, x, y, -x
    R = rigid.reshape(24, 6)
    mass = STEEL.density * 0.3 * 0.2 * h
    about_x, about_y, about_z = (mass / 12 * (p**2 + q**2) for p, q in ((0.2, h), (0.3, h), (0.3, 0.2)))
    np.testing.assert_allclose(R.T @ M @ R, np.diag([mass] * 3 + [about_x, about_y, about_z]), rtol=1e-12, atol=1e-14)
