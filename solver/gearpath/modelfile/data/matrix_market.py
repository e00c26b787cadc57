"""Matrices in Matrix Market files, one file a matrix."""

from pathlib import Path

import numpy as np
import scipy.io
import scipy.sparse

from ...errors import InputError
from ...numerics.arrays import Real, Sparse
from .frf import unreadable
from .matrices import MatrixFile, populated, readable


def read_matrix_market(stiffness: Path, mass: Path | None, damping: Path | None) -> MatrixFile:
    """The files of stiffness, mass and damping. Raises InputError for what cannot be read."""
    if mass is None:
        raise InputError("mass_file: is missing; a .mtx file holds one matrix, give that of the mass too")
    return MatrixFile(_read(stiffness), _read(mass), None if damping is None else _read(damping))


def _read(path: Path) -> Real | Sparse:
    readable(path)
    try:
        matrix = scipy.io.mmread(path)
    except (OSError, ValueError, TypeError, OverflowError) as error:
        raise unreadable(path, error) from None
    if not scipy.sparse.issparse(matrix):
        return np.asarray(matrix)
    populated(path, int(matrix.shape[0]), int(matrix.nnz))
    return scipy.sparse.csc_array(matrix)
