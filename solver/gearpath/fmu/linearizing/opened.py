"""Any FMU, opened and unpacked to be run by model exchange; what cannot be is refused with a sentence."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from ...errors import InputError, MissingExtraError
from ..conformance import archive, documents
from ..conformance.contents import FILE, Fmu
from ..conformance.platforms import of_host
from ..conformance.reading import read, version_of
from ..conformance.running import library_of, unpack

KIND = "ModelExchange"


@dataclass(frozen=True)
class Unpacked:
    """An FMU on disk, with a library for this machine."""

    fmu: Fmu
    folder: Path
    library: Path


@contextmanager
def opened(path: Path) -> Iterator[Unpacked]:
    """Unpack an FMU of FMI 2.0 or 3.0 into a temporary folder.

    Raises InputError for a file that is none, one without model exchange or without a library for this machine, and
    MissingExtraError without fmpy or lxml.
    """
    try:
        import fmpy  # noqa: F401
    except ImportError as error:
        raise MissingExtraError("fmpy", "fmu") from error
    if not path.is_file():
        raise InputError(f"{path}: cannot be read (no such file); give the path of an FMU")
    try:
        with archive.Archive.open(path) as file:
            fmu = _described(path, file)
            with tempfile.TemporaryDirectory(prefix="gearpath-", ignore_cleanup_errors=True) as name:
                unpack(fmu, Path(name))
                yield Unpacked(fmu, Path(name), _library(path, fmu, Path(name)))
    except archive.UnreadableError as problem:
        raise InputError(f"{path}: is no FMU, which is a ZIP archive ({problem}); give the path of an FMU") from problem


def _described(path: Path, file: archive.Archive) -> Fmu:
    unsafe = {archive.PATH.id, archive.LINK.id, archive.BOMB.id, archive.DAMAGED.id}
    for finding in archive.check(file):
        if finding.rule in unsafe:
            raise InputError(f"{path}: {finding.message}")
    root, problems = documents.parse(file, documents.DESCRIPTION)
    if root is None:
        reason = problems[-1].message if problems else f"{FILE} is not at the top of the archive; give an FMU"
        raise InputError(f"{path}: is no FMU: {reason}")
    version = version_of(root)
    if version is None:
        stated = root.get("fmiVersion", "")
        raise InputError(f'{path}: is of FMI "{stated}"; only FMUs of FMI 2.0 and 3.0 can be linearised')
    fmu = read(file, version, root, {})
    if KIND not in fmu.interfaces:
        raise InputError(
            f"{path}: has no model exchange interface, so that its states and derivatives cannot be reached; "
            "export it with model exchange"
        )
    return fmu


def _library(path: Path, fmu: Fmu, folder: Path) -> Path:
    library = library_of(fmu, KIND, folder)
    if library is None:
        machine = " or ".join(of_host(fmu.version))
        raise InputError(f"{path}: holds no binary for this machine ({machine}); compile it for this platform")
    return library
