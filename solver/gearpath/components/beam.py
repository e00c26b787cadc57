"""Timoshenko beam element in three dimensions, from shape functions that are exact for static end loads.

Strains of a straight beam along z (right-hand rotations, so theta_x = -du_y/dz where shear vanishes):

    gamma_x = u_x' - theta_y    gamma_y = u_y' + theta_x    epsilon = u_z'
    kappa_x = theta_x'          kappa_y = theta_y'          tau = theta_z'

Stiffness and consistent mass are Eq. 8a and 8b (corrected) integrated over the length; with the interdependent shape
functions of Friedman and Kosmatka (1993) one element reproduces the static deflection of a thick beam exactly.
"""

import numpy as np

from ..numerics.arrays import Real
from .material import Material
from .section import Section

# u_x and u_y bend with theta_y = +u_x' and theta_x = -u_y'; columns of the 12 element coordinates of each plane
_PLANE_X, _PLANE_Y = ([0, 4, 6, 10], 1.0), ([1, 3, 7, 9], -1.0)
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(4)  # exact to degree 7; the integrands have degree 6


def shear_parameter(section: Section, material: Material, length: float, shear_coefficient: float) -> float:
    """phi = 12 E I / (kappa G A l^2) (beta of Eq. 21)."""
    bending = material.youngs_modulus * section.area_moment
    shear = shear_coefficient * material.shear_modulus * section.area
    return 12.0 * bending / (shear * length**2)


def shape_functions(xi: float, length: float, phi: float) -> tuple[Real, Real]:
    """Motion (6 x 12) at xi = z/l in [0, 1] from the end motions [ux uy uz rx ry rz] x 2, and its z-derivative."""
    scale, l = 1.0 / (1.0 + phi), length  # noqa: E741 - the element length of the literature
    deflection = scale * np.array(
        [
            1 - 3 * xi**2 + 2 * xi**3 + phi * (1 - xi),
            l * (xi - 2 * xi**2 + xi**3 + phi / 2 * (xi - xi**2)),
            3 * xi**2 - 2 * xi**3 + phi * xi,
            l * (xi**3 - xi**2 - phi / 2 * (xi - xi**2)),
        ]
    )
    deflection_slope = scale * np.array(
        [
            (6 * xi**2 - 6 * xi - phi) / l,
            1 - 4 * xi + 3 * xi**2 + phi / 2 * (1 - 2 * xi),
            (6 * xi - 6 * xi**2 + phi) / l,
            3 * xi**2 - 2 * xi - phi / 2 * (1 - 2 * xi),
        ]
    )
    rotation = scale * np.array(
        [
            6 * (xi**2 - xi) / l,
            1 - 4 * xi + 3 * xi**2 + phi * (1 - xi),
            6 * (xi - xi**2) / l,
            3 * xi**2 - 2 * xi + phi * xi,
        ]
    )
    rotation_slope = scale * np.array(
        [(12 * xi - 6) / l**2, (6 * xi - 4 - phi) / l, (6 - 12 * xi) / l**2, (6 * xi - 2 + phi) / l]
    )
    N, dN = np.zeros((6, 12)), np.zeros((6, 12))
    for (columns, sign), u, theta in ((_PLANE_X, 0, 4), (_PLANE_Y, 1, 3)):
        turn = np.array([1.0, sign, 1.0, sign])  # element rotations as slopes of the deflection
        N[u, columns], dN[u, columns] = turn * deflection, turn * deflection_slope
        N[theta, columns], dN[theta, columns] = sign * turn * rotation, sign * turn * rotation_slope
    for u in (2, 5):
        N[u, [u, u + 6]], dN[u, [u, u + 6]] = [1 - xi, xi], [-1 / l, 1 / l]
    return N, dN


def timoshenko_element(
    section: Section, material: Material, length: float, shear_coefficient: float
) -> tuple[Real, Real]:
    """Stiffness and consistent mass (12 x 12 each) of one element of the given length (m).

    Mass includes translational, rotary and polar inertia.
    """
    E, G, A, area_moment = material.youngs_modulus, material.shear_modulus, section.area, section.area_moment
    phi = shear_parameter(section, material, length, shear_coefficient)
    shear, bending = shear_coefficient * G * A, E * area_moment
    rigidity = np.array([shear, shear, E * A, bending, bending, 2.0 * G * area_moment])
    inertia = material.density * np.array([A, A, A, area_moment, area_moment, 2.0 * area_moment])
    K, M = np.zeros((12, 12)), np.zeros((12, 12))
    for point, weight in zip(_POINTS, _WEIGHTS):
        N, strain = shape_functions((1.0 + point) / 2.0, length, phi)
        strain[0] -= N[4]
        strain[1] += N[3]
        dz = weight * length / 2.0
        K += dz * strain.T @ (rigidity[:, None] * strain)
        M += dz * N.T @ (inertia[:, None] * N)
    return (K + K.T) / 2.0, (M + M.T) / 2.0
