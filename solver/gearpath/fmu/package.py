"""An FMU as a zip file whose bytes depend on its content only."""

import os
import tempfile
import zipfile
from collections.abc import Mapping
from pathlib import Path

from ..errors import InputError

_LEVEL = 3  # of compression: half the time of the usual 6, for 4 % more bytes
_EARLIEST = (1980, 1, 1, 0, 0, 0)  # the first date that a zip file can hold


def write_fmu(path: Path, files: Mapping[str, bytes]) -> Path:
    """Write `files` (name in the FMU -> content) to `path`: sorted, fixed date, whole or not at all."""
    path = Path(path)
    if not path.parent.is_dir():
        raise InputError(f"{path}: the folder does not exist; create it first")
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "wb") as stream, zipfile.ZipFile(stream, "w") as archive:
            for file in sorted(files):
                entry = zipfile.ZipInfo(file, _EARLIEST)
                entry.compress_type = zipfile.ZIP_DEFLATED
                entry.create_system = 3  # unix, on whatever machine this runs
                entry.external_attr = (0o755 if file.startswith("binaries/") else 0o644) << 16
                archive.writestr(entry, files[file], compresslevel=_LEVEL)
        umask = os.umask(0)
        os.umask(umask)
        Path(name).chmod(0o666 & ~umask)
        os.replace(name, path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
    return path
