"""libcosimpy: the FMI Library behind libcosim, FMI 2 co-simulation only.

libcosim keeps time in nanoseconds as integers, sets the overridden inputs at the beginning of a step, holds them, and
reads all outputs at its end.
"""

from client_models import bearing_entries, other_bearing
from client_packages import installed
from client_process import drive
from client_reference import Steps, check, held

installed("libcosimpy")

STEPS = Steps.random(2e-5, 250)
LIMIT = 1e-10  # the deviation found is 3e-12


def test_co_simulation(gearbox, exported, tmp_path):
    check(drive("drive_libcosimpy.py", exported["2.0"], STEPS, tmp_path), held(gearbox, STEPS), LIMIT)


def test_another_bearing_before_the_run(gearbox, exported, tmp_path):
    found = drive("drive_libcosimpy.py", exported["2.0"], STEPS, tmp_path, parameters=bearing_entries())
    check(found, held(other_bearing(gearbox), STEPS), LIMIT)
