"""The process that runs a binary: writes what it does and finds, line by line, to a file.

python -m gearpath.fmu.conformance.probe FMU UNPACKED_FOLDER RESULT
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterator
from dataclasses import asdict
from pathlib import Path

from . import probe_calls, probe_slopes, probe_state
from .archive import Archive
from .contents import Fmu
from .documents import DESCRIPTION, parse
from .finding import Finding
from .instance import CallError
from .reading import read, version_of
from .running import library_of

_CHECKS: tuple[tuple[str, Callable[[Fmu, Path, Path, str], Iterator[Finding]]], ...] = (
    ("it started", probe_calls.check),
    ("its state was saved", probe_state.check),
    ("its derivatives were compared", probe_slopes.check),
)


def main(path: str, folder: str, result: str) -> None:
    """Run every check on every interface type that has a binary here."""
    with Archive.open(Path(path)) as archive, open(result, "w", encoding="utf-8") as out:
        root, _ = parse(archive, DESCRIPTION)
        fmu = read(archive, version_of(root) or 0, root, {})
        for interface in fmu.interfaces:
            library = library_of(fmu, interface, Path(folder)) if interface != "ScheduledExecution" else None
            if library is None:
                continue
            for doing, check in _CHECKS:
                _write(out.write, {"doing": f"{doing} ({interface})"})
                out.flush()
                try:
                    for finding in check(fmu, Path(folder), library, interface):
                        _write(out.write, asdict(finding))
                except CallError as problem:
                    message = f"{library.name} ({interface}): {problem}; let the call succeed"
                    _write(out.write, asdict(probe_calls.CALL.found(fmu.version, message)))
                    break
                finally:
                    out.flush()


def _write(write: Callable[[str], int], entry: dict[str, str]) -> None:
    write(json.dumps(entry) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:4])
    sys.stdout.flush()
    os._exit(0)  # some binaries abort when the process takes itself apart: that is not what is checked
