"""Matrices in a Nastran OUTPUT4 file, by pyyeti: KAA and MAA and their kin, BAA for damping."""

from pathlib import Path

import numpy as np
import scipy.sparse

from ...errors import InputError, MissingExtraError
from ...numerics.arrays import Real, Sparse
from .frf import unreadable
from .matrices import MatrixFile, readable

_NAMES = {
    "stiffness": ("KAA", "KGG", "KXX", "KFF", "KMAT", "K", "STIFFNESS"),
    "mass": ("MAA", "MGG", "MXX", "MFF", "MMAT", "M", "MASS"),
    "damping": ("BAA", "BGG", "BXX", "BFF", "B", "DAMPING"),
}


def read_op4(path: Path) -> MatrixFile:
    """Raises InputError for a file without these matrices, MissingExtraError without pyyeti."""
    readable(path)
    try:
        from pyyeti.nastran import op4
    except ImportError as error:
        raise MissingExtraError("pyyeti", "op4") from error
    try:
        content = op4.read(str(path), sparse=None)
    except Exception as error:  # whatever a broken file makes pyyeti raise
        raise unreadable(path, error) from None
    found = {key.upper(): value for key, value in content.items()}
    stiffness, mass, damping = (_pick(found, names) for names in _NAMES.values())
    if stiffness is None or mass is None:
        lacking = "stiffness" if stiffness is None else "mass"
        wanted = ", ".join(_NAMES[lacking][:4])
        raise InputError(f"{path.name}: has no {lacking} (it has: {', '.join(found) or 'nothing'}); name it {wanted}")
    return MatrixFile(stiffness, mass, damping)


def _pick(found: dict[str, object], names: tuple[str, ...]) -> Real | Sparse | None:
    for name in names:
        if name in found:
            matrix = found[name]
            return scipy.sparse.csc_array(matrix) if scipy.sparse.issparse(matrix) else np.asarray(matrix, float)
    return None
