"""Compiling the runtime with sanitizers."""

import importlib.util
import subprocess
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SOURCES = tuple(sorted((ROOT / "fmu_src").glob("*.c")))
WARNINGS = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror")
# A division by zero is how the runtime gets an infinity, which it checks for.
SANITIZERS = "address,undefined,float-cast-overflow"
SANITIZE = (f"-fsanitize={SANITIZERS}", "-fno-sanitize=float-divide-by-zero", "-fno-sanitize-recover=all", "-g", "-O2")


def headers() -> Path:
    """The folder of the FMI headers, which come with fmpy."""
    spec = importlib.util.find_spec("fmpy")
    assert spec is not None
    assert spec.submodule_search_locations
    return Path(spec.submodule_search_locations[0]) / "c-code"


def include() -> tuple[str, ...]:
    """Compiler arguments for our headers and FMI's."""
    return ("-I", str(ROOT / "fmu_src"), "-isystem", str(headers()))


def compiled(command: Sequence[str | Path]) -> None:
    """Run a compiler; RuntimeError with what it says where it fails."""
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")


def objects(compiler: Path, folder: Path, flags: Sequence[str], sources: Iterable[Path] = SOURCES) -> list[Path]:
    """Compile the sources, two at a time; return their objects."""
    folder.mkdir(parents=True, exist_ok=True)

    def one(source: Path) -> Path:
        to = folder / f"{source.stem}.o"
        compiled([compiler, "-std=gnu11", *flags, *include(), "-c", source, "-o", to])
        return to

    with ThreadPoolExecutor(max_workers=2) as pool:
        return list(pool.map(one, sources))
