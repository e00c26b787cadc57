"""Bending of a shear-flexible (Mindlin) plate: the four-node element with mixed interpolation, MITC4.

Coordinates of a node: w, theta_1, theta_2 by the right hand, so that a fibre at height z moves by u_1 = z theta_2 and
u_2 = -z theta_1:

    curvatures    kappa = [theta_2,1   -theta_1,2   theta_2,2 - theta_1,1]     D = E h^3 / (12 (1 - nu^2))
    shear         gamma_1 = w,1 + theta_2     gamma_2 = w,2 - theta_1          kappa_s G h

Shear is taken along the element's own directions at the middles of its edges and interpolated from there (Bathe and
Dvorkin 1985): it vanishes where a thin plate bends, so nothing locks, and no mode without energy is left.
"""

from __future__ import annotations

import numpy as np

from ..numerics.arrays import Real
from .material import Material
from .plate_quad import GAUSS, QuadPoint, local_shapes, quad_point, weighted_square


def bending_elements(
    corners: Real, material: Material, thickness: float, shear_coefficient: float
) -> tuple[Real, Real]:
    """Stiffness and consistent mass, (e, 12, 12) each, of elements with the given corners, (e, 4, 2).

    The mass includes rotary inertia rho h^3 / 12.
    """
    bending = thickness**3 / 12.0 * plane_stress(material)
    shear = shear_coefficient * material.shear_modulus * thickness * np.eye(2)
    inertia = material.density * np.diag([thickness, thickness**3 / 12.0, thickness**3 / 12.0])
    K, M = (np.zeros((len(corners), 12, 12)) for _ in range(2))
    for xi, eta in GAUSS:
        point = quad_point(corners, xi, eta)
        K += weighted_square(_curvature(point), bending, point.area)
        K += weighted_square(_shear(corners, point, xi, eta), shear, point.area)
        motion = np.kron(point.values, np.eye(3))
        M += point.area[:, None, None] * (motion.T @ inertia @ motion)
    return K, M


def plane_stress(material: Material) -> Real:
    """E / (1 - nu^2) [[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu)/2]], Pa."""
    nu = material.poisson_ratio
    scale = material.youngs_modulus / (1.0 - nu**2)
    return scale * np.array([[1.0, nu, 0.0], [nu, 1.0, 0.0], [0.0, 0.0, (1.0 - nu) / 2.0]])


def _curvature(point: QuadPoint) -> Real:
    rows = np.zeros((len(point.area), 3, 12))
    rows[:, 0, 2::3] = point.slopes[:, 0]
    rows[:, 1, 1::3] = -point.slopes[:, 1]
    rows[:, 2, 1::3], rows[:, 2, 2::3] = -point.slopes[:, 0], point.slopes[:, 1]
    return rows


def _shear(corners: Real, point: QuadPoint, xi: float, eta: float) -> Real:
    """Shear strains by x and y at (xi, eta), (e, 2, 12), from those along the edges at their middles."""
    lower, upper = (_edge_shear(corners, 0.0, side, 0) for side in (-1.0, 1.0))
    left, right = (_edge_shear(corners, side, 0.0, 1) for side in (-1.0, 1.0))
    along = np.stack(
        [((1 - eta) * lower + (1 + eta) * upper) / 2.0, ((1 - xi) * left + (1 + xi) * right) / 2.0], axis=1
    )
    return np.asarray(np.linalg.solve(point.jacobian, along))


def _edge_shear(corners: Real, xi: float, eta: float, direction: int) -> Real:
    """w,s + x,s theta_2 - y,s theta_1 with s = xi or eta (direction 0 or 1), (e, 12)."""
    values, local = local_shapes(xi, eta)
    tangent = local[direction] @ corners
    rows = np.zeros((len(corners), 12))
    rows[:, 0::3] = local[direction]
    rows[:, 1::3] = -tangent[:, 1:] * values
    rows[:, 2::3] = tangent[:, :1] * values
    return rows
