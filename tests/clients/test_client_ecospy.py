"""Ecos: co-simulation by fmi4c, FMI 2 and 3.

Ecos sets the inputs at the beginning of a step, holds them, and reads all outputs at its end. Of FMI 3 it knows scalars
only: the bearings' matrices are arrays there and are out of its reach, so other parameters are set. Before it has
opened the library of an FMI 3 FMU it asks for its version and prints 'Function "fmi3GetVersion" is not provided by this
FMU.'; that is said of every FMU, ours does export that function.
"""

from importlib.metadata import distribution

import pytest
from client_models import SCALARS, bearing_entries, other_bearing, other_scalars
from client_packages import installed
from client_process import drive
from client_reference import Steps, check, held

installed("ecospy")

STEPS = Steps.random(2e-5, 250)
LIMIT = 1e-10  # the deviation found is 3e-12


@pytest.fixture(scope="module")
def environment():
    """Where libecosc.so finds the threads library that its package does not bring along."""
    files = distribution("tbb").files or []
    folder = next(file.locate().resolve().parent for file in files if file.name.startswith("libtbb.so"))
    return {"LD_LIBRARY_PATH": str(folder)}


def test_co_simulation(gearbox, fmu, tmp_path, environment):
    found = drive("drive_ecospy.py", fmu, STEPS, tmp_path, environment=environment)
    check(found, held(gearbox, STEPS), LIMIT)


def test_another_bearing_before_the_run(gearbox, exported, tmp_path, environment):
    """FMI 2: entry by entry."""
    found = drive(
        "drive_ecospy.py", exported["2.0"], STEPS, tmp_path, parameters=bearing_entries(), environment=environment
    )
    check(found, held(other_bearing(gearbox), STEPS), LIMIT)


def test_other_scalars_before_the_run(gearbox, fmu, tmp_path, environment):
    found = drive("drive_ecospy.py", fmu, STEPS, tmp_path, parameters=SCALARS, environment=environment)
    check(found, held(other_scalars(gearbox), STEPS), LIMIT)
