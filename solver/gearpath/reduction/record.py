"""What a reduction is: a basis, the matrices on it, and the ways back into the network."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
import scipy.sparse

from ..components.modes import Modes, modes
from ..components.structure import MeshMotion, Structure
from ..errors import AccuracyError
from ..numerics.arrays import Real
from ..numerics.lanczos import independent

_RIGID = 1e-6  # part of |K| |R| that a declared rigid mode may deform the reduced structure; rounding leaves 1e-10
_STILL = 1e-10  # part of a coordinate's motion that deforms the structure, below which it is rounding


@dataclass(frozen=True)
class Reduction:
    """q = T r: reduced mass T^T M T and stiffness T^T K T, rigid-body motion kept and exactly free of stiffness.

    The columns of T are boundary coordinates (or rigid-body modes), then static responses, then vectors.
    """

    method: str
    basis: Real  # T (n, r)
    mass: Real  # (r, r)
    stiffness: Real  # (r, r)
    rigid_modes: Real  # (r, k): T @ rigid_modes are the rigid-body modes of the structure
    boundary: int  # coordinates that stay physical: the first columns of T
    vectors: int  # Lanczos vectors or normal modes, the last columns of T

    @property
    def size(self) -> int:
        """Number of reduced coordinates r."""
        return int(self.basis.shape[1])


def project(
    structure: Structure, method: str, basis: Real, rigid_coordinates: Real, boundary: int, vectors: int
) -> Reduction:
    """Congruence of the structure on a basis; `rigid_coordinates` (r, k) are those of the structure's rigid modes.

    Raises AccuracyError where a declared rigid-body mode deforms the structure.
    """
    K, M = scipy.sparse.csc_array(structure.stiffness), scipy.sparse.csc_array(structure.mass)
    mass, R = _symmetric(basis.T @ (M @ basis)), rigid_coordinates
    if not R.shape[1]:
        return Reduction(method, basis, mass, _symmetric(basis.T @ (K @ basis)), R, boundary, vectors)
    Q = R @ scipy.linalg.inv(scipy.linalg.cholesky(_symmetric(R.T @ mass @ R)))
    motion, momentum = basis @ Q, mass @ Q
    deformed = abs(K @ motion).max(axis=0) > _RIGID * (abs(K) @ abs(motion)).max(axis=0)
    if deformed.any():
        raise AccuracyError(f"{np.count_nonzero(deformed)} of the declared rigid-body modes deform the structure")
    elastic = basis - motion @ momentum.T
    stiffness = _symmetric(elastic.T @ (K @ elastic))
    # K is rounded in parts of its largest entries: what is left of resistance to rigid motion is taken out again
    stiffness = stiffness - momentum @ (Q.T @ stiffness)
    stiffness = _symmetric(stiffness - (stiffness @ Q) @ momentum.T)
    # a coordinate that moves a part without deforming it (a shaft on one axial bearing) is left with rounding alone
    deforms = np.linalg.norm(elastic, axis=0) > _STILL * np.linalg.norm(basis, axis=0)
    stiffness = np.where(np.outer(deforms, deforms), stiffness, 0.0)
    return Reduction(method, basis, mass, stiffness, R, boundary, vectors)


def extended(structure: Structure, modes: Real, rigid: int, motion: Real, method: str) -> Reduction:
    """The basis of M-orthonormal modes (n, N), of which the first `rigid` are rigid, and of what `motion` (n, k) adds.

    Rigid-body modes, additions, elastic modes, in this order; M-orthonormal.
    """
    M = scipy.sparse.csc_array(structure.mass)
    added = independent(motion, M, modes, np.asarray(M @ modes))
    basis = np.hstack([modes[:, :rigid], added, modes[:, rigid:]])
    return project(structure, method, basis, np.eye(basis.shape[1], rigid), 0, modes.shape[1] - rigid)


def reduced_structure(structure: Structure, reduction: Reduction) -> Structure:
    """The structure in its r reduced coordinates, with the same ports and meshes: a small one for the network."""
    T, M = reduction.basis, scipy.sparse.csc_array(structure.mass)

    def motion(item: MeshMotion) -> MeshMotion:
        push = T.T @ (M @ item.displacement)
        d = scipy.linalg.solve(reduction.mass, push, assume_a="pos")
        return MeshMotion(d, float(d @ push), item.spin @ T)

    return Structure(
        mass=reduction.mass,
        stiffness=reduction.stiffness,
        rigid_modes=reduction.rigid_modes,
        modal_damping=structure.modal_damping,
        ports={name: _dense(rows @ T) for name, rows in structure.ports.items()},
        meshes={name: motion(item) for name, item in structure.meshes.items()},
        loss_factor=structure.loss_factor,
    )


def reduced_modes(structure: Structure, reduction: Reduction) -> Modes:
    """Free-free modes of the reduced structure on the original coordinates, shapes (n, r) (Eq. 11b).

    Mass-normalised, rigid-body modes with eigenvalue exactly zero: `network.assemble.to_modes` takes them as the
    component's basis. By Rayleigh and Ritz no eigenvalue lies below its counterpart of the complete structure.
    """
    found = modes(reduced_structure(structure, reduction))
    return Modes(found.eigenvalues, np.asarray(reduction.basis @ found.shapes))


def _symmetric(matrix: Real) -> Real:
    return np.asarray((matrix + matrix.T) / 2.0)


def _dense(rows: Any) -> Real:
    return np.asarray(rows.toarray() if scipy.sparse.issparse(rows) else rows)
