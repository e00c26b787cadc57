"""What a file of matrices holds, whatever its format."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...errors import InputError
from ...numerics.arrays import Real, Sparse


@dataclass(frozen=True)
class MatrixFile:
    """Mass and stiffness of n coordinates in the file's own units, and what the coordinates are where it says so."""

    stiffness: Real | Sparse  # (n, n)
    mass: Real | Sparse  # (n, n)
    damping: Real | Sparse | None = None  # (n, n)
    nodes: "np.ndarray[tuple[int], np.dtype[np.intp]] | None" = None  # (n,): number of the node of each coordinate
    directions: "np.ndarray[tuple[int], np.dtype[np.intp]] | None" = None  # (n,): 1 to 6, ux to rz
    positions: dict[int, tuple[float, float, float]] = field(default_factory=dict)  # of nodes, in the file's length


def whole(matrix: Sparse) -> Sparse:
    """The symmetric matrix of one triangle, or the matrix itself where it has entries on both sides."""
    import scipy.sparse

    lower, upper = scipy.sparse.tril(matrix, -1), scipy.sparse.triu(matrix, 1)
    if lower.nnz and upper.nnz:
        return scipy.sparse.csc_array(matrix)
    return scipy.sparse.csc_array(matrix + lower.T + upper.T)


def readable(path: Path) -> Path:
    """The path of a file that is there. Raises InputError."""
    if not path.is_file():
        raise InputError(f"{path.name}: there is no such file; give its path from the folder of the model file")
    return path
