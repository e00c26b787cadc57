"""The six degrees of freedom of a port: right-handed frame, z along the shafts, y along the line of action."""

import numpy as np

from ..numerics.arrays import Real

TRANSLATIONS = ("ux", "uy", "uz")
ROTATIONS = ("rx", "ry", "rz")
DOFS = TRANSLATIONS + ROTATIONS


def is_rotation(dof: str) -> bool:
    """Whether the degree of freedom is a rotation, so that its force is a moment."""
    return dof in ROTATIONS


def force_unit(dof: str) -> str:
    """Unit of the generalised force on a degree of freedom: N or N m."""
    return "N.m" if is_rotation(dof) else "N"


def motion_unit(dof: str, order: int) -> str:
    """Unit of the `order`-th time derivative of a degree of freedom, such as m/s or rad/s2."""
    base = "rad" if is_rotation(dof) else "m"
    return base + ("", "/s", "/s2")[order]


def rigid_motion(offset: Real) -> Real:
    """Motion of a point that lies `offset` (m) from the reference of a rigid body, as a 6 x 6 matrix.

    u_point = u + theta x offset, theta_point = theta (the full form of Eq. 17).
    """
    x, y, z = offset
    T = np.eye(6)
    T[:3, 3:] = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]
    return T
