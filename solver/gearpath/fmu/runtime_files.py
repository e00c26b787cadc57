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


def binaries(runtime: Path | None = None) -> dict[str, bytes]:
    """The library of every platform, by FMI 2 folder."""
    folder = (runtime or RUNTIME) / "binaries"
    return {name: _read(folder / name / f"gearpath{extension}") for name, extension in PLATFORMS.items()}


def sources(runtime: Path | None = None) -> dict[str, bytes]:
    """The C sources and the FMI headers, by file name."""
    folder = (runtime or RUNTIME) / "sources"
    files = {file.name: file.read_bytes() for file in sorted(folder.glob("*.[ch]"))}
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
