"""The zip archive of an FMU: what any importer must be able to unpack, and what none should."""

from __future__ import annotations

import re
import stat
import zipfile
import zlib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from .finding import Finding, error, warning

UNREADABLE = error("archive-unreadable", "The file is a complete ZIP archive.", "2.3", "2.5")
SUFFIX = error("archive-suffix", "The file name ends in .fmu.", "2.3", "2.5")
PATH = error("archive-path", "Entries stay in the archive: forward slashes, no .., no absolute path.", "2.3", "2.5")
LINK = error("archive-link", "The archive holds no links.", "2.3", "2.5")
DUPLICATE = error("archive-duplicate", "No two entries have the same name.", "2.3", "2.5")
CASE = warning("archive-case", "No two names differ in upper and lower case only.", "2.3", "2.5")
METHOD = error("archive-method", "Entries are stored or deflated, at ZIP version 2.0, and not encrypted.", "2.3", "2.5")
ASCII = warning("archive-ascii", "File names are ASCII.", "2.3", "2.5")
BOMB = error("archive-bomb", "Entries unpack to a reasonable size.")
DAMAGED = error("archive-damaged", "Every entry unpacks to its checksum.", "2.3", "2.5")

_LARGEST, _TOTAL = 2**31, 2**32  # bytes
_RATIO, _RATIO_FROM = 1000, 2**24  # deflate reaches 1032
_FAILURES = (OSError, EOFError, zipfile.BadZipFile, zlib.error, RuntimeError, NotImplementedError, ValueError)


class UnreadableError(Exception):
    """The archive cannot be opened at all."""


@dataclass
class Archive:
    """An open archive; entries are read when they are asked for."""

    path: Path
    file: zipfile.ZipFile
    names: frozenset[str]  # of files
    damaged: set[str] = field(default_factory=set)

    @classmethod
    def open(cls, path: Path) -> Archive:
        """Open; raises UnreadableError with the reason."""
        try:
            file = zipfile.ZipFile(path)
        except _FAILURES as problem:
            raise UnreadableError(getattr(problem, "strerror", None) or str(problem) or "damaged") from problem
        return cls(path, file, frozenset(i.orig_filename for i in file.infolist() if not i.is_dir()))

    def __enter__(self) -> Archive:
        return self

    def __exit__(self, *_: object) -> None:
        self.file.close()

    def read(self, name: str) -> bytes | None:
        """Content of an entry, or None where there is none or it is damaged."""
        if name not in self.names or name in self.damaged:
            return None
        try:
            return self.file.read(name)
        except (*_FAILURES, KeyError):
            self.damaged.add(name)
            return None

    def under(self, folder: str) -> list[str]:
        """Names of the files below a folder, sorted."""
        return sorted(name for name in self.names if name.startswith(folder + "/"))


def check(archive: Archive) -> Iterator[Finding]:
    """Names, links, methods, sizes and checksums of all entries."""
    entries = archive.file.infolist()
    if archive.path.suffix != ".fmu":
        yield SUFFIX.found(None, f'"{archive.path.name}" does not end in .fmu; rename it')
    for entry in entries:
        yield from _entry(entry)
    yield from _repeated([entry.orig_filename for entry in entries])
    bombs = [entry for entry in entries if _bomb(entry)]
    for entry in bombs:
        yield BOMB.found(None, f'"{entry.orig_filename}" unpacks to {entry.file_size} bytes; do not unpack this file')
    total = sum(entry.file_size for entry in entries)
    if total > _TOTAL:
        yield BOMB.found(None, f"the archive unpacks to {total} bytes; do not unpack this file")
    if bombs or total > _TOTAL:
        archive.damaged.update(entry.orig_filename for entry in bombs)
        return
    for entry in entries:
        if not entry.is_dir() and not _checksum_holds(archive, entry):
            archive.damaged.add(entry.orig_filename)
            yield DAMAGED.found(None, f'"{entry.orig_filename}" does not unpack to its checksum; zip it again')


def _entry(entry: zipfile.ZipInfo) -> Iterator[Finding]:
    name = entry.orig_filename
    parts = PurePosixPath(name).parts
    outside = name.startswith("/") or ".." in parts or re.match("[A-Za-z]:", name)
    if outside or re.search(r"[\\\0-\x1f]", name):
        yield PATH.found(None, f"the entry {name!r} is no plain path inside the archive; use names such as a/b.txt")
    if stat.S_ISLNK(entry.external_attr >> 16):
        yield LINK.found(None, f'the entry "{name}" is a symbolic link; store the file itself')
    encrypted, streamed = entry.flag_bits & 0x1, entry.flag_bits & 0x8 and entry.compress_type == zipfile.ZIP_STORED
    if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED) or entry.extract_version > 20:
        method = f"method {entry.compress_type}, version {entry.extract_version / 10}"
        yield METHOD.found(None, f'the entry "{name}" needs {method} of ZIP; deflate it at version 2.0')
    if encrypted or streamed:
        what = "is encrypted" if encrypted else "is stored without its size in the header"
        yield METHOD.found(None, f'the entry "{name}" {what}; deflate it instead')
    if not name.isascii():
        yield ASCII.found(
            None, f'the entry "{name}" has letters outside ASCII, which some systems cannot unpack; rename it'
        )


def _repeated(names: list[str]) -> Iterator[Finding]:
    for name, count in Counter(names).items():
        if count > 1:
            yield DUPLICATE.found(None, f'the archive holds "{name}" {count} times; keep one')
    spelled: dict[str, set[str]] = {}
    for name in names:
        spelled.setdefault(name.lower(), set()).add(name)
    for same in spelled.values():
        if len(same) > 1:
            listed = " and ".join(f'"{name}"' for name in sorted(same))
            yield CASE.found(None, f"{listed} are one file on Windows and macOS; rename one")


def _bomb(entry: zipfile.ZipInfo) -> bool:
    dense = entry.file_size > _RATIO_FROM and entry.file_size > _RATIO * max(entry.compress_size, 1)
    return entry.file_size > _LARGEST or dense


def _checksum_holds(archive: Archive, entry: zipfile.ZipInfo) -> bool:
    try:
        with archive.file.open(entry) as stream:
            while stream.read(2**20):
                pass
    except _FAILURES:
        return False
    return True
