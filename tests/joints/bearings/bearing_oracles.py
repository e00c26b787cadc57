"""Bearings written anew for the tests: rigid-body kinematics and wrenches in space, one rolling element after another.

Nothing of gearpath is used. Displacements may be complex: derivatives come from complex steps.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

STEP = 1e-30
AXIS = np.array([0.0, 0.0, 1.0])


def hertz(curvatures, modulus):
    """K of Q = K d^1.5 by Harris's formulas in complete elliptic integrals: rolling and transverse curvature, 1/m."""
    total, difference = sum(curvatures), (curvatures[0] - curvatures[1]) / sum(curvatures)

    def mismatch(log_ratio):
        k2 = np.exp(2.0 * log_ratio)
        first, second = ellipk(1.0 - 1.0 / k2), ellipe(1.0 - 1.0 / k2)
        return ((k2 + 1.0) * second - 2.0 * first) / ((k2 - 1.0) * second) - difference

    ratio = np.exp(brentq(mismatch, 1e-3, 12.0, xtol=1e-15))
    first, second = ellipk(1.0 - ratio**-2), ellipe(1.0 - ratio**-2)
    shape = 2.0 * first / np.pi * (np.pi / (2.0 * ratio**2 * second)) ** (1.0 / 3.0)
    return (2.0 / (shape * total)) ** 1.5 * 2.0 * total * modulus / 3.0


def ball_constant(D, pitch, fi, fo, angle, youngs=206e9, poisson=0.3):
    """Kn of a ball between both races."""
    modulus = 1.0 / (2.0 * (1.0 - poisson**2) / youngs)
    g = D * np.cos(angle) / pitch
    inner = hertz((2.0 / D + 2.0 * g / (D * (1.0 - g)), 2.0 / D - 1.0 / (fi * D)), modulus)
    outer = hertz((2.0 / D - 2.0 * g / (D * (1.0 + g)), 2.0 / D - 1.0 / (fo * D)), modulus)
    return (inner ** (-2.0 / 3.0) + outer ** (-2.0 / 3.0)) ** -1.5


@dataclass
class BallOracle:
    """Balls at points of the inner groove centres, each with a spring of the groove centres' distance."""

    balls: int
    D: float
    pitch: float
    fi: float
    fo: float
    angle: float
    clearance: float = 0.0
    phase: float = 0.0
    at_ball_centres: bool = False
    exponent = 1.5

    def __post_init__(self):
        self.constant = ball_constant(self.D, self.pitch, self.fi, self.fo, self.angle)
        self.radius = self.pitch / 2 + (self.fi - 0.5) * self.D * np.cos(self.angle)

    def contacts(self, q):
        """Point (1, 3), unit direction (..., 1, 3), approach (..., 1) of one ball after another, at q (..., 5)."""
        rest = (self.fi + self.fo - 1.0) * self.D
        height = (self.fi - 0.5) * self.D * np.sin(self.angle) if self.at_ball_centres else 0.0
        for j in range(self.balls):
            psi = self.phase + 2.0 * np.pi * j / self.balls
            out = np.array([np.cos(psi), np.sin(psi), 0.0])
            points = self.radius * out[None] + height * AXIS
            moved = _moved(q, points)
            change, shift = moved @ out - self.clearance, moved @ AXIS
            radial, axial = rest * np.cos(self.angle) + change, rest * np.sin(self.angle) + shift
            length = np.sqrt(radial**2 + axial**2)
            # length - rest by the difference of their squares: a contact of some nm would lose half its digits
            squares = change * (2.0 * radial - change) + shift * (2.0 * axial - shift)
            direction = (radial[..., None] * out + axial[..., None] * AXIS) / length[..., None]
            yield points, direction, squares / (length + rest)


