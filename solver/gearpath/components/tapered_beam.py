"""Beam elements of linearly varying diameters, in the four theories of `beam`.

Timoshenko and Euler-Bernoulli elements are statically exact: with the forces (V, M) at the free end the section at s
carries the shear V and the moment M + V (l - s), so that the flexibility of the clamped element is

    F = [ int (l-s)^2/EI + 1/(kappa G A) ds    int (l-s)/EI ds ]        K = D^T F^-1 D
        [ int (l-s)/EI ds                      int 1/EI ds     ]

with D the two deformations (u2 - u1 - l theta1, theta2 - theta1). The deflection under these end forces gives the shape
functions, and these the consistent mass; for constant diameters both are those of Friedman and Kosmatka (1993).
Mindlin elements have linear shape functions and take the section at each Gauss point.
"""

from collections.abc import Sequence

import numpy as np

from ..numerics.arrays import Real
from .beam import BEAMS, PLANES, gauss, linear_shapes
from .material import Material
from .section import Section

_STATIC_POINTS = 24  # of the flexibility: 1e-14 where the diameter grows fourfold within an element
_MASS_POINTS = 12


def tapered_shapes(
    beam: str, xi: float, section: Section, material: Material, length: float, shear_coefficient: float | None
) -> Real:
    """Motion (6 x 12) at xi = z/l from the end motions [ux uy uz rx ry rz] x 2, as `beam.beam_shapes`.

    shear_coefficient None: Cowper's of each place.
    """
    if BEAMS[beam].shapes is linear_shapes:
        return linear_shapes(xi, length, 0.0)[0]
    return _Bar(beam, section, material, length, shear_coefficient).shapes(xi)


def tapered_element(
    beam: str, section: Section, material: Material, length: float, shear_coefficient: float | None
) -> tuple[Real, Real]:
    """Stiffness and consistent mass (12 x 12 each) of one element of the given length (m), as `beam.beam_element`."""
    bar = _Bar(beam, section, material, length, shear_coefficient)
    linear = BEAMS[beam].shapes is linear_shapes
    K = bar.linear_stiffness() if linear else bar.stiffness()
    M = np.zeros((12, 12))
    for xi, weight in gauss(_MASS_POINTS):
        N = linear_shapes(xi, length, 0.0)[0] if linear else bar.shapes(xi)
        M += weight * length * N.T @ (bar.inertia(xi)[:, None] * N)
    return (K + K.T) / 2.0, (M + M.T) / 2.0


class _Bar:
    """One element: its properties along the length, its flexibility, and the motion under forces at its ends."""

    def __init__(
        self, beam: str, section: Section, material: Material, length: float, shear_coefficient: float | None
    ) -> None:
        self.theory, self.section, self.material, self.length = BEAMS[beam], section, material, length
        self.shear_coefficient = shear_coefficient
        l = length  # noqa: E741 - the element length of the literature
        a0, a1, a2, shear, self.axial, self.twist = self._integrals(1.0)
        self.bending = np.array([[l**2 * a0 - 2.0 * l * a1 + a2 + shear, l * a0 - a1], [l * a0 - a1, a0]])
        self.deform = np.array([[-1.0, -l, 1.0, 0.0], [0.0, -1.0, 0.0, 1.0]])  # of (u1, theta1, u2, theta2)
        self.end_forces = np.linalg.solve(self.bending, self.deform)  # (V, M), (2, 4)

    def rigidities(self, xi: float) -> tuple[float, float, float]:
        """EA, EI and kappa G A at xi; without shear deformation the last is infinite."""
        here, E = self.section.at(xi), self.material.youngs_modulus
        if not self.theory.sheared:
            return E * here.area, E * here.area_moment, np.inf
        given, nu = self.shear_coefficient, self.material.poisson_ratio
        kappa = here.cowper_coefficient(nu) if given is None else given
        return E * here.area, E * here.area_moment, kappa * self.material.shear_modulus * here.area

    def inertia(self, xi: float) -> Real:
        """Mass and moments of inertia per length at xi on ux uy uz rx ry rz."""
        here = self.section.at(xi)
        rotary = here.area_moment if self.theory.rotary else 0.0
        return self.material.density * np.array([*[here.area] * 3, rotary, rotary, 2.0 * here.area_moment])

    def _integrals(self, xi: float) -> Sequence[float]:
        """Integrals from 0 to s = xi l: 1/EI, s/EI, s^2/EI, 1/(kappa G A), 1/EA, 1/(G J)."""
        twisting = 2.0 * self.material.shear_modulus / self.material.youngs_modulus
        out = np.zeros(6)
        for part, weight in gauss(_STATIC_POINTS):
            s = xi * part * self.length
            EA, EI, GA = self.rigidities(xi * part)
            out += weight * xi * self.length * np.array([1, s, s**2, EI / GA, EI / EA, 1.0 / twisting]) / EI
        return [float(value) for value in out]

    def stiffness(self) -> Real:
        """K = D^T F^-1 D of both bending planes, and 1 / int 1/EA and 1 / int 1/GJ."""
        K = np.zeros((12, 12))
        plane = self.deform.T @ self.end_forces
        for columns, sign in PLANES:
            turn = np.array([1.0, sign, 1.0, sign])
            K[np.ix_(columns, columns)] = np.outer(turn, turn) * plane
        for u, flexibility in ((2, self.axial), (5, self.twist)):
            K[np.ix_([u, u + 6], [u, u + 6])] = np.array([[1.0, -1.0], [-1.0, 1.0]]) / flexibility
        return K

    def shapes(self, xi: float) -> Real:
        """Motion (6 x 12) at xi under end forces that give the end motions."""
        s = xi * self.length
        a0, a1, a2, shear, axial, twist = self._integrals(xi)
        V, end = self.end_forces
        M = end + self.length * V  # the moment at the first end; at s it is M - V s
        deflection = np.array([1.0, s, 0.0, 0.0]) + (s * a0 - a1) * M + (a2 - s * a1 + shear) * V
        rotation = np.array([0.0, 1.0, 0.0, 0.0]) + a0 * M - a1 * V
        N = np.zeros((6, 12))
        for (columns, sign), u, theta in zip(PLANES, (0, 1), (4, 3)):
            turn = np.array([1.0, sign, 1.0, sign])
            N[u, columns], N[theta, columns] = turn * deflection, sign * turn * rotation
        for u, part in ((2, axial / self.axial), (5, twist / self.twist)):
            N[u, [u, u + 6]] = 1.0 - part, part
        return N

    def linear_stiffness(self) -> Real:
        """Bending, axial and torsional energy, and shear at its own Gauss points, of linear shape functions."""
        K = np.zeros((12, 12))
        twisting = self.material.shear_modulus / self.material.youngs_modulus
        for xi, weight in gauss(self.theory.points):
            _, dN = linear_shapes(xi, self.length, 0.0)
            EA, EI, _ = self.rigidities(xi)
            rigidity = np.array([0.0, 0.0, EA, EI, EI, 2.0 * twisting * EI])
            K += weight * self.length * dN.T @ (rigidity[:, None] * dN)
        for xi, weight in gauss(self.theory.shear_points):
            N, dN = linear_shapes(xi, self.length, 0.0)
            gamma = np.array([dN[0] - N[4], dN[1] + N[3]])
            K += weight * self.length * self.rigidities(xi)[2] * gamma.T @ gamma
        return K
