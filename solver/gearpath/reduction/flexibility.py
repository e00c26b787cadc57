"""Elastic flexibility of a free structure by inertia relief: static responses to loads without rigid-body motion."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
import scipy.sparse

from ..components.structure import Structure
from ..numerics.arrays import Real
from .held import Held, hold


@dataclass(frozen=True)
class Flexibility:
    """G = P^T N K_ii^-1 N^T P with P = I - M R R^T, the sum over all elastic modes of phi phi^T / w^2.

    Loads are balanced by the inertia forces of rigid-body acceleration, the structure is held statically determinately
    (at the coordinates that move most), and rigid motion is taken out of the response.
    """

    held: Held
    rigid: Real  # R (n, k), M-orthonormal
    momentum: Real  # M R

    def apply(self, force: Real) -> Real:
        """G @ force, (n, m)."""
        balanced = force - self.momentum @ (self.rigid.T @ force)
        response = self.held.embed(self.held.factor.solve(self.held.load(balanced)))
        return np.asarray(response - self.rigid @ (self.momentum.T @ response))


def inertia_relief(structure: Structure) -> Flexibility:
    """Factor the stiffness of a structure once for its elastic flexibility."""
    M, R = scipy.sparse.csc_array(structure.mass), np.asarray(structure.rigid_modes, float)
    nothing: Any = scipy.sparse.csr_array((0, int(M.shape[0])))
    if R.shape[1]:
        R = R @ scipy.linalg.inv(scipy.linalg.cholesky(R.T @ (M @ R)))
    return Flexibility(hold(structure, nothing), R, np.asarray(M @ R))
