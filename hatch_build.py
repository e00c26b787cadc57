"""Build hook: compiles the C runtime of the native FMUs for every platform, with zig, on any one machine.

Runs when a wheel or an editable install is built; by hand: `python hatch_build.py` (needs hatchling, ziglang
and fmpy). The result goes to `solver/gearpath/fmu/runtime/`: `binaries/<FMI 2 folder>/gearpath.<extension>`,
`sources/`, `pythonfmu/` (the Python side of the python kind) and `manifest.json`, which holds the hashes that decide
whether anything has to be compiled again.
"""

import hashlib
import importlib.metadata
import importlib.util
import json
import os
import struct
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

ROOT = Path(__file__).resolve().parent
SOURCES = ROOT / "fmu_src"
RUNTIME = ROOT / "solver" / "gearpath" / "fmu" / "runtime"
HEADERS = (
    *("fmi2Functions.h", "fmi2FunctionTypes.h", "fmi2TypesPlatform.h"),
    *("fmi3Functions.h", "fmi3FunctionTypes.h", "fmi3PlatformTypes.h"),
)

# -ffp-contract=off: no fused multiply-add, so that all platforms compute the same doubles.
COMMON = ("-std=c99", "-O2", "-g0", "-ffp-contract=off", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror")
SHARED = ("-shared", "-fPIC", "-fvisibility=hidden", "-Wl,-s")
MAC = (*SHARED, "-Wl,-install_name,@rpath/gearpath.dylib")
# Windows: objects without the C runtime's start-up code, linked with ucrtbase only (all of it takes minutes).
WINDOWS_OBJECTS = ("-DGP_BARE_WINDOWS",)
WINDOWS_LINK = ("-shared", "-nostdlib", "-Wl,-s", "-lkernel32", "-lucrtbase")
# file in binaries/ (the folders are FMI 2's) -> zig target and its flags
TARGETS = {
    "linux64/gearpath.so": ("x86_64-linux-gnu.2.17", SHARED),
    "aarch64-linux/gearpath.so": ("aarch64-linux-gnu.2.17", SHARED),
    "win64/gearpath.dll": ("x86_64-windows-gnu", WINDOWS_OBJECTS),
    "x86_64-darwin/gearpath.dylib": ("x86_64-macos.10.13", MAC),
    "aarch64-darwin/gearpath.dylib": ("aarch64-macos.11.0", MAC),
}
UNIVERSAL = "darwin64/gearpath.dylib"  # both macOS libraries in one file


class CustomBuildHook(BuildHookInterface):  # type: ignore[type-arg]
    """Hatchling calls this before it collects the files of a wheel (also of an editable one)."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Bring the runtime up to date, and give a wheel the models; an sdist carries the C sources instead."""
        if self.target_name == "wheel":
            build()
            if version != "editable":  # there the checkout's own folder is found
                build_data["force_include"]["models"] = "gearpath/models"


def build(runtime: Path = RUNTIME) -> bool:
    """Compile what is out of date in `runtime`; return whether anything was."""
    headers = _header_folder()
    wanted = _manifest(headers)
    if _is_current(runtime, wanted):
        return False
    runtime.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="gearpath-build-") as name:
        scratch = Path(name)
        with ThreadPoolExecutor(max_workers=2) as pool:
            jobs = {file: pool.submit(_compile, scratch, file, headers) for file in TARGETS}
        binaries = {file: job.result() for file, job in jobs.items()}
    binaries[UNIVERSAL] = universal(
        [binaries["x86_64-darwin/gearpath.dylib"], binaries["aarch64-darwin/gearpath.dylib"]]
    )
    for file, content in binaries.items():
        _write(runtime / "binaries" / file, content)
    for source in _sources():
        _write(runtime / "sources" / source.name, source.read_bytes())
    for slave in _slaves():
        _write(runtime / "pythonfmu" / slave.name, slave.read_bytes())
    for stale in {p.name for p in (runtime / "sources").iterdir()} - set(wanted["sources"]):
        (runtime / "sources" / stale).unlink()
    _write(runtime / "LICENSE.txt", (ROOT / "LICENSE").read_bytes())
    wanted["binaries"] = {file: _hash(content) for file, content in sorted(binaries.items())}
    _write(runtime / "manifest.json", (json.dumps(wanted, indent=1, sort_keys=True) + "\n").encode())
    return True


