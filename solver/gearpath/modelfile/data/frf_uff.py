"""FRFs from a universal file: datasets 58 (functions at nodal degrees of freedom) and 164 (units), by pyuff.

A channel is a node and a direction along a positive axis, such as "12:uy". A function measured along a negative axis
changes its sign; of a function that is there more than once the last one counts.
"""

import warnings
from pathlib import Path
from typing import Any

import numpy as np

from ...components.dofs import DOFS
from ...errors import InputError, MissingExtraError
from ...numerics.arrays import Complex, Real
from .frf import FrfFile, as_lines, unreadable

_FRF = 4  # function type
_QUANTITIES = {8: "receptance", 11: "mobility", 12: "accelerance"}  # of the ordinate's numerator
_UNKNOWN = (0, 1)  # data types that say nothing
_FORCES = (9, 13)  # reaction force, excitation force
_DIRECTIONS = ("rsp_dir", "ref_dir")
_MANTISSA = 1e-6  # spacing of lines that are the same, relative


def read_uff(path: Path) -> FrfFile:
    """Raises InputError for a file without FRFs that belong together, MissingExtraError without pyuff."""
    sets = _sets(path)
    functions = [item for item in sets if item.get("type") == 58 and int(item.get("func_type", 0)) == _FRF]
    if not functions:
        raise InputError(f"{path.name}: has no frequency response function; export datasets 58 of function type 4")
    x = np.asarray(functions[0]["x"], float)
    found: dict[tuple[str, str], Complex] = {}
    for item in functions:
        found |= _function(path, item, x)
    names = tuple(dict.fromkeys(name for pair in found for name in pair))
    frf = np.full((len(x), len(names), len(names)), np.nan, complex)
    for (row, column), values in found.items():
        frf[:, names.index(row), names.index(column)] = values
    f, H = as_lines(x, frf, path.name)
    units = next((item for item in sets if item.get("type") == 164), {})
    # dataset 164 holds the numbers by which the file's values are divided to give SI
    length, force = (1.0 / float(units[key]) if units.get(key) else None for key in ("length", "force"))
    labels = (_label(path, functions, key) for key in ("ordinate_axis_units_lab", "orddenom_axis_units_lab"))
    return FrfFile(f, H, names, _quantity(path, functions), length, force, *labels)


def _sets(path: Path) -> list[dict[str, Any]]:
    try:
        import pyuff
    except ImportError as error:
        raise MissingExtraError("pyuff", "uff") from error
    if not path.is_file():
        raise InputError(f"{path.name}: there is no such file; give the path of a universal file (UFF)")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = pyuff.UFF(str(path)).read_sets()
    except Exception as error:  # whatever a broken file makes pyuff raise
        raise unreadable(path, error) from None
    return list(found) if isinstance(found, list) else [found]


def _function(path: Path, item: dict[str, Any], x: Real) -> dict[tuple[str, str], Complex]:
    """The function by response and force channel."""
    row, row_sign = _channel(path, item, "rsp")
    column, column_sign = _channel(path, item, "ref")
    own = np.asarray(item["x"], float)
    if own.shape != x.shape or abs(own - x).max() > _MANTISSA * abs(x).max():
        raise InputError(
            f"{path.name}: the FRF from {column} to {row} has other lines than the first; export all on the same lines"
        )
    if int(item.get("orddenom_spec_data_type") or 0) not in (*_UNKNOWN, *_FORCES):
        raise InputError(f"{path.name}: the FRF from {column} to {row} is not related to a force; export FRFs")
    values = np.asarray(item["data"]).astype(np.complex128)
    return {(row, column): np.asarray(row_sign * column_sign * values, np.complex128)}


def _channel(path: Path, item: dict[str, Any], side: str) -> tuple[str, float]:
    """(name, sign) of the response ("rsp") or the force ("ref")."""
    node, direction = int(item[f"{side}_node"]), int(item[f"{side}_dir"])
    if not 1 <= abs(direction) <= 6:
        raise InputError(f"{path.name}: node {node} has the direction {direction}; give one from 1 to 6 (+X to +RZ)")
    return f"{node}:{DOFS[abs(direction) - 1]}", 1.0 if direction > 0 else -1.0


def _label(path: Path, functions: list[dict[str, Any]], key: str) -> str:
    """The unit on an axis of translations, "" where there is none."""
    own = {str(item.get(key) or "").strip() for item in functions if max(abs(int(item[k])) for k in _DIRECTIONS) <= 3}
    own -= {"", "NONE", "none", "None"}
    if len(own) > 1:
        raise InputError(f"{path.name}: has FRFs in {' and '.join(sorted(own))}; export all in the same units")
    return own.pop() if own else ""


def _quantity(path: Path, functions: list[dict[str, Any]]) -> str:
    kinds = {int(item.get("ordinate_spec_data_type") or 0) for item in functions} - set(_UNKNOWN)
    if len(kinds) > 1 or not kinds <= set(_QUANTITIES):
        shown = ", ".join(str(kind) for kind in sorted(kinds))
        raise InputError(
            f"{path.name}: the FRFs have the data types {shown}; export either accelerance (12), mobility (11) or "
            "receptance (8)"
        )
    return _QUANTITIES[kinds.pop()] if kinds else ""
