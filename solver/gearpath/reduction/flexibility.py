"""Elastic flexibility of a free structure by inertia relief: static responses to loads without rigid-body motion."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
import scipy.sparse

from ..components.structure import Structure
from ..numerics.arrays import Real
from .held import Held, hold

_STILL = 1e-12  # of the strain energies that add up in a motion: less is rounding


@dataclass(frozen=True)
class Flexibility:
    """G = P^T (N K_ii^-1 N^T + E E^T) P with P = I - M R R^T, the sum over all elastic modes of phi phi^T / w^2.

    Loads are balanced by the inertia forces of rigid-body acceleration, the structure is held at a boundary, which then
    moves as T_c^T K T_c lets it (E E^T = T_c (T_c^T K T_c)^+ T_c^T, nothing where it is held statically determinately),
    and rigid motion is taken out of the response.
    """

    held: Held
    rigid: Real  # R (n, k), M-orthonormal
    momentum: Real  # M R
    boundary: Real  # E (n, m - k)

    def apply(self, force: Real) -> Real:
        """G @ force, (n, m)."""
        balanced = force - self.momentum @ (self.rigid.T @ force)
        response = self.held.embed(self.held.factor.solve(self.held.load(balanced)))
        response += self.boundary @ (self.boundary.T @ balanced)
        return np.asarray(response - self.rigid @ (self.momentum.T @ response))


def inertia_relief(structure: Structure, held: Held | None = None) -> Flexibility:
    """Factor the stiffness of a structure once for its elastic flexibility.

    held: the structure held at any boundary, whose factor is used again; left out, it is held statically determinately
    at the coordinates that move most.
    """
    M, R = scipy.sparse.csc_array(structure.mass), np.asarray(structure.rigid_modes, float)
    nothing: Any = scipy.sparse.csr_array((0, int(M.shape[0])))
    if R.shape[1]:
        R = R @ scipy.linalg.inv(scipy.linalg.cholesky(R.T @ (M @ R)))
    held = held or hold(structure, nothing)
    return Flexibility(held, R, np.asarray(M @ R), _boundary_motions(held))


def _boundary_motions(held: Held) -> Real:
    """E (n, m - k): static motions of the boundary, apart from rigid ones, with E^T K E = I."""
    T, R = held.constraint_modes, held.rows @ np.asarray(held.structure.rigid_modes, float)
    if held.boundary == R.shape[1]:
        return np.zeros((len(T), 0))
    K = held.structure.stiffness
    resistance, most = (np.einsum("ij,ij->j", A, B @ A) for A, B in ((T, K), (abs(T), abs(K))))
    unit = 1.0 / np.sqrt(np.where(resistance > _STILL * most, resistance, most))
    deforming = scipy.linalg.null_space((R / unit[:, None]).T, rcond=_STILL) * unit[:, None]
    stiffness, turn = scipy.linalg.eigh(deforming.T @ (T.T @ (K @ T)) @ deforming)
    stiff = stiffness > _STILL * stiffness.max(initial=0.0)
    return np.asarray(T @ (deforming @ (turn[:, stiff] / np.sqrt(stiffness[stiff]))))
