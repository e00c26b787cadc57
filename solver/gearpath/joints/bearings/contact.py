"""Contact constants Kn of Q = Kn d^n: a rolling element between two rings (Hertz; ISO/TS 16281; Palmgren)."""

import numpy as np
from scipy.optimize import brentq
from scipy.special import elliprd, elliprf

POINT, LINE = 1.5, 10.0 / 9.0  # the exponents n
ISO_LINE = 35948.0  # N/mm^(10/9) per mm^(8/9): both contacts, ISO/TS 16281


def in_series(inner: float, outer: float, exponent: float) -> float:
    """One constant of both contacts, whose displacements add: [Ki^(-1/n) + Ko^(-1/n)]^(-n)."""
    return float((inner ** (-1.0 / exponent) + outer ** (-1.0 / exponent)) ** -exponent)


def axis_ratio(radius_rolling: float, radius_groove: float) -> float:
    """Squared ratio m <= 1 of the axes of the contact ellipse, for relative radii Rx <= Ry (m).

    R_D(0, 1, m) / R_D(0, m, 1) = Ry / Rx, with Carlson's elliptic integrals.
    """
    wanted = np.log(radius_groove / radius_rolling)

    def mismatch(logarithm: float) -> float:
        m = np.exp(logarithm)
        return float(np.log(elliprd(0.0, 1.0, m) / elliprd(0.0, m, 1.0)) - wanted)

    return float(np.exp(brentq(mismatch, -60.0, 0.0, xtol=1e-15))) if wanted > 0 else 1.0


def point_contact(radius_rolling: float, radius_groove: float, modulus: float) -> float:
    """Exact Hertzian constant, N/m^1.5, of principal relative radii Rx <= Ry (m) and E* (Pa).

    K = (2 pi E* / 3) R_F(0, m, 1)^(-3/2) sqrt(R_D(0, m, 1) 2 Ry / 3).
    """
    m = axis_ratio(radius_rolling, radius_groove)
    shape = elliprf(0.0, m, 1.0) ** -1.5 * np.sqrt(elliprd(0.0, m, 1.0) * 2.0 * radius_groove / 3.0)
    return float(2.0 * np.pi * modulus / 3.0 * shape)


def semi_major_axis(radius_rolling: float, radius_groove: float, modulus: float, load: float) -> float:
    """Half the length of the contact ellipse across the rolling direction, m: a^3 = Q Ry R_D(0, m, 1) / (pi E*)."""
    m = axis_ratio(radius_rolling, radius_groove)
    return float((load * radius_groove * elliprd(0.0, m, 1.0) / (np.pi * modulus)) ** (1.0 / 3.0))


def groove_radii(diameter: float, pitch: float, conformity: float, angle: float, side: int) -> tuple[float, float]:
    """Relative radii Rx, Ry (m) of a ball in a groove; side -1 is the inner race, +1 the outer.

    Rx = D/2 (1 -/+ gamma), gamma = D cos(a) / d_m; Ry = f D / (2 f - 1).
    """
    gamma = diameter * np.cos(angle) / pitch
    return 0.5 * diameter * (1.0 + side * gamma), conformity * diameter / (2.0 * conformity - 1.0)


def effective_modulus(youngs_modulus: float, poisson_ratio: float) -> float:
    """E* of two bodies of one material, 1/E* = 2 (1 - nu^2) / E, Pa."""
    return youngs_modulus / (2.0 * (1.0 - poisson_ratio**2))


def line_constant(length: float) -> float:
    """Kn of a steel roller between both raceways, N/m^(10/9): 35948 L^(8/9) N/mm^(10/9), L in mm (ISO/TS 16281)."""
    return float(ISO_LINE * (1e3 * length) ** (8.0 / 9.0) * 1e3**LINE)
