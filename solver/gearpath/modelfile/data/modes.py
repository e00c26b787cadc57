"""Modes in files: numpy archives, and universal files with datasets 55 (normal modes at nodes) by pyuff."""

import warnings
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...components.dofs import DOFS
from ...errors import InputError, MissingExtraError
from ...numerics.arrays import Real
from .frf import unreadable
from .matrices import readable

_NORMAL, _COMPLEX = 2, 3  # analysis types of dataset 55
_LIMITS = {  # least, most, in words
    "frequencies": (0.0, 1e9, "frequencies in Hz, 0 of rigid motions"),
    "shapes": (-1e30, 1e30, "finite numbers"),
    "damping": (0.0, 1.0 - 1e-9, "damping ratios from 0 to below 1"),
    "modal_masses": (1e-30, 1e30, "masses above 0"),
}
_SKEW = 0.2  # imaginary part of a complex shape turned real, of its length, above which it is no normal mode


@dataclass(frozen=True)
class ModeFile:
    """Modes of a structure in the file's own units; `shapes` by "node:dof"."""

    frequencies: Real  # (N,), Hz
    damping: Real | None  # (N,), ratios
    modal_masses: Real  # (N,)
    shapes: dict[str, Real]  # "12:uy" -> (N,)


def read_modes_npz(path: Path) -> ModeFile:
    """Arrays frequencies (N,), shapes (m, N), dofs (m,) such as "12:uy", and damping (N,), modal_masses (N,) or none.

    Raises InputError for what is no such archive.
    """
    readable(path)
    form = "give the arrays frequencies (N,), shapes (m, N) and dofs (m,) such as '12:uy'"
    try:
        with np.load(path, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
    except (OSError, ValueError, TypeError, AttributeError, zipfile.BadZipFile) as error:
        raise unreadable(path, error) from None
    missing = [name for name in ("frequencies", "shapes", "dofs") if name not in arrays]
    if missing:
        raise InputError(f"{path.name}: has no array {missing[0]!r}; {form}")
    found = {name: _numbers(path, name, arrays[name]) for name in _LIMITS if name in arrays}
    f, shapes, dofs = found["frequencies"], found["shapes"], [str(name) for name in arrays["dofs"].ravel()]
    if f.ndim != 1 or not f.size or shapes.shape != (len(dofs), f.size):
        raise InputError(f"{path.name}: shapes {shapes.shape} are not {len(dofs)} rows of {f.size} numbers; {form}")
    for name in ("damping", "modal_masses"):
        if name in found and found[name].shape != f.shape:
            raise InputError(f"{path.name}: {name} has {found[name].size} entries for {f.size} modes; give one a mode")
    return ModeFile(f, found.get("damping"), found.get("modal_masses", np.ones(f.size)), dict(zip(dofs, shapes)))


def _numbers(path: Path, name: str, values: "np.ndarray[Any, np.dtype[Any]]") -> Real:
    """The array as floats. Raises InputError for what is no number, or not between its limits."""
    if values.dtype.kind not in "iuf":
        raise InputError(f"{path.name}: {name} is not an array of numbers; save it as floats")
    least, most, wanted = _LIMITS[name]
    wrong = values[~((values >= least) & (values <= most))]
    if wrong.size:
        raise InputError(f"{path.name}: {name} has {wrong.flat[0]:g}; give {wanted}")
    return np.asarray(values, float)


def read_modes_uff(path: Path) -> ModeFile:
    """Datasets 55 of a universal file. Raises InputError for one without modes, MissingExtraError without pyuff."""
    readable(path)
    try:
        import pyuff
    except ImportError as error:
        raise MissingExtraError("pyuff", "uff") from error
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = pyuff.UFF(str(path)).read_sets()
    except Exception as error:  # whatever a broken file makes pyuff raise
        raise unreadable(path, error) from None
    sets = [item for item in (found if isinstance(found, list) else [found]) if item.get("type") == 55]
    sets = [item for item in sets if item.get("analysis_type") in (_NORMAL, _COMPLEX)]
    if not sets:
        raise InputError(f"{path.name}: has no normal modes; export datasets 55 of analysis type 2 (or 3)")
    numbers = np.asarray(sets[0]["node_nums"], int)
    frequencies, ratios, masses = [], [], []
    columns: dict[str, list[float]] = {}
    for k, item in enumerate(sets):
        if not np.array_equal(np.asarray(item["node_nums"], int), numbers):
            raise InputError(
                f"{path.name}: mode {k + 1} is given at other nodes than the first; export all at the same"
            )
        frequency, ratio, mass = _figures(path, item, k)
        frequencies.append(frequency)
        ratios.append(ratio)
        masses.append(mass)
        for name, value in zip(_names(numbers, item), _shape(path, item, k)):
            columns.setdefault(name, []).append(value)
    shapes = {name: np.array(values) for name, values in columns.items() if len(values) == len(sets)}
    return ModeFile(np.array(frequencies), np.array(ratios), np.array(masses), shapes)


def _figures(path: Path, item: dict[str, Any], k: int) -> tuple[float, float, float]:
    """Frequency (Hz), damping ratio and modal mass."""
    if item["analysis_type"] == _NORMAL:
        frequency, ratio = float(item["freq"]), float(item.get("modal_damp_vis") or 0.0)
        mass = float(item.get("modal_m") or 1.0)
    else:
        pole = complex(item["eig"])
        frequency, ratio, mass = abs(pole) / (2.0 * np.pi), -pole.real / max(abs(pole), 1e-300), 1.0
    if not (np.isfinite([frequency, ratio, mass]).all() and frequency >= 0.0 and 0.0 <= ratio < 1.0 and mass > 0.0):
        raise InputError(
            f"{path.name}: mode {k + 1} has frequency {frequency:g} Hz, damping {ratio:g}, modal mass {mass:g}; mend it"
        )
    return frequency, ratio, mass


def _names(numbers: "np.ndarray[tuple[int], np.dtype[np.int_]]", item: dict[str, Any]) -> list[str]:
    count = 6 if "r4" in item else 3
    return [f"{node}:{dof}" for dof in DOFS[:count] for node in numbers]


def _shape(path: Path, item: dict[str, Any], k: int) -> Real:
    """The shape of all nodes, along ux, then uy, ...; complex ones turned to the real axis."""
    count = 6 if "r4" in item else 3
    values = np.concatenate([np.asarray(item[f"r{i + 1}"]) for i in range(count)])
    if np.isrealobj(values):
        return values.astype(float)
    turned = values * np.exp(-0.5j * np.angle(np.sum(values**2)))  # the phase that makes it as real as can be
    skew = float(np.linalg.norm(turned.imag) / max(float(np.linalg.norm(turned)), 1e-300))
    if skew > _SKEW:
        raise InputError(
            f"{path.name}: mode {k + 1} is complex, {100 * skew:.0f} % of its shape is out of phase; export real modes"
        )
    if skew > 1e-3:
        warnings.warn(f"{path.name}: mode {k + 1} was turned real, {100 * skew:.1f} % out of phase", stacklevel=2)
    return np.asarray(turned.real)
