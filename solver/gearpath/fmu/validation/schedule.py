"""Stiffness scheduled on torque: at points and between them, and after a change in mid-run."""

from collections.abc import Callable

import numpy as np

from ...network.modal import ModalNetwork
from ...network.records import Schedule
from ...numerics.arrays import Real
from ..checks import Check
from ..dependencies import TORQUE
from ..simulation import RunningFmu
from . import chirp, spectrum
from .measure import largest_deviation

STEPS, _LINES = 1000, 5


def torques(schedule: Schedule) -> Real:
    """The first point, the middle of the widest interval, and the last point, N m."""
    points = np.asarray(schedule.torques, float)
    widest = int(np.argmax(np.diff(points)))
    return np.array([points[0], 0.5 * (points[widest] + points[widest + 1]), points[-1]])


def checks(
    fmu: RunningFmu,
    network: ModalNetwork,
    schedule: Schedule,
    band: tuple[float, float],
    limit: float,
    time_limit: float,
    progress: Callable[[int], None] = lambda _: None,
) -> list[Check]:
    """Both checks, of a started instance at rest, which ends with another torque and state.

    Over frequency against the power flow of the network with interpolated matrices; over time against python-control,
    two systems one after the other, the state carried over.
    """
    deviations = []
    for torque in torques(schedule):
        fmu.set({TORQUE: float(torque)})
        deviations.append(spectrum.deviation(fmu, network.at_torque(torque), np.geomspace(*band, _LINES)))
    first, then = (float(torque) for torque in torques(schedule)[[2, 1]])
    return [
        Check(
            "frequency-domain outputs over the torque",
            float(np.max(deviations)),
            limit,
            f"at {', '.join(f'{t:g}' for t in torques(schedule))} N m and {_LINES} frequencies each",
        ),
        _changed(fmu, network, (first, then), chirp.sweep(network, *band), time_limit, progress),
    ]


def _changed(
    fmu: RunningFmu,
    network: ModalNetwork,
    torque: tuple[float, float],
    signals: chirp.Sweep,
    limit: float,
    progress: Callable[[int], None],
) -> Check:
    """The swept sine, in whose course the torque jumps."""
    middle = chirp.STEPS // 2
    parts = [signals.part(middle - STEPS, middle), signals.part(middle, middle + STEPS)]  # where it is fastest
    state, deviations = None, []
    for value, part in zip(torque, parts):
        fmu.set({TORQUE: value})
        present = network.at_torque(value)
        found = chirp.run(fmu, present, part, progress)
        expected, state = chirp.forced_response(present, part, state)
        deviations.append(largest_deviation(network.outputs, found, expected, signals.drive))
    what = f"all outputs over {STEPS} steps at {torque[0]:g} N m and as many at {torque[1]:g} N m"
    return Check("torque changed in mid-run against python-control", float(np.max(deviations)), limit, what)
