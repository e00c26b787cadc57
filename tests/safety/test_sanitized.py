"""The tests of the native FMUs with a runtime that the address and undefined-behaviour sanitizers watch: no finding."""

import os
import re
import subprocess
import sys

import pytest
import safety_build

# Tests of what is in the file rather than of what the library does, or of another library.
OTHERS = ("conformance", "python_kind", "package", "build", "validation", "icon", "terminals", "documentation")
OTHERS += ("reduced", "pendulum")

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("sanitized")]


@pytest.fixture(scope="module")
def objects(gcc, tmp_path_factory):
    """The runtime's objects with the sanitizers."""
    return safety_build.objects(gcc, tmp_path_factory.mktemp("sanitized"), [*safety_build.SANITIZE, "-fPIC"])


def library(gcc, objects, folder):
    made = folder / "sanitized.so"
    safety_build.compiled([gcc, "-shared", *safety_build.SANITIZE, *objects, "-o", made])
    return made


def run_tests(gcc, made, *arguments):
    """pytest on tests/fmu with this library in every FMU, and the sanitizers' libraries in the process."""
    preload = [
        subprocess.check_output([gcc, f"-print-file-name={name}"], text=True).strip()
        for name in ("libasan.so", "libubsan.so")
    ]
    environment = {
        **{key: value for key, value in os.environ.items() if not key.startswith("PYTEST_")},
        "GEARPATH_RUNTIME_LIBRARY": str(made),
        "LD_PRELOAD": ":".join(preload),
        # Python's own leaks are not ours, and one library is loaded from several places
        "ASAN_OPTIONS": "detect_leaks=0:detect_odr_violation=0:allocator_may_return_null=1",
        "UBSAN_OPTIONS": "print_stacktrace=1",
    }
    quiet = ["-p", "no:cacheprovider", "-p", "no:xdist", "--capture=sys", "--durations=25"]
    command = [sys.executable, "-m", "pytest", *quiet, *map(str, arguments)]
    return subprocess.run(
        command, cwd=safety_build.ROOT, env=environment, capture_output=True, text=True, errors="replace", check=False
    )


def test_suite_under_sanitizers(gcc, objects, tmp_path):
    made = library(gcc, objects, tmp_path)
    chosen = [
        path
        for path in sorted((safety_build.ROOT / "tests" / "fmu").rglob("test_*.py"))
        if not any(name in str(path.relative_to(safety_build.ROOT)) for name in OTHERS)
    ]
    assert len(chosen) >= 12
    done = run_tests(gcc, made, *chosen)
    assert done.returncode == 0, (done.stdout + done.stderr)[-8000:]
    assert "skipped" not in done.stdout


def test_sanitizers_are_at_work(gcc, objects, tmp_path):
    """With a get that reads before the instance's memory, the first test that gets a value must end in a report."""
    text = (safety_build.ROOT / "fmu_src" / "gp_variables.c").read_text()
    changed = re.sub(r"(\nint gp_get\(.*?\{\n)", r"\1    if (p->memory[-1] == 1) return -1;\n", text, flags=re.DOTALL)
    assert changed != text
    spoilt = tmp_path / "gp_variables.c"
    spoilt.write_text(changed)
    (wrong,) = safety_build.objects(gcc, tmp_path, [*safety_build.SANITIZE, "-fPIC"], [spoilt])
    made = library(gcc, [wrong, *(part for part in objects if part.name != wrong.name)], tmp_path)
    done = run_tests(gcc, made, "tests/fmu/test_fmu_frequency.py", "-x")
    assert done.returncode != 0
    assert "AddressSanitizer" in done.stderr
