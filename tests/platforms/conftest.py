"""The machines, with the host compiled for each, and the default gearbox as FMUs of both versions."""

import sys
import tempfile
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

pytest.importorskip("fmpy")

sys.path.insert(0, str(Path(__file__).parents[1] / "fmu"))
sys.path.insert(0, str(Path(__file__).parent))

import platform_machines as machines
from fmu_helpers import stale
from platform_fetch import ARM, OLD, QEMU, WINE
from platform_machines import need
from platform_script import Script, UnpackedFmu

import gearpath as gp

ROOT = Path(__file__).resolve().parents[2]
Runner = Callable[[Script], str]


@pytest.fixture(scope="session")
def model():
    return gp.load(ROOT / "models" / "gearbox.toml")


@pytest.fixture(scope="session")
def fmus(model, tmp_path_factory):
    """By FMI version: the exported file and its content, unpacked."""
    if stale():
        pytest.fail(stale(), pytrace=False)
    folder = tmp_path_factory.mktemp("platforms")
    found = {}
    for fmi in ("2.0", "3.0"):
        path = gp.export_fmu(model, folder / f"gearbox{fmi[0]}.fmu", fmi=fmi)
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder / fmi)
        found[fmi] = UnpackedFmu(folder / fmi, fmi)
    return found


@pytest.fixture(params=["2.0", "3.0"])
def fmu(fmus, request):
    return fmus[request.param]


@pytest.fixture(scope="session")
def hosts(tmp_path_factory):
    """By machine: its host, compiled when first asked for."""
    folder, found = tmp_path_factory.mktemp("hosts"), {}

    def host(machine):
        if machine.name not in found:
            found[machine.name] = machine.compile_host(folder)
        return found[machine.name]

    return host


@pytest.fixture(scope="session")
def run(hosts) -> Runner:
    """Run a script on the machine that it was written for; returns what the host prints."""
    return lambda script: script.machine.run(hosts(script.machine), script.text)


@pytest.fixture(scope="session")
def linux():
    return machines.native()


@pytest.fixture(scope="session")
def old():
    need(OLD)
    return machines.old()


@pytest.fixture(scope="session")
def arm():
    need(QEMU, ARM)
    return machines.arm()


@pytest.fixture(scope="session")
def windows():
    """Wine, in a system folder of its own (700 MB) that is removed at the end."""
    need(WINE)
    with tempfile.TemporaryDirectory(prefix="gearpath-wine-", ignore_cleanup_errors=True) as prefix:
        machine = machines.windows(Path(prefix))
        machines.start_wine(machine)
        yield machine
        machines.end_wine(machine)


@pytest.fixture(params=["old", "arm", "windows"])
def other(request):
    """A machine that is not this one."""
    return request.getfixturevalue(request.param)


@pytest.fixture(params=["linux", "arm", "windows"])
def machine(request):
    return request.getfixturevalue(request.param)
