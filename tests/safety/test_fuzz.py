"""A short run of every fuzzer finds nothing, and finds defects that are planted.

`python tests/safety/safety_fuzz.py FOLDER --runs 1000000` runs them for longer.
"""

import shutil

import pytest
import safety_build
import safety_fetch
import safety_fuzz

SECONDS = 8  # of each fuzzer
# Edges that the corpora alone reach, about: fewer would mean that the fuzzer does not get anywhere.
REACHED = {"model": 900, "state": 600, "fmi2": 1100, "fmi3": 1200, "path": 100}
# Where a check is left out: file, what stands there, what is put there.
DEFECTS = {
    "model": ("gp_model_check", "case GP_INPUT: return v->a < m->loads && alone;", "case GP_INPUT: return alone;"),
    "state": ("gp_state", "if (stated != size || size != gp_state_size(p)) return", "if (stated != size) return"),
    "fmi2": ("gp_session_exchange", "if (count != s->core->model.states) return", "if (count > 99) return"),
    "fmi3": ("gp_variables", "if (wanted == values) return 0;", "if (wanted >= values) return 0;"),
    "path": ("gp_path", "malloc(strlen(s) + 3)", "malloc(strlen(s) + 1)"),
}

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("fuzz")]


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    folder = tmp_path_factory.mktemp("fuzz")
    safety_fuzz.build(folder)
    return folder


@pytest.mark.parametrize("target", safety_fuzz.TARGETS)
def test_nothing_is_found(built, target):
    outcome = safety_fuzz.run(built, target, seconds=SECONDS)
    assert not outcome.report, outcome.report
    assert outcome.executions > 500
    assert outcome.coverage > REACHED[target]


@pytest.mark.parametrize("target", safety_fuzz.TARGETS)
def test_a_planted_defect_is_found(built, target, tmp_path):
    stem, right, wrong = DEFECTS[target]
    for folder in ("objects", "harness", "corpus"):
        shutil.copytree(built / folder, tmp_path / folder)
    source = tmp_path / f"{stem}.c"
    text = (safety_build.ROOT / "fmu_src" / source.name).read_text()
    assert text.count(right) == 1
    source.write_text(text.replace(right, wrong))
    safety_fuzz.compile_runtime(safety_fetch.clang(), tmp_path / "objects", [source])
    harness = tmp_path / "harness" / f"fuzz_{target}.o"
    if target == "path":  # it includes the file, to follow the rules of Windows
        shutil.copy(safety_build.HERE / "fuzz" / "fuzz_path.c", tmp_path)
        shutil.copy(safety_build.HERE / "fuzz" / "fuzz.h", tmp_path)
        safety_fuzz.compile_harness(safety_fetch.clang(), tmp_path / "harness", [tmp_path / "fuzz_path.c"])
    safety_fuzz.link(safety_fetch.clang(), tmp_path, target, harness)
    outcome = safety_fuzz.run(tmp_path, target, seconds=60)
    assert outcome.report, f"not found in {outcome.executions} executions"
