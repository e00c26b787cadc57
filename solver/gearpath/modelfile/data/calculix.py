"""Matrices that CalculiX writes with *FREQUENCY, SOLVER=MATRIXSTORAGE: JOB.sti, JOB.mas and JOB.dof, in text.

A line of .sti and .mas is row, column, value of the upper triangle; a line of .dof is the coordinate's node.direction,
in the order of the coordinates.
"""

from pathlib import Path

import numpy as np
import scipy.sparse

from ...errors import InputError
from ...numerics.arrays import Real, Sparse
from .frf import unreadable
from .matrices import MatrixFile, readable, whole


def read_calculix(path: Path) -> MatrixFile:
    """The three files of the job whose .sti this is. Raises InputError for what cannot be read."""
    nodes, directions = _coordinates(path.with_suffix(".dof"))
    size = len(nodes)
    stiffness, mass = (_triangle(path.with_suffix(suffix), size) for suffix in (".sti", ".mas"))
    return MatrixFile(stiffness, mass, None, nodes, directions)


def _coordinates(path: Path) -> tuple[np.ndarray, np.ndarray]:
    readable(path)
    try:
        words = [line.strip().split(".") for line in path.read_text().splitlines() if line.strip()]
        found = np.array([(int(node), int(direction)) for node, direction in words], np.intp).reshape(-1, 2)
    except (OSError, ValueError, UnicodeDecodeError) as error:
        raise unreadable(path, error) from None
    if not len(found) or not np.isin(found[:, 1], np.arange(1, 7)).all():
        raise InputError(f"{path.name}: does not list coordinates as node.direction; write it again with MATRIXSTORAGE")
    return found[:, 0], found[:, 1]


def _triangle(path: Path, size: int) -> Sparse:
    readable(path)
    try:
        entries: Real = np.loadtxt(path, ndmin=2)
    except (OSError, ValueError, UnicodeDecodeError) as error:
        raise unreadable(path, error) from None
    if entries.ndim != 2 or entries.shape[1] != 3 or not np.isfinite(entries).all():
        raise InputError(f"{path.name}: its lines are not row, column, value; write it again with MATRIXSTORAGE")
    places = entries[:, :2].astype(np.intp) - 1
    if places.min(initial=0) < 0 or places.max(initial=0) >= size:
        raise InputError(f"{path.name}: has coordinates beyond the {size} of its .dof file; they belong to other jobs")
    return whole(scipy.sparse.coo_array((entries[:, 2], (places[:, 0], places[:, 1])), shape=(size, size)))
