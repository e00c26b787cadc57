"""Find CalculiX (`ccx`), an independent finite element code, or get it from Debian's packages.

    python3 tests/calculix/ccx_fetch.py

looks on PATH and in build/calculix; else installs the package where it may (as root), else unpacks it and its libraries
into build/calculix. Needs nothing but Python. Prints the path; exit code 1 and one sentence where it cannot be had.
"""

import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

PACKAGE = "calculix-ccx"
CACHE = Path(__file__).resolve().parents[2] / "build" / "calculix"
REQUIRED = "GEARPATH_REQUIRE_CCX"  # set in CI: no CalculiX is a failure there
ADVICE = f"no CalculiX (ccx) here: run `python3 tests/calculix/ccx_fetch.py`, or put ccx on PATH (Debian: {PACKAGE})"


@dataclass(frozen=True)
class Calculix:
    """The program and the folders of libraries it needs beside those of the system."""

    program: Path
    libraries: tuple[Path, ...] = ()

    def environment(self) -> dict[str, str]:
        """Variables to run it with: its libraries, and one thread."""
        paths = [*map(str, self.libraries), *filter(None, [os.environ.get("LD_LIBRARY_PATH")])]
        found = {"LD_LIBRARY_PATH": os.pathsep.join(paths)} if paths else {}
        return {**os.environ, "OMP_NUM_THREADS": "1", **found}


def find() -> Calculix | None:
    """CalculiX on PATH or in the cache, if it starts."""
    on_path, root = shutil.which("ccx"), CACHE / "root"
    # without dpkg's links, BLAS and LAPACK lie in folders of their own
    folders = tuple(sorted({path.parent for path in root.rglob("*.so.*")}))
    candidates = [Calculix(Path(on_path))] if on_path else []
    candidates.append(Calculix(root / "usr" / "bin" / "ccx", folders))
    return next((candidate for candidate in candidates if _starts(candidate)), None)


def fetch() -> Calculix:
    """What `find` finds, got first where there is nothing; raises RuntimeError where it cannot be had."""
    there = find()
    if there:
        return there
    if not (shutil.which("apt-get") and shutil.which("dpkg")):
        raise RuntimeError(f"{PACKAGE} comes from Debian's packages and there is no apt-get here; put ccx on PATH")
    problems = []
    for get in (_install, _unpack) if os.geteuid() == 0 else (_unpack,):
        try:
            get()
        except subprocess.CalledProcessError as error:
            problems.append(f"`{' '.join(error.cmd)}` ended with code {error.returncode}: {error.stderr.strip()}")
            continue
        there = find()
        if there:
            return there
        problems.append(f"after {get.__name__.strip('_')} ccx does not start")
    raise RuntimeError(f"{PACKAGE} cannot be had: {'; '.join(problems)}")


def _starts(calculix: Calculix) -> bool:
    try:
        done = subprocess.run(
            [calculix.program, "-v"], env=calculix.environment(), capture_output=True, text=True, check=False
        )
    except OSError:
        return False
    return "Version" in done.stdout  # the exit code of -v differs between versions


def _install() -> None:
    _run("apt-get", "update", "-qq")
    _run("apt-get", "install", "-y", "-qq", "--no-install-recommends", PACKAGE)


def _unpack() -> None:
    """Download the packages that are missing, with apt's own lists and cache, and unpack them; no root needed."""
    shutil.rmtree(CACHE, ignore_errors=True)
    for folder in ("lists/partial", "apt/archives/partial", "root"):
        (CACHE / folder).mkdir(parents=True)
    settings = {
        "Dir::State::lists": CACHE / "lists",
        "Dir::Cache": CACHE / "apt",
        "Debug::NoLocking": 1,
        "APT::Sandbox::User": "root",  # as root, do not download as apt's own user, who may not write here
    }
    own = [text for key, value in settings.items() for text in ("-o", f"{key}={value}")]
    _run("apt-get", *own, "update", "-qq")
    _run("apt-get", *own, "install", "-y", "-qq", "--download-only", "--no-install-recommends", PACKAGE)
    for package in sorted((CACHE / "apt" / "archives").glob("*.deb")):
        _run("dpkg", "-x", str(package), str(CACHE / "root"))
    for folder in ("lists", "apt"):
        shutil.rmtree(CACHE / folder)


def _run(*command: str) -> None:
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    subprocess.run(command, check=True, capture_output=True, text=True, env=environment)


if __name__ == "__main__":
    try:
        print(fetch().program)
    except RuntimeError as error:
        sys.exit(f"ccx_fetch: {error}")
