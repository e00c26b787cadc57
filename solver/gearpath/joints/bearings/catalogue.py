"""Bearings by designation, from data files that users can extend."""

from __future__ import annotations

import tomllib
from functools import lru_cache
from pathlib import Path
from typing import Any

from ...errors import InputError
from .ball import BallBearing
from .roller import RollerBearing
from .rolling import RollingBearing

OWN = Path(__file__).with_name("catalogue.toml")
_TYPES = ("ball", "roller")


def designations(file: str | Path | None = None) -> dict[str, str]:
    """What is in the catalogue (or in another file of its form), each with the source of its numbers."""
    return {name: str(entry.get("source", "")) for name, entry in _read(_path(file)).items()}


def catalogue_bearing(designation: str, file: str | Path | None = None, **changes: Any) -> RollingBearing:
    """The bearing of this designation, such as "7210B-like"; `changes` replace single numbers of it.

    Raises InputError for an unknown designation, a file that cannot be read, and an entry that is no bearing.
    """
    path = _path(file)
    entries = _read(path)
    if designation not in entries:
        raise InputError(f"{path.name}: there is no bearing {designation!r}; there are {', '.join(entries)}")
    entry = {**entries[designation], **changes}
    entry.pop("source", None)
    kind = entry.pop("type", None)
    if kind not in _TYPES:
        raise InputError(f"{path.name}: {designation}.type: {kind!r} is none of {', '.join(_TYPES)}")
    try:
        return BallBearing(**entry) if kind == "ball" else RollerBearing(**entry)
    except TypeError as error:  # a key that is missing, or that no bearing has
        words = str(error).split("__init__() ")[-1]
        raise InputError(f"{path.name}: {designation}: {words}") from None
    except InputError as error:
        raise InputError(f"{path.name}: {designation}: {error}") from None


def _path(file: str | Path | None) -> Path:
    return OWN if file is None else Path(file)


def _read(path: Path) -> dict[str, dict[str, Any]]:
    try:
        return _parsed(path, path.stat().st_mtime_ns)
    except OSError as error:
        reason = error.strerror or str(error)
        raise InputError(f"{path}: cannot be read ({reason}); give the path of a bearing catalogue (TOML)") from None


@lru_cache(maxsize=8)
def _parsed(path: Path, _changed: int) -> dict[str, dict[str, Any]]:
    """The entries of a file as it was when it was last changed."""
    try:
        entries = tomllib.loads(path.read_text("utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: {error}; a bearing catalogue is TOML with a table for each designation") from None
    wrong = [name for name, entry in entries.items() if not isinstance(entry, dict)]
    if wrong:
        raise InputError(f"{path}: {wrong[0]} is not in a table; begin with [DESIGNATION]")
    return entries
