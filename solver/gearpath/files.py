"""Writing files so that nothing is lost: a temporary name beside the target, then a move."""

import os
import tempfile
from pathlib import Path

from .errors import InputError


def write_bytes(path: Path, content: bytes) -> Path:
    """Write `content` to `path` whole or not at all; raises InputError where the place cannot be written."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(content)
            mask = os.umask(0)
            os.umask(mask)
            Path(temporary).chmod(0o666 & ~mask)
            Path(temporary).replace(path)
        except BaseException:
            Path(temporary).unlink(missing_ok=True)
            raise
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror}); choose another place") from error
    return path


def write_text(path: Path, text: str) -> Path:
    """Write text (UTF-8) whole or not at all."""
    return write_bytes(path, text.encode())
