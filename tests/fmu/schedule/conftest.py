"""The scheduled machine as FMUs of both versions."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from fmu_driver import Fmu
from fmu_helpers import export, stale
from schedule_machine import machine


@pytest.fixture(scope="session")
def scheduled():
    return machine()


@pytest.fixture(scope="session")
def schedule_paths(scheduled, tmp_path_factory):
    if stale():
        pytest.fail(stale(), pytrace=False)
    folder = tmp_path_factory.mktemp("schedule")
    return {v: export(scheduled, folder / f"it{v}.fmu", fmi=f"{v}.0", documentation=False) for v in (2, 3)}


@pytest.fixture(scope="session")
def fmus(schedule_paths, tmp_path_factory):
    return {v: Fmu.unpack(path, tmp_path_factory.mktemp(f"schedule{v}")) for v, path in schedule_paths.items()}