@dataclass
class RollerOracle:
    """Slices of rollers, each with a spring along the fixed normal of the raceway."""

    rollers: int
    length: float
    radius: float
    angle: float
    slices: int = 31
    clearance: float = 0.0
    profile: object = None
    phase: float = 0.0
    constant: float | None = None
    exponent = 10.0 / 9.0

    def __post_init__(self):
        if self.constant is None:
            self.constant = 35948.0 * (self.length * 1000.0) ** (8 / 9) * 1000.0 ** (10 / 9)

    def contacts(self, q):
        """Points (n, 3), unit normals (n, 3), approaches (..., n) of the slices, one roller after another."""
        places = self.length * (2 * np.arange(self.slices) + 1 - self.slices) / (2 * self.slices)
        drops = np.array([self.profile(place) if self.profile else 0.0 for place in places])
        for j in range(self.rollers):
            psi = self.phase + 2.0 * np.pi * j / self.rollers
            out = np.array([np.cos(psi), np.sin(psi), 0.0])
            normal = np.cos(self.angle) * out + np.sin(self.angle) * AXIS
            along = np.cos(self.angle) * AXIS - np.sin(self.angle) * out
            points = self.radius * out + places[:, None] * along
            back = self.clearance * np.cos(self.angle) + drops
            yield points, np.tile(normal, (self.slices, 1)), _moved(q, points) @ normal - back


@dataclass
class StackOracle:
    """Rows whose points lie z further along the shaft and whose inner rings were pushed on beforehand."""

    rows: list
    positions: list
    offsets: list

    def parts(self, q):
        """Row, shift and displacement of each row."""
        for row, z, offset in zip(self.rows, self.positions, self.offsets):
            local = np.array(q, dtype=complex)
            local[..., 0] += z * q[..., 4]
            local[..., 1] -= z * q[..., 3]
            local[..., 2] += offset
            yield row, z, local


def _moved(q, points):
    """Displacements (..., n, 3) of points (n, 3) of the inner ring, u + theta x P."""
    x, y, z = points.T
    ux, uy, uz, a, b = (q[..., i, None] for i in range(5))
    return np.stack([ux + b * z, uy - a * z, uz + a * y - b * x], axis=-1)


def energy(oracle, q):
    """U = sum Kn d^(n+1) / (n+1)."""
    q = np.asarray(q)
    if isinstance(oracle, StackOracle):
        return sum(energy(row, local) for row, _, local in oracle.parts(q))
    n = oracle.exponent
    total = np.zeros(q.shape[:-1], complex)
    for points, _, approach in oracle.contacts(q):
        bears, constant = approach.real > 0, oracle.constant / len(points)
        each = np.where(bears, constant * np.where(bears, approach, 1.0) ** (n + 1) / (n + 1), 0.0)
        total += each.sum(axis=-1)
    return total


def load(oracle, q):
    """Sum of forces and of moments P x F about the reference point."""
    q = np.asarray(q)
    total = np.zeros((*q.shape[:-1], 5), complex)
    if isinstance(oracle, StackOracle):
        for row, z, local in oracle.parts(q):
            part = load(row, local)
            total += part
            total[..., 3] -= z * part[..., 1]
            total[..., 4] += z * part[..., 0]
        return total
    for points, directions, approach in oracle.contacts(q):
        bears, constant = approach.real > 0, oracle.constant / len(points)
        size = np.where(bears, constant * np.where(bears, approach, 1.0) ** oracle.exponent, 0.0)
        fx, fy, fz = np.moveaxis(size[..., None] * directions, -1, 0)
        x, y, z = points.T
        total += np.stack([fx, fy, fz, y * fz - z * fy, z * fx - x * fz], axis=-1).sum(axis=-2)
    return total


def stiffness(oracle, q):
    """K (5, 5) by complex steps of the load at one displacement (5,)."""
    return load(oracle, np.asarray(q) + 1j * STEP * np.eye(5)).imag.T / STEP


def gradient(oracle, q):
    """The load (5,) by complex steps of the energy."""
    return energy(oracle, np.asarray(q) + 1j * STEP * np.eye(5)).imag / STEP


def nearly_touching(oracle, q, share=1e-9):
    """Whether an element is so near its first contact that rounding decides whether it bears."""
    gaps = np.abs([approach for _, _, approach in oracle.contacts(np.asarray(q, complex))])
    return bool(gaps.min() < share * gaps.max())
