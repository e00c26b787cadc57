"""Beam elements in three dimensions: Timoshenko, Euler-Bernoulli, and Mindlin with full and reduced integration.

Strains of a straight beam along z (right-hand rotations, so theta_x = -du_y/dz where shear vanishes):

    gamma_x = u_x' - theta_y    gamma_y = u_y' + theta_x    epsilon = u_z'
    kappa_x = theta_x'          kappa_y = theta_y'          tau = theta_z'

Stiffness and consistent mass are Eq. 8a, 8b and 8f (corrected) integrated over the length. The theories differ in their
shape functions, in what they count, and in where the shear energy is sampled:

- timoshenko: the interdependent shape functions of Friedman and Kosmatka (1993); one element reproduces the static
  deflection of a thick beam exactly.
- euler: their limit without shear, Hermite cubics, and no rotary inertia.
- mindlin_full, mindlin_reduced: linear shape functions; shear at three points (which locks) or at one.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..numerics.arrays import Real
from .cross_section import CrossSection
from .material import Material

# u_x and u_y bend with theta_y = +u_x' and theta_x = -u_y'; columns of the 12 element coordinates of each plane
PLANES = ([0, 4, 6, 10], 1.0), ([1, 3, 7, 9], -1.0)


def shear_parameter(section: CrossSection, material: Material, length: float, shear_coefficient: float) -> float:
    """phi = 12 E I / (kappa G A l^2) (beta of Eq. 21)."""
    bending = material.youngs_modulus * section.area_moment
    shear = shear_coefficient * material.shear_modulus * section.area
    return 12.0 * bending / (shear * length**2)


def cubic_shapes(xi: float, length: float, phi: float) -> tuple[Real, Real]:
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
    for (columns, sign), u, theta in zip(PLANES, (0, 1), (4, 3)):
        turn = np.array([1.0, sign, 1.0, sign])  # element rotations as slopes of the deflection
        N[u, columns], dN[u, columns] = turn * deflection, turn * deflection_slope
        N[theta, columns], dN[theta, columns] = sign * turn * rotation, sign * turn * rotation_slope
    for u in (2, 5):
        N[u, [u, u + 6]], dN[u, [u, u + 6]] = [1 - xi, xi], [-1 / l, 1 / l]
    return N, dN


def linear_shapes(xi: float, length: float, phi: float) -> tuple[Real, Real]:  # noqa: ARG001 - one signature for all
    """Motion (6 x 12) that varies linearly between the ends, and its z-derivative."""
    identity = np.eye(6)
    return np.hstack([(1 - xi) * identity, xi * identity]), np.hstack([-identity, identity]) / length


@dataclass(frozen=True)
class BeamTheory:
    """What tells one beam element from another."""

    shapes: Callable[[float, float, float], tuple[Real, Real]]
    sheared: bool  # shear deformation counts
    rotary: bool  # rotary inertia counts
    points: int  # Gauss points of bending and mass (exact)
    shear_points: int  # Gauss points of the shear energy


BEAMS = {
    "timoshenko": BeamTheory(cubic_shapes, sheared=True, rotary=True, points=4, shear_points=4),
    "euler": BeamTheory(cubic_shapes, sheared=False, rotary=False, points=4, shear_points=4),
    "mindlin_reduced": BeamTheory(linear_shapes, sheared=True, rotary=True, points=3, shear_points=1),
    "mindlin_full": BeamTheory(linear_shapes, sheared=True, rotary=True, points=3, shear_points=3),
}


def beam_shapes(
    beam: str, xi: float, section: CrossSection, material: Material, length: float, shear_coefficient: float
) -> tuple[Real, Real]:
    """Shape functions (6 x 12) of a theory at xi = z/l, and their z-derivative."""
    theory = BEAMS[beam]
    phi = shear_parameter(section, material, length, shear_coefficient) if theory.sheared else 0.0
    return theory.shapes(xi, length, phi)


def beam_element(
    beam: str, section: CrossSection, material: Material, length: float, shear_coefficient: float
) -> tuple[Real, Real]:
    """Stiffness and consistent mass (12 x 12 each) of one element of the given length (m); `beam` is a key of BEAMS.

    Mass includes translational and polar inertia, and the rotary inertia of bending where the theory has it.
    """
    theory = BEAMS[beam]
    E, G, A, area_moment = material.youngs_modulus, material.shear_modulus, section.area, section.area_moment
    shear = shear_coefficient * G * A if theory.sheared else 0.0
    rigidity = np.array([0.0, 0.0, E * A, E * area_moment, E * area_moment, 2.0 * G * area_moment])
    rotary = area_moment if theory.rotary else 0.0
    inertia = material.density * np.array([A, A, A, rotary, rotary, 2.0 * area_moment])
    K, M = np.zeros((12, 12)), np.zeros((12, 12))
    for xi, weight in gauss(theory.points):
        N, dN = beam_shapes(beam, xi, section, material, length, shear_coefficient)
        K += weight * length * dN.T @ (rigidity[:, None] * dN)
        M += weight * length * N.T @ (inertia[:, None] * N)
    for xi, weight in gauss(theory.shear_points):
        N, dN = beam_shapes(beam, xi, section, material, length, shear_coefficient)
        gamma = np.array([dN[0] - N[4], dN[1] + N[3]])
        K += weight * length * shear * gamma.T @ gamma
    return (K + K.T) / 2.0, (M + M.T) / 2.0


@lru_cache
def gauss(count: int) -> tuple[tuple[float, float], ...]:
    """Gauss-Legendre points and weights on [0, 1]."""
    points, weights = np.polynomial.legendre.leggauss(count)
    return tuple(((1.0 + float(x)) / 2.0, float(w) / 2.0) for x, w in zip(points, weights))
