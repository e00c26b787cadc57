"""Reductions with free interfaces: normal modes without and with residual flexibility."""

from typing import Any

import numpy as np
import scipy.sparse

from ..components.structure import Structure
from ..errors import InputError
from ..numerics.lanczos import independent
from .flexibility import Flexibility, inertia_relief
from .interface import interface_rows, mesh_spins
from .normal_modes import lowest_modes
from .record import Reduction, extended


def free_interface(
    structure: Structure, vectors: int, residual: bool, rows: Any = None, flexibility: Flexibility | None = None
) -> Reduction:
    """Rigid-body modes and the lowest `vectors` elastic free-free modes (Eq. 7, truncated).

    With `residual` the inertia-relief attachment modes G L^T of all interface rows (default: ports and meshes) join,
    less what the kept modes hold of them (MacNeal 1971, Rubin 1975), and the spins of transmission errors: the basis is
    then statically complete. Without it the static response is missing, and a transmission error has to be given as
    its inertial force. Raises InputError where there are not so many modes.
    """
    if vectors < 0:
        raise InputError(f"the number of vectors is {vectors}; give zero or more")
    flexibility = flexibility or inertia_relief(structure)
    M, R = scipy.sparse.csc_array(structure.mass), flexibility.rigid
    count = R.shape[1]
    modes = lowest_modes(structure.stiffness, M, flexibility.apply, vectors, count)
    kept = np.hstack([R, independent(modes, M, R, flexibility.momentum)])
    static = np.zeros((structure.size, 0))
    if residual:
        L = scipy.sparse.csr_array(interface_rows(structure) if rows is None else rows)
        static = np.hstack([flexibility.apply(np.asarray(L.toarray().T)), mesh_spins(structure)])
    name = "free-interface modes with residuals" if residual else "free-interface modes"
    return extended(structure, kept, count, static, name)
