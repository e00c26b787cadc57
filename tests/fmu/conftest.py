"""A hand-made network of realistic magnitudes, its FMU, and a way to drive it call by call."""

import os
import sys
from pathlib import Path

import pytest

pytest.importorskip("fmpy")

sys.path.insert(0, str(Path(__file__).parent))

from fmi3_driver import Fmu3
from fmu_driver import Fmu
from fmu_exchange import Exchange
from fmu_helpers import export, stale
from fmu_networks import gearbox

from gearpath.fmu import runtime_files


@pytest.fixture(scope="session", autouse=True)
def _other_runtime():
    """With GEARPATH_RUNTIME_LIBRARY, FMUs exported here carry that library for x86-64 Linux (tests/safety sets it)."""
    library, original = os.environ.get("GEARPATH_RUNTIME_LIBRARY"), runtime_files.binaries

    def binaries(fmi="2.0", runtime=None):
        folder = "x86_64-linux" if fmi == "3.0" else "linux64"
        return {**original(fmi, runtime), (folder, ".so"): Path(library).read_bytes()}

    with pytest.MonkeyPatch.context() as patch:
        if library:
            patch.setattr(runtime_files, "binaries", binaries)
        yield


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


@pytest.fixture(scope="session")
def fmu3_path(network, tmp_path_factory):
    if stale():
        pytest.fail(stale(), pytrace=False)
    return export(network, tmp_path_factory.mktemp("fmu3") / "gearbox.fmu", fmi="3.0")


@pytest.fixture(scope="session")
def unpacked3(fmu3_path, tmp_path_factory):
    return Fmu.unpack(fmu3_path, tmp_path_factory.mktemp("unpacked3"))


@pytest.fixture
def exchange(unpacked):
    """An FMI 2 instance for model exchange, in event mode at 0 s."""
    instance = Fmu(unpacked, kind=0)
    instance.start()
    yield instance
    instance.free()


@pytest.fixture
def fmu3(unpacked3):
    """An FMI 3 instance, ready for steps from 0 s."""
    instance = Fmu3(unpacked3)
    instance.start()
    yield instance
    instance.free()


@pytest.fixture
def exchange3(unpacked3):
    """An FMI 3 instance for model exchange, in continuous-time mode at 0 s."""
    instance = Fmu3(unpacked3, exchange=True)
    instance.start()
    yield instance
    instance.free()


@pytest.fixture(params=[2, 3])
def me(request, unpacked, unpacked3):
    """Model exchange in either version, in continuous-time mode at 0 s."""
    version = request.param
    fmu = Fmu(unpacked, kind=0) if version == 2 else Fmu3(unpacked3, exchange=True)
    fmu.start()
    it = Exchange(fmu, version)
    if version == 2:
        assert not it.update()
        it.ok("EnterContinuousTimeMode")
    yield it
    fmu.free()
