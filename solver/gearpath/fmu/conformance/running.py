"""Runs the binary of this machine in a process of its own, so that a crash is a finding and not the end."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from .contents import Fmu
from .finding import Finding, Severity, error, note
from .platforms import of_host, promised

NOT_RUN = note("binary-not-run", "The numeric checks need a binary for this machine.")
CRASH = error("binary-crash", "The binary neither crashes nor hangs.", "2.1.3", "2.2")

_PATIENCE = 300.0  # s


def library_of(fmu: Fmu, interface: str, folder: Path) -> Path | None:
    """The unpacked library of an interface type for this machine."""
    identifier = fmu.interfaces[interface].get("modelIdentifier", "")
    for name in of_host(fmu.version):
        platform = promised(fmu.version, name)
        path = folder / "binaries" / name / f"{identifier}{platform.suffix if platform else ''}"
        if platform and path.is_file():
            return path
    return None


def check(fmu: Fmu) -> Iterator[Finding]:
    """Unpack, run, and collect what the process finds before it ends, however it ends."""
    with tempfile.TemporaryDirectory(prefix="gearpath-", ignore_cleanup_errors=True) as name:
        folder = Path(name)
        unpack(fmu, folder / "fmu")
        kinds = [kind for kind in fmu.interfaces if kind != "ScheduledExecution"]
        if not any(library_of(fmu, kind, folder / "fmu") for kind in kinds):
            machine = " or ".join(of_host(fmu.version))
            message = f"binaries/ has none for this machine ({machine}): it was not run, no numbers were checked"
            yield NOT_RUN.found(fmu.version, message)
            return
        yield from _run(fmu, folder)


def unpack(fmu: Fmu, folder: Path) -> None:
    """Write all files of an FMU, whose names were checked, below a folder."""
    for name in fmu.archive.names:
        content = fmu.archive.read(name)
        if content is not None:
            target = folder / name
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)


def _run(fmu: Fmu, folder: Path) -> Iterator[Finding]:
    result, reason = folder / "found.jsonl", ""
    command = [sys.executable, "-m", "gearpath.fmu.conformance.probe", str(fmu.archive.path.resolve())]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(p or os.getcwd() for p in sys.path)}
    try:
        done = subprocess.run(
            [*command, str(folder / "fmu"), str(result)],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=_PATIENCE,
            env=environment,
        )
        if done.returncode:
            last = done.stderr.decode("utf-8", "replace").strip().splitlines()[-1:]
            reason = f"ended with code {done.returncode}" + (f" ({last[0]})" if last else "")
    except subprocess.TimeoutExpired:
        reason = f"did not come back in {_PATIENCE:.0f} s"
    doing = "loading"
    for line in result.read_text("utf-8").splitlines() if result.is_file() else []:
        entry: dict[str, Any] = json.loads(line)
        if "doing" in entry:
            doing = entry["doing"]
        else:
            yield Finding(entry["rule"], Severity(entry["severity"]), entry["message"], entry["clause"])
    if reason:
        yield CRASH.found(fmu.version, f"the binary {reason} while {doing}; run it in a debugger")
