"""Compilers, and the small networks as FMUs."""

import os
import sys
from pathlib import Path

import pytest

pytest.importorskip("fmpy")

sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parents[1] / "fmu"))

import safety_fetch
from fmu_helpers import stale
from safety_fmus import export_all


@pytest.fixture(scope="session", autouse=True)
def _compilers():
    """Without clang or gcc these tests skip, and fail where they are required."""
    problem = safety_fetch.missing()
    if problem:
        (pytest.fail if os.environ.get(safety_fetch.REQUIRED) else pytest.skip)(problem)


@pytest.fixture(scope="session")
def clang():
    return safety_fetch.clang()


@pytest.fixture(scope="session")
def gcc():
    return safety_fetch.gcc()


@pytest.fixture(scope="session")
def small_fmus(tmp_path_factory):
    if stale():
        pytest.fail(stale(), pytrace=False)
    return export_all(tmp_path_factory.mktemp("small"))
