"""Values, keys and plain data as a model file writes them."""

import json
import re
from collections.abc import Iterable, Mapping
from datetime import date, time

import numpy as np

NAME = r"^[A-Za-z][A-Za-z0-9_]*$"
_LONGEST = 60


def show(value: object) -> str:
    """A value as a one-line TOML writer would put it, cut to a readable length."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        text = json.dumps(value, ensure_ascii=False)
    elif isinstance(value, (date, time)):
        text = value.isoformat()
    elif isinstance(value, Mapping):
        return "a table"
    elif isinstance(value, list):
        text = f"[{', '.join(show(item) for item in value[:_LONGEST])}]"
    elif isinstance(value, int) and abs(value) >= 10**_LONGEST:
        return "an integer of more than 60 digits"
    else:
        text = repr(value)
    text = " ".join(text.split())
    return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."


def dotted(parts: Iterable[object]) -> str:
    """A key as a dotted path, "joints.bearing_1.stiffness"; odd parts are quoted as in TOML."""
    return ".".join(part if isinstance(part, str) and re.fullmatch(r"[\w-]+", part) else show(part) for part in parts)


def plain(value: object) -> object:
    """A deep copy in the types of a file: arrays and tuples as lists, numpy scalars as Python numbers."""
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    return value
