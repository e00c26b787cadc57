"""In-plane motion of a plate: the four-node quadrilateral with incompatible modes and a drilling rotation.

Coordinates of a node: u_1, u_2, theta_3 by the right hand. Strains are those of plane stress. Two modes 1 - xi^2 and
1 - eta^2 in each displacement, condensed out, let the element bend in its plane without parasitic shear (Taylor,
Beresford and Wilson 1976). The rotation is a field of its own, tied to that of the displacements,

    omega = (u_2,1 - u_1,2) / 2     stiffness from  G h int (theta_3 - omega)^2     mass from  rho h^3 / 12 int (same)^2

(Hughes and Brezzi 1989; theirs is the stiffness, the mass takes the plate's rotary inertia). Both vanish in rigid
motion and as the grid is refined: mass and inertia are exact, and the mass matrix is regular.
"""

from __future__ import annotations

import numpy as np

from ..numerics.arrays import Real
from .material import Material
from .plate_bending import plane_stress
from .plate_quad import GAUSS, QuadPoint, quad_point, weighted_square


def membrane_elements(corners: Real, material: Material, thickness: float) -> tuple[Real, Real]:
    """Stiffness and consistent mass, (e, 12, 12) each, of elements with the given corners, (e, 4, 2)."""
    rigidity = np.zeros((4, 4))
    rigidity[:3, :3] = thickness * plane_stress(material)
    rigidity[3, 3] = thickness * material.shear_modulus
    whole, M = np.zeros((len(corners), 16, 16)), np.zeros((len(corners), 12, 12))
    centre = quad_point(corners, 0.0, 0.0)
    spin = material.density * thickness**3 / 12.0 * np.eye(1)
    for xi, eta in GAUSS:
        point = quad_point(corners, xi, eta)
        rows = np.concatenate([_strain(point), _incompatible(centre, point, xi, eta)], axis=2)
        whole += weighted_square(rows, rigidity, point.area)
        motion = np.kron(point.values, np.diag([1.0, 1.0, 0.0]))
        M += material.density * thickness * point.area[:, None, None] * (motion.T @ motion)
        M += weighted_square(rows[:, 3:, :12], spin, point.area)
    inner = np.linalg.solve(whole[:, 12:, 12:], whole[:, 12:, :12])
    K = whole[:, :12, :12] - whole[:, :12, 12:] @ inner
    return (K + K.transpose(0, 2, 1)) / 2.0, M


def _strain(point: QuadPoint) -> Real:
    """epsilon_11, epsilon_22, gamma_12 and theta_3 - omega, (e, 4, 12)."""
    rows = np.zeros((len(point.area), 4, 12))
    dx, dy = point.slopes[:, 0], point.slopes[:, 1]
    rows[:, 0, 0::3], rows[:, 1, 1::3] = dx, dy
    rows[:, 2, 0::3], rows[:, 2, 1::3] = dy, dx
    rows[:, 3, 0::3], rows[:, 3, 1::3], rows[:, 3, 2::3] = dy / 2.0, -dx / 2.0, point.values
    return rows


def _incompatible(centre: QuadPoint, point: QuadPoint, xi: float, eta: float) -> Real:
    """The same of the modes 1 - xi^2 and 1 - eta^2 in u_1 and u_2, (e, 4, 4).

    With the Jacobian of the centre, scaled by the ratio of areas, their mean strain vanishes: constant stress is exact.
    """
    local = np.diag([-2.0 * xi, -2.0 * eta])
    slopes = np.linalg.solve(centre.jacobian, local[None]) * (centre.area / point.area)[:, None, None]
    rows = np.zeros((len(point.area), 4, 4))
    dx, dy = slopes[:, 0], slopes[:, 1]
    rows[:, 0, :2], rows[:, 1, 2:] = dx, dy
    rows[:, 2, :2], rows[:, 2, 2:] = dy, dx
    rows[:, 3, :2], rows[:, 3, 2:] = dy / 2.0, -dx / 2.0
    return rows
