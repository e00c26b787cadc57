"""A ball bearing once more, ball by ball in complex numbers: Hertz by Legendre's integrals, stiffness by complex step.

Nothing of it comes from gearpath; lengths in m, angles in rad, five degrees of freedom ux, uy, uz, rx, ry.
"""

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

SHAPES = {  # of the catalogue: Z, D, d_m, f_i, f_o, a0
    "6205-like": (9, 7.94e-3, 39.04e-3, 0.515, 0.525, 0.0),
    "7210B-like": (15, 12.7e-3, 70e-3, 0.52, 0.53, 0.6981317),
}


def hertz(transverse, along, modulus=206e9 / (2.0 * (1.0 - 0.3**2))):
    """Q / d^1.5 of one contact with these relative radii of curvature (Johnson, Contact Mechanics, 4.24 to 4.28)."""

    def excess(k):  # k = b / a
        m = 1.0 - k * k
        return (ellipe(m) / k**2 - ellipk(m)) / (ellipk(m) - ellipe(m)) - along / transverse

    k = brentq(excess, 1e-4, 1.0 - 1e-9, xtol=1e-16, rtol=1e-15)
    m = 1.0 - k * k
    cubed = 3.0 * (ellipk(m) - ellipe(m)) / (2.0 * np.pi * modulus * m) * 2.0 * along  # a^3 / Q
    return (2.0 * np.pi * modulus * cubed ** (1.0 / 3.0) / (3.0 * ellipk(m))) ** 1.5


class Balls:
    """One row at z, pushed along the shaft by an offset."""

    def __init__(self, shape, facing=1.0, z=0.0, offset=0.0, turned=0.0):
        self.Z, D, pitch, inner, outer, angle = shape
        self.a0, self.z, self.offset, self.turned = facing * angle, z, offset, turned
        gamma = D * np.cos(angle) / pitch
        both = [
            hertz(0.5 * D * (1.0 - side * gamma), f * D / (2.0 * f - 1.0)) for side, f in ((1.0, inner), (-1.0, outer))
        ]
        self.Kn = sum(K ** (-2.0 / 3.0) for K in both) ** -1.5
        self.A0 = (inner + outer - 1.0) * D
        self.r = 0.5 * pitch + (inner - 0.5) * D * np.cos(angle)

    def positions(self):
        return [(self.turned + 2.0 * np.pi * j / self.Z) for j in range(self.Z)]

    def balls(self, q):
        """Angle, radial and axial force of every ball."""
        ux, uy, uz, rx, ry = q
        ux, uy, uz = ux + self.z * ry, uy - self.z * rx, uz + self.offset
        for psi in self.positions():
            radial = self.A0 * np.cos(self.a0) + ux * np.cos(psi) + uy * np.sin(psi)
            axial = self.A0 * np.sin(self.a0) + uz + self.r * (rx * np.sin(psi) - ry * np.cos(psi))
            length = np.sqrt(radial**2 + axial**2)
            stretch = length - self.A0
            Q = self.Kn * stretch**1.5 if np.real(stretch) > 0.0 else 0.0 * stretch
            yield psi, Q * radial / length, Q * axial / length

    def load(self, q):
        """Sum over the balls, with the moments about the origin of the shaft."""
        total = np.zeros(5, complex)
        for psi, Qr, Qa in self.balls(q):
            fx, fy = Qr * np.cos(psi), Qr * np.sin(psi)
            mx, my = self.r * np.sin(psi) * Qa - self.z * fy, -self.r * np.cos(psi) * Qa + self.z * fx
            total += np.array([fx, fy, Qa, mx, my])
        return total


def stiffness(rows, q):
    """d(load) / dq (6, 6) of several rows, by complex steps."""
    K = np.zeros((6, 6))
    for k in range(5):
        step = np.array(q[:5], complex)
        step[k] += 1e-30j
        K[:5, k] = sum(row.load(step) for row in rows).imag / 1e-30
    return K


def pushed(row, force):
    """How far along z the row must go to carry a force along it."""
    sense = np.sign(force)
    return sense * brentq(lambda u: abs(row.load([0, 0, sense * u, 0, 0]).real[2]) - abs(force), 0.0, 1e-3, xtol=1e-18)
