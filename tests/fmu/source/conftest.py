"""A gearbox with a gear mesh source, its FMUs, and what they must give."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from fmi3_driver import Fmu3
from fmu_driver import Fmu
from fmu_helpers import stale
from source_machine import Machine, with_source

import gearpath as gp


@pytest.fixture(scope="session")
def model():
    if stale():
        pytest.fail(stale(), pytrace=False)
    return with_source()


@pytest.fixture(scope="session")
def machine(model):
    return Machine(model)


@pytest.fixture(scope="session")
def source2(model, tmp_path_factory):
    folder = tmp_path_factory.mktemp("source")
    return Fmu.unpack(gp.export_fmu(model, folder / "source.fmu"), folder / "unpacked")


@pytest.fixture(scope="session")
def source3(model, tmp_path_factory):
    folder = tmp_path_factory.mktemp("source3")
    return Fmu.unpack(gp.export_fmu(model, folder / "source.fmu", fmi="3.0"), folder / "unpacked")


@pytest.fixture
def fmu(source2):
    instance = Fmu(source2)
    yield instance
    instance.free()


@pytest.fixture
def fmu3(source3):
    instance = Fmu3(source3)
    yield instance
    instance.free()
