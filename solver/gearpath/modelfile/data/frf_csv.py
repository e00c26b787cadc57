"""FRFs from a text table: a header frequency_hz, H[a,b].re, H[a,b].im, ..., then a row of numbers for every line.

H[a,b] is the response of channel a to a force on channel b; a pair may be left out where H[b,a] is there.
"""

import csv
import re
from pathlib import Path

import numpy as np

from ...errors import InputError
from .frf import FrfFile, as_lines, unreadable

_COLUMN = re.compile(r"H\[(?P<row>[^,\[\]]+),(?P<column>[^,\[\]]+)\]\.(?P<part>re|im)")
_FORM = 'write the header frequency_hz,"H[a,b].re","H[a,b].im",... with the names of response and force'


def read_csv(path: Path) -> FrfFile:
    """Raises InputError for what is no such table."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = [row for row in csv.reader(file) if row and not row[0].lstrip().startswith("#")]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise unreadable(path, error) from None
    if not rows or rows[0][0].strip() != "frequency_hz":
        raise InputError(f"{path.name}: does not begin with the column frequency_hz; {_FORM}")
    places = _places(path, _rejoined(rows[0]))
    numbers = _numbers(path, rows[1:], len(places) + 1)
    names = tuple(dict.fromkeys(name for row, column, _ in places for name in (row, column)))
    frf = np.full((len(numbers), len(names), len(names)), np.nan, complex)
    parts = {key: numbers[:, k] for k, key in enumerate(places, start=1)}
    for row, column, _ in places:
        if (row, column, "re") not in parts or (row, column, "im") not in parts:
            raise InputError(f"{path.name}: H[{row},{column}] has only one of .re and .im; give both")
        value = parts[row, column, "re"] + 1j * parts[row, column, "im"]
        frf[:, names.index(row), names.index(column)] = value
    f, H = as_lines(numbers[:, 0], frf, path.name)
    return FrfFile(f, H, names)


def _rejoined(header: list[str]) -> list[str]:
    """The header with names that were written without quotes and fell apart at their comma."""
    out: list[str] = []
    for cell in (cell.strip() for cell in header):
        if out and out[-1].startswith("H[") and "]" not in out[-1]:
            out[-1] = f"{out[-1]},{cell}"
        else:
            out.append(cell)
    return out


def _places(path: Path, header: list[str]) -> list[tuple[str, str, str]]:
    """(response, force, part) of every column behind the frequencies."""
    places = []
    for name in header[1:]:
        found = _COLUMN.fullmatch(name)
        if found is None:
            raise InputError(f"{path.name}: the column {name!r} is no FRF; {_FORM}")
        place = (found["row"].strip(), found["column"].strip(), found["part"])
        if place in places:
            raise InputError(f"{path.name}: the column {name!r} is there twice; keep one of them")
        places.append(place)
    if not places:
        raise InputError(f"{path.name}: has no FRF; {_FORM}")
    return places


def _numbers(path: Path, rows: list[list[str]], width: int) -> "np.ndarray[tuple[int, int], np.dtype[np.float64]]":
    out = np.empty((len(rows), width))
    for k, row in enumerate(rows):
        try:
            if len(row) != width:
                raise ValueError(f"{len(row)} columns in place of {width}")
            out[k] = [float(cell) for cell in row]
        except ValueError as error:
            raise InputError(f"{path.name}: row {k + 1} of the table has {error}; correct it") from None
    return out
