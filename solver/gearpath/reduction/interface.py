"""Where a structure meets its neighbours: the rows of its ports and of its meshes."""

from typing import Any

import numpy as np
import scipy.sparse

from ..components.structure import Structure
from ..numerics.arrays import Real


def port_rows(structure: Structure) -> Any:
    """All rows of all ports that read any motion, (m, n), sparse."""
    rows = [scipy.sparse.csr_array(item) for item in structure.ports.values()]
    n = int(structure.mass.shape[0])
    stacked = scipy.sparse.csr_array(scipy.sparse.vstack(rows)) if rows else scipy.sparse.csr_array((0, n))
    return stacked[np.flatnonzero(np.diff(stacked.indptr))]


def mesh_rows(structure: Structure) -> Real:
    """Rows (M d)^T / m_e of all meshes, (n_e, n): the coordinate that the inertial excitation of each mesh acts on.

    In the planar gearbox that is p itself; where shafts twist it is the weighted mean of their spins.
    """
    n = int(structure.mass.shape[0])
    M = scipy.sparse.csr_array(structure.mass)
    rows = [(M @ mesh.displacement) / mesh.equivalent_mass for mesh in structure.meshes.values()]
    return np.array(rows).reshape(len(rows), n)


def interface_rows(structure: Structure) -> Any:
    """Ports and meshes, the n_p + n_e rows of Eq. 1a and (corrected) Eq. 12, (m, n), sparse."""
    return scipy.sparse.csr_array(scipy.sparse.vstack([port_rows(structure), mesh_rows(structure)]))


def mesh_spins(structure: Structure) -> Real:
    """Rigid spin d of every mesh's transmission error, (n, n_e)."""
    n = int(structure.mass.shape[0])
    return np.array([mesh.displacement for mesh in structure.meshes.values()]).reshape(-1, n).T
