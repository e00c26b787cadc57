"""The compiled C runtime that the wheel brings along (hatch_build.py makes it)."""

from pathlib import Path

from ..errors import GearpathError

RUNTIME = Path(__file__).parent / "runtime"
# FMI 2 folders and the extension of the library in each; darwin64 holds both macOS architectures.
PLATFORMS = {
    "linux64": ".so",
    "aarch64-linux": ".so",
    "win64": ".dll",
    "darwin64": ".dylib",
    "aarch64-darwin": ".dylib",
}
# FMI 3 folders, and the FMI 2 folder that the library of each stands in.
_PLATFORMS3 = {
    "x86_64-linux": "linux64",
    "aarch64-linux": "aarch64-linux",
    "x86_64-windows": "win64",
    "x86_64-darwin": "x86_64-darwin",
    "aarch64-darwin": "aarch64-darwin",
}


def binaries(fmi: str = "2.0", runtime: Path | None = None) -> dict[tuple[str, str], bytes]:
    """The library of every platform, by folder and extension."""
    folder = (runtime or RUNTIME) / "binaries"
    stored = _PLATFORMS3 if fmi == "3.0" else {name: name for name in PLATFORMS}
    found = {}
    for name, store in stored.items():
        extension = PLATFORMS.get(store, ".dylib")
        found[name, extension] = _read(folder / store / f"gearpath{extension}")
    return found


def sources(fmi: str = "2.0", runtime: Path | None = None) -> dict[str, bytes]:
    """The C sources by file name: the core and one adapter. Importers bring the headers of FMI themselves."""
    folder = (runtime or RUNTIME) / "sources"
    other = "fmi2_" if fmi == "3.0" else "fmi3_"
    names = [file for file in sorted(folder.glob("*_*.[ch]")) if not file.name.startswith(other)]
    files = {file.name: file.read_bytes() for file in names}
    if not files:
        raise _missing(folder)
    return files


def licence(runtime: Path | None = None) -> bytes:
    """Gearpath's licence, which holds for the runtime."""
    return _read((runtime or RUNTIME) / "LICENSE.txt")


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise _missing(path) from error


def _missing(path: Path) -> GearpathError:
    return GearpathError(
        f"the FMU runtime is not complete ({path} is missing); install Gearpath again, or run "
        "python hatch_build.py in its source folder"
    )
