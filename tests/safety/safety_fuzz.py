"""Run the fuzzers of the C runtime.

    python tests/safety/safety_fuzz.py FOLDER --runs 1000000 [--target fmi3]

builds them in FOLDER and prints executions, seconds and coverage of each; inputs that break something stay in FOLDER.
The tests run the same for a short while.
"""

import argparse
import os
import re
import subprocess
import sys
import time
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import safety_build
import safety_corpus
from safety_fetch import clang, missing

TARGETS = ("model", "state", "fmi2", "fmi3", "path")
# Where comparisons tell the fuzzer what to try next; elsewhere only edges are counted, which is several times faster.
COMPARING = ("gp_model", "gp_model_check", "gp_path")
COUNT_EDGES = "-fsanitize-coverage=inline-8bit-counters,pc-table"
FLAGS = (*safety_build.SANITIZE, "-fno-omit-frame-pointer")
LONGEST = {"model": 8192, "state": 4096, "fmi2": 384, "fmi3": 384, "path": 256}  # bytes of an input


@dataclass(frozen=True)
class Outcome:
    """What a run of a fuzzer ended with."""

    target: str
    executions: int
    seconds: float
    coverage: int  # edges reached
    report: str  # of what was found; empty where nothing was


def build(folder: Path) -> None:
    """Compile the fuzzers and write their corpora to `folder`."""
    compiler = clang()
    if compiler is None:
        raise RuntimeError(missing())
    compile_runtime(compiler, folder / "objects", safety_build.SOURCES)
    harness = [safety_build.HERE / "fuzz" / f"fuzz_{target}.c" for target in TARGETS]
    for target, part in zip(TARGETS, compile_harness(compiler, folder / "harness", harness)):
        link(compiler, folder, target, part)
    safety_corpus.write(folder / "corpus")


def compile_runtime(compiler: Path, folder: Path, sources: Iterable[Path]) -> None:
    """Compile sources of the runtime for the fuzzers."""
    comparing = {source for source in sources if source.stem in COMPARING}
    for feedback, part in (("-fsanitize=fuzzer-no-link", comparing), (COUNT_EDGES, set(sources) - comparing)):
        safety_build.objects(compiler, folder, [feedback, *FLAGS], sorted(part))


def compile_harness(compiler: Path, folder: Path, sources: Iterable[Path]) -> list[Path]:
    """Compile harnesses, in which a warning is an error; return their objects."""
    return safety_build.objects(compiler, folder, ["-Wall", "-Wextra", "-Werror", COUNT_EDGES, *FLAGS], sources)


def link(compiler: Path, folder: Path, target: str, harness: Path) -> None:
    """Link one fuzzer with the objects in `folder`."""
    objects = sorted((folder / "objects").glob("*.o"))
    program = folder / f"fuzz_{target}"
    safety_build.compiled([compiler, "-fsanitize=fuzzer", *FLAGS, harness, *objects, "-lm", "-o", program])


def run(folder: Path, target: str, *, runs: int = -1, seconds: int = 0, seed: int = 1) -> Outcome:
    """Run one fuzzer for so many executions or seconds, whichever ends first."""
    corpus, new = folder / "corpus" / target, folder / "found" / target
    new.mkdir(parents=True, exist_ok=True)
    models = folder / "corpus" / ("models3" if target == "fmi3" else "models2")
    command = [
        str(folder / f"fuzz_{target}"),
        *(f"-runs={runs}", f"-max_total_time={seconds}", f"-seed={seed}", f"-max_len={LONGEST[target]}"),
        *("-timeout=20", "-rss_limit_mb=2048", "-print_final_stats=1", "-verbosity=1"),
        *("-use_value_profile=0", f"-artifact_prefix={folder}/crash_{target}_"),
        *(str(new), str(corpus)),
    ]
    options = {
        "ASAN_OPTIONS": "detect_leaks=1:malloc_context_size=4:quarantine_size_mb=8",
        "UBSAN_OPTIONS": "print_stacktrace=1",
    }
    begun = time.monotonic()
    done = subprocess.run(
        command,
        env={**os.environ, **options, "GEARPATH_FUZZ_MODELS": str(models)},
        capture_output=True,
        text=True,
        errors="replace",
        check=False,
    )
    executed = re.search(r"stat::number_of_executed_units: (\d+)", done.stderr)
    reached = re.findall(r" cov: (\d+)", done.stderr)
    return Outcome(
        target,
        int(executed[1]) if executed else 0,
        time.monotonic() - begun,
        int(reached[-1]) if reached else 0,
        done.stderr[-6000:] if done.returncode else "",
    )


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--runs", type=int, default=100_000)
    parser.add_argument("--seconds", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--target", choices=TARGETS, action="append")
    chosen = parser.parse_args()
    if not (chosen.folder / f"fuzz_{TARGETS[-1]}").exists():
        build(chosen.folder)
    failed = False
    for target in chosen.target or TARGETS:
        outcome = run(chosen.folder, target, runs=chosen.runs, seconds=chosen.seconds, seed=chosen.seed)
        rate = outcome.executions / outcome.seconds
        print(f"{target}: {outcome.executions} executions, {rate:.0f}/s, {outcome.coverage} edges", flush=True)
        print(outcome.report, end="", flush=True)
        failed = failed or bool(outcome.report)
    sys.exit(failed)


if __name__ == "__main__":
    main()
