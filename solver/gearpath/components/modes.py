"""Free-free modes of a structure, rigid-body modes known beforehand and kept exact."""

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from ..errors import AccuracyError
from ..numerics.arrays import Real
from .structure import Structure


@dataclass(frozen=True)
class Modes:
    """Mass-normalised modes: Phi^T M Phi = I, Phi^T K Phi = diag(eigenvalues)."""

    eigenvalues: Real  # (N,), (rad/s)^2, ascending; exactly zero for rigid-body modes
    shapes: Real  # (n, N)

    @property
    def frequencies(self) -> Real:
        """Natural frequencies, Hz."""
        return np.sqrt(self.eigenvalues) / (2.0 * np.pi)


def modes(structure: Structure) -> Modes:
    """All free-free modes of a structure (Eq. 11 with a complete basis).

    The rigid-body modes come from the structure, not from the eigensolver: their eigenvalue is exactly zero, and the
    elastic modes are made orthogonal to them, so that low frequencies keep all digits. Eigenvalues are Rayleigh
    quotients of the computed shapes, whose error is the square of that of the shapes.

    Raises AccuracyError where the structure has rigid-body motions that it did not declare, or the reverse.
    """
    M, K, R = structure.mass, structure.stiffness, structure.rigid_modes
    count = R.shape[1]
    if count:
        R = R @ scipy.linalg.inv(scipy.linalg.cholesky(R.T @ M @ R, lower=False))
    rough, vectors = scipy.linalg.eigh(K, M)
    elastic = vectors[:, count:]
    elastic -= R @ (R.T @ (M @ elastic))
    elastic /= np.sqrt(np.einsum("ij,ij->j", elastic, M @ elastic))
    eigenvalues = np.einsum("ij,ij->j", elastic, K @ elastic)
    if len(eigenvalues):
        floor = 1e-12 * rough[-1]
        if eigenvalues.min() <= floor or (count and abs(rough[:count]).max() > 1e-3 * eigenvalues.min() + floor):
            raise AccuracyError(
                f"the structure declares {count} rigid-body modes, but its stiffness has a different null space"
            )
    order = np.argsort(eigenvalues)
    return Modes(
        np.concatenate([np.zeros(count), eigenvalues[order]]), np.hstack([R, elastic[:, order]])
    )
