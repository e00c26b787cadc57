"""The runtime compiles without a warning in clang and gcc, and clang-tidy finds nothing."""

import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
import safety_build
import safety_fetch

MORE = ["-Wshadow", "-Wstrict-prototypes", "-Wmissing-declarations", "-Wcast-qual"]
STRICT = ["-std=c99", *safety_build.WARNINGS, *MORE]


@pytest.mark.parametrize("name", ["clang", "gcc"])
@pytest.mark.parametrize("level", ["-O0", "-O2"])
def test_no_warning(name, level, request, tmp_path):
    """At -O2 as well: some warnings need what the optimiser finds out."""
    safety_build.objects(request.getfixturevalue(name), tmp_path, [*STRICT, level, "-fPIC"])


@pytest.mark.parametrize("name", ["clang", "gcc"])
def test_a_warning_is_an_error(name, request, tmp_path):
    """The check itself: a conversion that loses digits does not pass."""
    source = tmp_path / "narrow.c"
    source.write_text("int narrow(double x);\nint narrow(double x) { return x; }\n")
    with pytest.raises(RuntimeError, match="conversion"):
        safety_build.objects(request.getfixturevalue(name), tmp_path, STRICT, [source])


@pytest.fixture(scope="module")
def tidy():
    """clang-tidy on some sources, two at a time: what it says about each."""
    program = shutil.which("clang-tidy", path=os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]]))
    if program is None:
        problem = "no clang-tidy here: run `pip install clang-tidy`"
        (pytest.fail if os.environ.get(safety_fetch.REQUIRED) else pytest.skip)(problem)
    settings = f"--config-file={safety_build.ROOT / '.clang-tidy'}"

    def check(source):
        command = [program, settings, "--quiet", str(source), "--", "-std=c99", *safety_build.include()]
        done = subprocess.run(command, cwd=safety_build.ROOT, capture_output=True, text=True, check=False)
        return done.stdout if done.returncode or "warning:" in done.stdout or "error:" in done.stdout else ""

    def run(sources):
        with ThreadPoolExecutor(max_workers=2) as pool:
            return [said for said in pool.map(check, sources) if said]

    return run


@pytest.mark.slow
def test_clang_tidy(tidy):
    found = tidy(safety_build.SOURCES)
    assert not found, "\n".join(found)


def test_clang_tidy_notices(tidy, tmp_path):
    """The check itself: a comparison that is always true does not pass."""
    spoilt = tmp_path / "spoilt.c"
    spoilt.write_text("int always(const char *s);\nint always(const char *s) { return s == s; }\n")
    (said,) = tidy([spoilt])
    assert "misc-redundant-expression" in said
