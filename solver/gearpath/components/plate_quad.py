"""Bilinear quadrilaterals, many at a time: shape functions, their derivatives, Gauss points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..numerics.arrays import Real

CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])  # (xi, eta) of the nodes, counter-clockwise
GAUSS = CORNERS / np.sqrt(3.0)  # 2 x 2 points, each of weight one


@dataclass(frozen=True)
class QuadPoint:
    """The shape functions at one point (xi, eta) of each of e quadrilaterals."""

    values: Real  # N, (4,)
    slopes: Real  # dN/dx and dN/dy, (e, 2, 4)
    jacobian: Real  # d(x, y)/d(xi, eta) as rows xi, eta and columns x, y, (e, 2, 2)
    area: Real  # its determinant, (e,)


def local_shapes(xi: float, eta: float) -> tuple[Real, Real]:
    """Shape functions (4,) and their derivatives by xi and eta (2, 4)."""
    along, up = 1.0 + xi * CORNERS[:, 0], 1.0 + eta * CORNERS[:, 1]
    return along * up / 4.0, np.array([CORNERS[:, 0] * up, CORNERS[:, 1] * along]) / 4.0


def quad_point(corners: Real, xi: float, eta: float) -> QuadPoint:
    """Evaluate at (xi, eta) of the elements whose corners are given, (e, 4, 2)."""
    values, local = local_shapes(xi, eta)
    jacobian = local @ corners
    area: Real = np.asarray(np.linalg.det(jacobian), np.float64)
    slopes: Real = np.asarray(np.linalg.solve(jacobian, local[None]), np.float64)
    return QuadPoint(values, slopes, jacobian, area)


def weighted_square(rows: Real, rigidity: Real, weight: Real) -> Real:
    """w B^T D B of each element: rows B (e, k, n), rigidity D (k, k), weight (e,)."""
    return np.asarray(weight[:, None, None] * (rows.transpose(0, 2, 1) @ (rigidity @ rows)))
