"""FRFs from a numpy archive: `frequencies` (F,) in Hz, `frf` (F, n, n), and names in `channels` (n,) or none."""

import zipfile
from pathlib import Path

import numpy as np

from ...errors import InputError
from .frf import FrfFile, as_lines, unreadable

_FORM = "give the arrays frequencies (F,) and frf (F, n, n), and channels (n,) where they have names"


def read_npz(path: Path) -> FrfFile:
    """Raises InputError for what is no such archive."""
    try:
        with np.load(path, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files if name in ("frequencies", "frf", "channels")}
    except (OSError, ValueError, TypeError, AttributeError, zipfile.BadZipFile) as error:
        raise unreadable(path, error) from None
    missing = [name for name in ("frequencies", "frf") if name not in arrays]
    if missing:
        raise InputError(f"{path.name}: has no array {missing[0]!r}; {_FORM}")
    frequencies, frf = arrays["frequencies"], arrays["frf"]
    if frequencies.dtype.kind not in "iuf" or frf.dtype.kind not in "iufc":
        raise InputError(f"{path.name}: frequencies or frf are not numbers; {_FORM}")
    if frf.ndim == 1:
        frf = frf[:, None, None]
    if frf.ndim != 3 or frf.shape != (frequencies.size, frf.shape[1], frf.shape[1]):
        raise InputError(f"{path.name}: shapes {frequencies.shape} and {frf.shape} do not fit; {_FORM}")
    size = frf.shape[1]
    names = tuple(str(name) for name in arrays.get("channels", np.arange(size)).ravel())
    if len(names) != size or len(set(names)) != size:
        raise InputError(f"{path.name}: channels are not {size} different names; {_FORM}")
    f, H = as_lines(frequencies.astype(float), frf.astype(complex), path.name)
    return FrfFile(f, H, names)
