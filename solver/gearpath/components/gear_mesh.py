"""A gear mesh in space: along which line the teeth press, where, and how the motions of both gears deform them.

Gears 1 and 2 turn about z through O1 and O2 (m); c is the unit vector from axis 1 to axis 2, t = z x c the tangent at
the pitch point. Gear 1 pushes gear 2 along the unit normal of the teeth

    n = cos(beta_b) (sigma cos(alpha) t + sin(alpha) c) - sigma sin(beta_b) z

alpha is the transverse pressure angle, beta_b the helix angle on the base cylinder, positive where gear 1 is
right-hand; sigma = +1 where the torque that presses the teeth together acts on gear 1 about +z, -1 where about -z. The
force acts in the pitch point C = O1 + (O2 - O1) r1 / (r1 + r2), r the base radii, in the middle plane of the gears. The
rigid gears' motions (u, theta) approach the teeth by

    delta = n . (u1 + theta1 x (C - O1)) - n . (u2 + theta2 x (C - O2)) = b . (u1, theta1, u2, theta2)

so the mesh stiffness is k b b^T (12 x 12), and no rigid motion of both gears together deforms it. The lever of theta_z
is r cos(beta_b), of the given base radius. Both angles 0 and c along +-x leave n = y and the spur mesh of the paper's
planar model, delta = y1 - y2 +- (r1 theta1 + r2 theta2).
"""

from dataclasses import dataclass
from math import cos, hypot, sin

import numpy as np

from ..numerics.arrays import Real

Vector = tuple[float, float, float]
TORQUES = {"+z": 1.0, "-z": -1.0}
_ROUNDING = 1e-14  # parts of n below this, and levers below this part of the axes' distance, are rounding


@dataclass(frozen=True)
class Mesh:
    """Stiffness along the line of action (N/m), base radii (m) and angles (rad) of two external gears."""

    between: tuple[tuple[str, str], tuple[str, str]]  # (shaft, disk) of the first and the second gear
    stiffness: float
    base_radii: tuple[float, float]
    pressure_angle: float | None = None  # transverse; None: the line of action lies along y, wherever the axes are
    helix_angle: float = 0.0  # on the base cylinder, positive where the first gear is right-hand
    driving_torque: str = ""  # on the first gear, a key of TORQUES; "": the one that pushes the second towards +y
    contact_offset: float | None = None  # of C along z from the first gear, m; None: C in each gear's middle plane

    def sense(self, first: Vector, second: Vector) -> float:
        """sigma, +1 or -1: the sense about z of the torque with which the first gear presses on the second."""
        if self.pressure_angle is not None and self.driving_torque:
            return TORQUES[self.driving_torque]
        dx, dy = second[0] - first[0], second[1] - first[1]
        return 1.0 if dx >= -_ROUNDING * hypot(dx, dy) else -1.0

    def line_of_action(self, first: Vector, second: Vector) -> Real:
        """Unit normal n of the teeth of gears at the given places, (3,): so the first pushes the second."""
        sigma = self.sense(first, second)
        across = np.array([0.0, 1.0])
        if self.pressure_angle is not None:
            dx, dy = second[0] - first[0], second[1] - first[1]
            centre = np.array([dx, dy]) / hypot(dx, dy)
            tangent = np.array([-centre[1], centre[0]])
            across = sigma * cos(self.pressure_angle) * tangent + sin(self.pressure_angle) * centre
        n = np.array([*(cos(self.helix_angle) * across), -sigma * sin(self.helix_angle)])
        return np.where(abs(n) > _ROUNDING, n, 0.0)

    def deformation(self, first: Vector, second: Vector) -> Real:
        """Rows b on ux uy uz rx ry rz of the two gears at the given places, (2, 6): the approach of the teeth, m."""
        O1, O2 = np.array(first), np.array(second)
        n, sigma = self.line_of_action(first, second), self.sense(first, second)
        r1, r2 = self.base_radii
        offset = (O2 - O1) * (r1 / (r1 + r2))
        contacts = np.array([offset, offset + O1 - O2])  # from either centre
        contacts[:, 2] = 0.0 if self.contact_offset is None else self.contact_offset + O1[2] - np.array([O1[2], O2[2]])
        out = np.zeros((2, 6))
        for row, contact, radius, sign in zip(out, contacts, self.base_radii, (1.0, -1.0)):
            levers = np.cross(contact, n)
            levers[abs(levers) < _ROUNDING * hypot(*(O2 - O1))] = 0.0
            row[:3], row[3:5] = sign * n, sign * levers[:2]
            row[5] = sigma * radius * cos(self.helix_angle)
        return out