def universal(thin: Sequence[bytes]) -> bytes:
    """A fat Mach-O file of several thin 64-bit ones: big-endian header, each part aligned to 2^14 bytes."""
    align = 14
    table, body = struct.pack(">II", 0xCAFEBABE, len(thin)), b""
    start = 1 << align
    for part in thin:
        magic, processor, kind = struct.unpack_from("<III", part)
        if magic != 0xFEEDFACF:
            raise RuntimeError("zig did not write a 64-bit Mach-O library for macOS")
        body += b"\0" * (-len(body) % (1 << align))
        table += struct.pack(">IIIII", processor, kind, start + len(body), len(part), align)
        body += part
    return table.ljust(start, b"\0") + body


def without_date(library: bytes) -> bytes:
    """A Windows library with its link date (in the COFF header) set to zero: same sources, same bytes."""
    (header,) = struct.unpack_from("<I", library, 0x3C)
    if library[header : header + 4] != b"PE\0\0":
        raise RuntimeError("zig did not write a Windows library")
    return library[: header + 8] + bytes(4) + library[header + 12 :]


def _sources() -> list[Path]:
    return sorted(p for p in SOURCES.iterdir() if p.suffix in {".c", ".h"})


def _slaves() -> list[Path]:
    return sorted((SOURCES / "pythonfmu").glob("*.py"))


def _header_folder() -> Path:
    # find_spec does not run fmpy, whose own imports are many
    spec = importlib.util.find_spec("fmpy")
    if spec is None or not spec.submodule_search_locations:
        raise RuntimeError("fmpy is needed for the FMI headers; run: pip install fmpy")
    return Path(spec.submodule_search_locations[0]) / "c-code"


def _manifest(headers: Path) -> dict[str, Any]:
    return {
        "toolchain": f"ziglang {importlib.metadata.version('ziglang')}",
        "flags": {
            "common": COMMON,
            "windows_link": WINDOWS_LINK,
            **{file: TARGETS[file] for file in TARGETS},
        },
        "sources": {p.name: _hash(p.read_bytes()) for p in _sources()},
        "slaves": {p.name: _hash(p.read_bytes()) for p in _slaves()},
        "headers": {name: _hash((headers / name).read_bytes()) for name in HEADERS},
    }


def _is_current(runtime: Path, wanted: dict[str, Any]) -> bool:
    try:
        found = json.loads((runtime / "manifest.json").read_bytes())
        present = {file: _hash((runtime / "binaries" / file).read_bytes()) for file in [*TARGETS, UNIVERSAL]}
        copies = {p.name: _hash(p.read_bytes()) for p in (runtime / "sources").iterdir()}
        slaves = {p.name: _hash(p.read_bytes()) for p in (runtime / "pythonfmu").iterdir()}
        licence = (runtime / "LICENSE.txt").read_bytes() == (ROOT / "LICENSE").read_bytes()
    except (OSError, ValueError):
        return False
    wanted = json.loads(json.dumps({**wanted, "binaries": present}))
    whole = copies == wanted["sources"] and slaves == wanted["slaves"]
    return bool(found == wanted and licence and whole)


def _compile(scratch: Path, file: str, headers: Path) -> bytes:
    target, flags = TARGETS[file]
    folder = scratch / Path(file).parent
    folder.mkdir()
    sources = [str(p) for p in _sources() if p.suffix == ".c"]
    command = ["-target", target, *COMMON, *flags, "-isystem", str(headers)]
    output = Path(file).name
    if file.endswith(".dll"):
        for source in sources:
            _zig([*command, "-c", source, "-o", Path(source).stem + ".obj"], folder)
        objects = [Path(source).stem + ".obj" for source in sources]
        _zig(["-target", target, "-o", output, *objects, *WINDOWS_LINK], folder)
        return without_date((folder / output).read_bytes())
    _zig([*command, "-o", output, *sources], folder)
    return (folder / output).read_bytes()


def _zig(arguments: Sequence[str], folder: Path) -> None:
    # The global cache holds the C libraries and is worth keeping; the local one goes with the scratch folder.
    user = os.getuid() if hasattr(os, "getuid") else "user"
    caches = {
        "ZIG_GLOBAL_CACHE_DIR": str(Path(tempfile.gettempdir()) / f"gearpath-zig-{user}"),
        "ZIG_LOCAL_CACHE_DIR": str(folder / "cache"),
    }
    command = [sys.executable, "-m", "ziglang", "cc", *arguments]
    done = subprocess.run(
        command, cwd=folder, env={**caches, **os.environ}, capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise RuntimeError(f"the FMU runtime did not compile:\n{' '.join(command)}\n{done.stdout}{done.stderr}")


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _write(path: Path, content: bytes) -> None:
    """Write whole or not at all, so that builds at the same time do not harm each other."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=".new-")
    with os.fdopen(handle, "wb") as stream:
        stream.write(content)
    os.chmod(name, 0o644)
    os.replace(name, path)


if __name__ == "__main__":
    print("compiled" if build() else "up to date", "in", RUNTIME)
