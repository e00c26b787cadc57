"""A bolted joint as a short massless beam: compliance H_p and rigid transport T_p (Eq. 18 to 21, corrected).

With g the force on the receiver at its end of the beam, u_s and u_c the motions of source and receiver,

    T_p^T u_s - u_c = H_p g / (1 + i eta),

so a beam joint is a vector spring of stiffness (1 + i eta) H_p^-1 between the receiver's port and the source's motion
carried rigidly along the beam. It needs no degrees of freedom of its own.
"""

from __future__ import annotations

import numpy as np

from ..errors import InputError
from ..numerics.arrays import Real
from .joint import Joint, Matrix, Port, Vector

_DOFS = ("ux", "uy", "uz", "rx", "ry", "rz")


def beam_compliance(
    length: float,
    area: float,
    area_moment: float,
    youngs_modulus: float,
    poisson_ratio: float,
    shear_coefficient: float,
) -> Real:
    """H_p of one joint along +z (Eq. 21), (6, 6) on ux uy uz rx ry rz: motion of the far end per load on it, m/N ...

    beta = 12 E I / (kappa G A l^2); flexure in both planes (21b, 21c with the area moment I), tension and torsion (21d
    with the polar moment 2 I of a round section).
    """
    l, E = length, youngs_modulus  # noqa: E741 - the length of the literature
    G = E / (2.0 * (1.0 + poisson_ratio))
    beta = 12.0 * E * area_moment / (shear_coefficient * G * area * l**2)
    flexure = l / (12.0 * E * area_moment)
    H = np.diag([0.0, 0.0, l / (E * area), 0.0, 0.0, l / (2.0 * G * area_moment)])
    for u, theta, sign in ((0, 4, 1.0), (1, 3, -1.0)):  # u_x bends with +theta_y, u_y with -theta_x
        H[u, u] = flexure * (4.0 + beta) * l**2
        H[theta, theta] = flexure * 12.0
        H[u, theta] = H[theta, u] = sign * flexure * 6.0 * l
    return H


def beam_joint(
    between: tuple[Port, Port],
    offset: Vector,
    dofs: tuple[str, ...],
    diameter: float,
    youngs_modulus: float,
    poisson_ratio: float,
    inner_diameter: float = 0.0,
    shear_coefficient: float = 0.886,
    loss_factor: float = 0.0,
    at: Vector | None = None,
) -> Joint:
    """The joint of a round massless beam from the source's port to the receiver's, `offset` (m) apart.

    Raises InputError where the ports coincide. Degrees of freedom not in `dofs` do not move.
    """
    axis = np.array(offset, float)
    length = float(np.linalg.norm(axis))
    if length == 0.0:
        raise InputError("a beam joint needs two ports apart from each other; its length is their distance")
    area = np.pi / 4.0 * (diameter**2 - inner_diameter**2)
    area_moment = np.pi / 64.0 * (diameter**4 - inner_diameter**4)
    H = beam_compliance(length, area, area_moment, youngs_modulus, poisson_ratio, shear_coefficient)
    turn = np.kron(np.eye(2), _frame(axis / length))
    K = turn @ np.linalg.inv(H) @ turn.T
    picked = [_DOFS.index(dof) for dof in dofs]
    K = ((K + K.T) / 2.0)[np.ix_(picked, picked)]
    return Joint("beam_joint", between, dofs, _matrix(K), _matrix(0.0 * K), at, False, loss_factor, offset)


def _frame(axis: Real) -> Real:
    """Rotation whose third column is the beam's axis; a round section needs no other orientation."""
    other = np.eye(3)[int(np.argmin(abs(axis)))]
    x = np.cross(other, axis)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(axis, x), axis])


def _matrix(K: Real) -> Matrix:
    return tuple(tuple(float(x) for x in row) for row in K)
