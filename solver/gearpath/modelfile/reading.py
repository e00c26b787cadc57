"""Reading a TOML file, with every failure as one sentence."""

import re
import tomllib
from os import PathLike
from pathlib import Path
from typing import Any

from ..errors import InputError, ModelError


def read_toml(path: str | PathLike[str]) -> dict[str, Any]:
    """The data of a TOML file; raises InputError where it cannot be read, ModelError where it is not TOML."""
    text = _text(path)
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise ModelError("the file", "is nested too deeply", "write flat tables", file=str(path)) from None
    except ValueError as error:  # TOMLDecodeError, and integers too long for Python
        raise _syntax_error(str(error), text, str(path)) from None


def _text(path: str | PathLike[str]) -> str:
    try:
        data = Path(path).read_bytes()
    except FileNotFoundError:
        raise InputError(f"{path}: there is no such file; give the path of a model file (TOML)") from None
    except IsADirectoryError:
        raise InputError(f"{path}: this is a folder; give the path of a model file (TOML)") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"{path}: cannot be read ({reason}); check the path and its permissions") from None
    if data.startswith(b"PK\x03\x04"):
        raise InputError(f"{path}: this is a ZIP archive, such as an FMU; give the path of a model file (TOML)")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        byte = f"byte 0x{data[error.start]:02x} is not UTF-8"
        raise ModelError(f"line {line}", byte, "save the file as UTF-8 text", file=str(path)) from None


def _syntax_error(message: str, text: str, path: str) -> ModelError:
    found = re.fullmatch(r"(?P<what>.*) \(at (?:line (?P<line>\d+), column (?P<column>\d+)|end of document)\)", message)
    if found is None:
        return ModelError("the file", f"is not TOML ({message})", "correct it", file=path)
    what = found["what"]
    last = max(len(text.splitlines()), 1)
    where = f"line {found['line']}, column {found['column']}" if found["line"] else f"line {last} (end of the file)"
    if what.startswith(("Cannot overwrite", "Cannot declare", "Cannot mutate", "Cannot redefine", "Duplicate")):
        return ModelError(where, f"a key or table is given twice ({what})", "keep one of them", file=path)
    return ModelError(where, f"this is not TOML ({what})", "correct the line", file=path)
