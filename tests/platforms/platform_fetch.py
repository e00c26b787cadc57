"""Find what the platform tests need, or get it from Debian's packages: Wine and QEMU, which run the Windows and the Arm
library of an FMU here, and a C compiler and CMake, with which importers compile an FMU's sources.

    python3 tests/platforms/platform_fetch.py

Needs nothing but Python, and root where a package is missing. Prints where everything is; exit code 1 and what is
missing where it cannot be had. x86-64 Linux only: that is where the test stage runs.
"""

import os
import platform
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

REQUIRED = "GEARPATH_REQUIRE_PLATFORMS"  # set in CI: a program that is missing is a failure there
COMMAND = "python3 tests/platforms/platform_fetch.py"
SYSROOT = Path("/usr/aarch64-linux-gnu")  # of Debian's C library for Arm


@dataclass(frozen=True)
class Tool:
    """One thing that is needed: the places it may be in, and the Debian package that brings it."""

    name: str
    package: str
    places: tuple[str, ...]

    def find(self) -> Path | None:
        """Where it is, or None."""
        found = (shutil.which(place) if os.sep not in place else place for place in self.places)
        return next((Path(place) for place in found if place and Path(place).exists()), None)


WINE = Tool("Wine", "wine64", ("wine64", "wine64-stable", "/usr/lib/wine/wine64", "/opt/wine-stable/bin/wine64"))
QEMU = Tool("QEMU for Arm programs", "qemu-user-static", ("qemu-aarch64-static", "qemu-aarch64"))
OLD = Tool("QEMU for x86-64 programs", "qemu-user-static", ("qemu-x86_64-static", "qemu-x86_64"))
ARM = Tool("the C library for Arm", "libc6-arm64-cross", (str(SYSROOT / "lib" / "ld-linux-aarch64.so.1"),))
COMPILER = Tool("a C compiler", "gcc", ("gcc",))
HEADERS = Tool("the C library's headers", "libc6-dev", ("/usr/include/stdlib.h",))
MAKE = Tool("make", "make", ("make",))
CMAKE = Tool("CMake", "cmake", ("cmake",))
BUILDERS = (COMPILER, HEADERS, MAKE, CMAKE)
TOOLS = (WINE, QEMU, OLD, ARM, *BUILDERS)


def advice(tools: Sequence[Tool]) -> str:
    """What is missing among `tools` and how to get it, in one sentence; empty where nothing is."""
    missing = [tool for tool in tools if tool.find() is None]
    if not missing:
        return ""
    names = " and ".join(f"{tool.name} (Debian: {tool.package})" for tool in missing)
    return f"no {names} here: run `{COMMAND}` as root"


def fetch() -> None:
    """Install what is missing; raises RuntimeError where that cannot be done."""
    problem = advice(TOOLS)
    if not problem:
        return
    if platform.machine() != "x86_64" or not shutil.which("apt-get"):
        raise RuntimeError(f"{problem}; they come from Debian's packages for x86-64, and this is no such system")
    if os.geteuid() != 0:
        raise RuntimeError(problem)
    packages = sorted({tool.package for tool in TOOLS if tool.find() is None})
    _run("apt-get", "update", "-qq")
    # half a gigabyte is unpacked: a sync after each of its 4,000 files is not worth waiting for
    fast = ("-o", "Dpkg::Options::=--force-unsafe-io")
    _run("apt-get", "install", "-y", "-qq", "--no-install-recommends", *fast, *packages)
    problem = advice(TOOLS)
    if problem:
        raise RuntimeError(f"after the installation of {', '.join(packages)}: {problem}")


def _run(*command: str) -> None:
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    if done.returncode:
        raise RuntimeError(f"`{' '.join(command)}` ended with code {done.returncode}: {done.stderr.strip()}")


if __name__ == "__main__":
    try:
        fetch()
    except RuntimeError as error:
        sys.exit(f"platform_fetch: {error}")
    for tool in TOOLS:
        print(f"{tool.name}: {tool.find()}")
