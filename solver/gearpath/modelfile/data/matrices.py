"""What a file of matrices holds, whatever its format."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...errors import InputError
from ...numerics.arrays import Real, Sparse

_FEW = 10  # coordinates an entry


@dataclass(frozen=True)
class MatrixFile:
    """Mass and stiffness of n coordinates in the file's own units, and what the coordinates are where it says so.

    Raises InputError for matrices that are empty or not of the same size.
    """

    stiffness: Real | Sparse  # (n, n)
    mass: Real | Sparse  # (n, n)
    damping: Real | Sparse | None = None  # (n, n)
    nodes: "np.ndarray[tuple[int], np.dtype[np.intp]] | None" = None  # (n,): number of the node of each coordinate
    directions: "np.ndarray[tuple[int], np.dtype[np.intp]] | None" = None  # (n,): 1 to 6, ux to rz
    positions: dict[int, tuple[float, float, float]] = field(default_factory=dict)  # of nodes, in the file's length

    def __post_init__(self) -> None:
        shape = tuple(self.stiffness.shape)
        if len(shape) != 2 or shape[0] != shape[1] or not shape[0]:
            raise InputError(f"stiffness: has shape {shape}; give an n x n matrix")
        for name, matrix in (("mass", self.mass), ("damping", self.damping)):
            if matrix is not None and tuple(matrix.shape) != shape:
                raise InputError(
                    f"{name}: has shape {tuple(matrix.shape)} beside a stiffness of {shape}; give equal sizes"
                )


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


def populated(path: Path, size: int, entries: int) -> None:
    """Refuses a matrix of so few entries that most of its coordinates have none: their numbers are wrong."""
    if size > _FEW * (entries + 100):
        raise InputError(
            f"{path.name}: numbers {size} coordinates, but has {entries} entries; number them from 0 on without gaps"
        )
