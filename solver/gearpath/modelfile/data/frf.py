"""What a file of frequency responses holds, whatever its format."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...errors import InputError
from ...numerics.arrays import Complex, Real


@dataclass(frozen=True)
class FrfFile:
    """FRFs between n channels on F lines in the file's own units; NaN where the file has no FRF of that pair."""

    frequencies: Real  # (F,), Hz
    frf: Complex  # (F, n, n): response row, force column
    channels: tuple[str, ...]  # names; a channel may be named by its number from 0 on as well
    quantity: str = ""  # accelerance, mobility or receptance, where the file says it
    length: float | None = None  # m per unit of length of the file, where it says so
    force: float | None = None  # N per unit of force of the file, likewise
    motion_label: str = ""  # what it writes on the axis of the response
    force_label: str = ""  # and of the force


def as_lines(frequencies: Real, frf: Complex, what: str) -> tuple[Real, Complex]:
    """The lines in increasing order without 0 Hz; raises InputError for what cannot be lines."""
    if frequencies.ndim != 1 or not np.isfinite(frequencies).all() or (frequencies < 0.0).any():
        raise InputError(f"{what}: frequencies are not finite numbers from 0 up; give them in Hz")
    order = np.argsort(frequencies, kind="stable")
    order = order[frequencies[order] > 0.0]
    f = frequencies[order]
    if len(f) < 2:
        raise InputError(f"{what}: has {len(f)} lines above 0 Hz; give at least two")
    twice = f[1:][np.diff(f) <= 0.0]
    if twice.size:
        raise InputError(f"{what}: the line {twice[0]:g} Hz is there twice; keep one of them")
    return f, frf[order]


def unreadable(path: Path, error: Exception) -> InputError:
    """The refusal of a file that cannot be read."""
    reason = getattr(error, "strerror", None) or str(error).splitlines()[0] if str(error) else type(error).__name__
    return InputError(f"{path.name}: cannot be read ({reason}); check the path and the format of the file")
