"""Find clang with its sanitizers and libFuzzer, and gcc, or get them from Debian's packages.

    python3 tests/safety/safety_fetch.py

Needs nothing but Python, and root where a package is missing. Prints the compilers; exit code 1 and one sentence where
they cannot be had.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path

REQUIRED = "GEARPATH_REQUIRE_SAFETY"  # set in CI: a compiler that is missing is a failure there
PACKAGES = ("clang", "gcc", "libc6-dev")
VERSIONS = ("clang", *(f"clang-{number}" for number in range(21, 12, -1)))
ADVICE = "no {} here: run `python3 tests/safety/safety_fetch.py` as root (Debian: clang, libclang-rt-dev, gcc)"


@cache
def clang() -> Path | None:
    """A clang that links the address sanitizer and libFuzzer."""
    return next((path for path in map(shutil.which, VERSIONS) if path and _links_fuzzers(path)), None)  # type: ignore[return-value]


def gcc() -> Path | None:
    """gcc, not another compiler under its name."""
    path = shutil.which("gcc")
    return Path(path) if path and "Free Software" in _output(path, "--version") else None


def missing() -> str:
    """What is missing and how to get it, in one sentence; empty where nothing is."""
    names = {"clang with sanitizers and libFuzzer": clang(), "gcc": gcc()}
    absent = " and no ".join(name for name, path in names.items() if path is None)
    return ADVICE.format(absent) if absent else ""


def fetch() -> None:
    """Install what is missing; raises RuntimeError where that cannot be done."""
    if not missing():
        return
    if not shutil.which("apt-get"):
        raise RuntimeError(f"{missing()}; there is no apt-get here, so put them on PATH by hand")
    if os.geteuid() != 0:
        raise RuntimeError(missing())
    _apt("update", "-qq")
    _apt("install", "-y", "-qq", "--no-install-recommends", *PACKAGES)
    # the sanitizers' libraries stand in a package with the compiler's own version in its name
    major = _output("clang", "-dumpversion").split(".")[0]
    _apt("install", "-y", "-qq", "--no-install-recommends", f"libclang-rt-{major}-dev")
    clang.cache_clear()
    if missing():
        raise RuntimeError(f"after the installation of {', '.join(PACKAGES)}: {missing()}")


def _links_fuzzers(path: str) -> bool:
    program = "#include <stddef.h>\nint LLVMFuzzerTestOneInput(const char *d, size_t n) { return !d && n; }\n"
    with tempfile.TemporaryDirectory() as folder:
        command = [path, "-x", "c", "-", "-fsanitize=fuzzer,address,undefined", "-o", f"{folder}/probe"]
        done = subprocess.run(command, input=program, capture_output=True, text=True, check=False)
    return done.returncode == 0


def _output(*command: str) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout


def _apt(*arguments: str) -> None:
    command = ["apt-get", "-o", "DPkg::Lock::Timeout=300", *arguments]
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    if done.returncode:
        raise RuntimeError(f"`{' '.join(command)}` ended with code {done.returncode}: {done.stderr.strip()}")


if __name__ == "__main__":
    try:
        fetch()
    except RuntimeError as error:
        sys.exit(f"safety_fetch: {error}")
    print(clang(), gcc(), sep="\n")
