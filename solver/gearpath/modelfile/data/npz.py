"""Numpy archives of matrices.

stiffness, mass, damping     (n, n) each, or NAME_row, NAME_column, NAME_value of a sparse one (one triangle will do)
dof_nodes, dof_directions    (n,) node number and direction 1 to 6 (ux to rz) of each coordinate, where there are nodes
nodes, positions             (k,) node numbers and (k, 3) their places
"""

import zipfile
from pathlib import Path

import numpy as np
import scipy.sparse

from ...errors import InputError
from ...numerics.arrays import Real, Sparse
from .frf import unreadable
from .matrices import MatrixFile, populated, readable, whole


def read_npz(path: Path) -> MatrixFile:
    """Raises InputError for what is no such archive."""
    readable(path)
    try:
        with np.load(path, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
    except (OSError, ValueError, TypeError, AttributeError, zipfile.BadZipFile) as error:
        raise unreadable(path, error) from None
    least = _size(arrays)
    populated(path, least, sum(item.size for item in arrays.values()))
    found = {name: _matrix(path, arrays, name, least) for name in ("stiffness", "mass", "damping")}
    stiffness, mass = found["stiffness"], found["mass"]
    if stiffness is None or mass is None:
        lacking = "stiffness" if stiffness is None else "mass"
        raise InputError(f"{path.name}: has no array {lacking!r} (it has: {', '.join(arrays) or 'none'}); add it")
    nodes, directions = (_numbers(path, arrays, name, least) for name in ("dof_nodes", "dof_directions"))
    if (nodes is None) != (directions is None):
        raise InputError(f"{path.name}: dof_nodes and dof_directions belong together; give both or none")
    if directions is not None and not np.isin(directions, np.arange(1, 7)).all():
        raise InputError(f"{path.name}: dof_directions are not all 1 to 6 (ux to rz); mend them")
    return MatrixFile(stiffness, mass, found["damping"], nodes, directions, _positions(path, arrays))


def _size(arrays: dict[str, np.ndarray]) -> int:
    """Number of coordinates that any of the matrices reaches: the last ones may have stiffness but no mass."""
    named = [(name, part) for name in ("stiffness", "mass", "damping") for part in ("row", "column")]
    places = [arrays[f"{name}_{part}"] for name, part in named if f"{name}_{part}" in arrays]
    dense = [arrays[name].shape[0] for name in ("stiffness", "mass", "damping") if name in arrays and arrays[name].ndim]
    return max([*dense, *(int(item.max()) + 1 for item in places if item.size and item.dtype.kind in "iu")], default=0)


def _matrix(path: Path, arrays: dict[str, np.ndarray], name: str, size: int) -> Real | Sparse | None:
    if name in arrays:
        if arrays[name].dtype.kind not in "iuf":
            raise InputError(f"{path.name}: {name} is not an array of numbers; save it as floats")
        return arrays[name].astype(float)
    keys = [f"{name}_{part}" for part in ("row", "column", "value")]
    if not all(key in arrays for key in keys):
        return None
    row, column, value = (arrays[key] for key in keys)
    fits = row.ndim == 1 and row.shape == column.shape == value.shape and value.dtype.kind in "iuf"
    if not fits or any(item.dtype.kind not in "iu" or item.min(initial=0) < 0 for item in (row, column)):
        raise InputError(
            f"{path.name}: {name}_row, {name}_column and {name}_value do not fit; give one of each an entry, from 0 on"
        )
    return whole(scipy.sparse.coo_array((value.astype(float), (row, column)), shape=(size, size)))


def _numbers(path: Path, arrays: dict[str, np.ndarray], name: str, size: int) -> np.ndarray | None:
    if name not in arrays:
        return None
    if arrays[name].dtype.kind not in "iu" or arrays[name].shape != (size,):
        raise InputError(f"{path.name}: {name} are not {size} whole numbers; give one a coordinate")
    return arrays[name].astype(np.intp)


def _positions(path: Path, arrays: dict[str, np.ndarray]) -> dict[int, tuple[float, float, float]]:
    if "nodes" not in arrays or "positions" not in arrays:
        return {}
    nodes, positions = arrays["nodes"], arrays["positions"]
    if nodes.dtype.kind not in "iu" or positions.shape != (nodes.size, 3):
        raise InputError(f"{path.name}: nodes and positions do not fit; give (k,) numbers and (k, 3) places")
    return {int(n): (float(x), float(y), float(z)) for n, (x, y, z) in zip(nodes.ravel(), positions)}
