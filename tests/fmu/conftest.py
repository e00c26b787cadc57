"""A hand-made network of realistic magnitudes, its FMU, and a way to drive it call by call."""

import sys
from pathlib import Path

import pytest

pytest.importorskip("fmpy")

sys.path.insert(0, str(Path(__file__).parent))

from fmu_driver import Fmu
from fmu_helpers import export, stale
from fmu_networks import gearbox


@pytest.fixture(scope="session")
def network():
    return gearbox()


@pytest.fixture(scope="session")
def fmu_path(network, tmp_path_factory):
    """The FMU of the network; fails where the compiled runtime is stale: tests of it would prove nothing."""
    if stale():
        pytest.fail(stale(), pytrace=False)
    return export(network, tmp_path_factory.mktemp("fmu") / "gearbox.fmu")


@pytest.fixture(scope="session")
def unpacked(fmu_path, tmp_path_factory):
    return Fmu.unpack(fmu_path, tmp_path_factory.mktemp("unpacked"))


@pytest.fixture
def fmu(unpacked):
    """An instance, ready for steps from 0 s."""
    instance = Fmu(unpacked)
    instance.start()
    yield instance
    instance.free()
