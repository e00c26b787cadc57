"""Swept sine through the FMU against python-control's forced response of the exactly discretised time twin."""

from collections.abc import Callable

import numpy as np

from ...errors import MissingExtraError
from ...network.modal import ModalNetwork
from ...numerics.arrays import Real
from ...statespace import state_space
from ..checks import Check
from ..simulation import RunningFmu

STEP, STEPS = 1e-5, 10_000


def chirps(network: ModalNetwork, start: float, stop: float, steps: int = STEPS) -> dict[str, Real]:
    """A logarithmic sweep for every input, each at its own pace; transmission errors in um, forces in N."""
    t, duration = STEP * np.arange(steps + 1), STEP * steps
    upper = min(stop, 0.4 / STEP)
    signals = {}
    for k, load in enumerate(network.loads):
        rate = np.log(upper / start) / duration * (1.0 + 0.1 * k)
        signal = np.sin(2 * np.pi * start * np.expm1(rate * t) / rate)
        signals[load.name] = (1e-6 if load.is_transmission_error else 1.0) * signal
    return signals


def forced_response(network: ModalNetwork, inputs: dict[str, Real]) -> dict[str, Real]:
    """All time-domain outputs by python-control: zero-order hold, exact discretisation, then joint powers."""
    try:
        import control
    except ImportError as error:
        raise MissingExtraError("python-control", "control") from error
    system = control.sample_system(state_space(network), STEP, method="zoh")
    u = np.array([inputs[load.name] for load in network.loads])
    response = control.forced_response(system, STEP * np.arange(u.shape[1]), u)
    names = [o.name for o in network.outputs if o.quantity != "power"]
    found = dict(zip(names, np.atleast_2d(response.outputs)))
    for output in network.outputs:
        if output.quantity == "power":
            joint = next(j for j in network.joints if j.name == output.joint)
            found[output.name] = sum(
                found[f"{joint.name}.force_{dof}"] * found[f"{joint.name}.velocity_{dof}"] for dof in joint.dofs
            )
    return {o.name: found[o.name] for o in network.outputs}


def largest_deviation(found: dict[str, Real], expected: dict[str, Real]) -> float:
    """Largest deviation of any output relative to the largest value of that output."""
    worst = 0.0
    for name, values in expected.items():
        size = float(abs(values).max())
        deviation = float(abs(found[name] - values).max())
        worst = max(worst, deviation / size if size else deviation)
    return worst


def run_chirps(
    fmu: RunningFmu, network: ModalNetwork, inputs: dict[str, Real], progress: Callable[[int], None]
) -> dict[str, Real]:
    """Simulate the FMU with held inputs; histories of all time-domain outputs."""
    names = [o.name for o in network.outputs]
    return dict(zip(names, fmu.run(inputs, STEP, names, progress=progress).T))


def chirp_check(found: dict[str, Real], expected: dict[str, Real], limit: float) -> Check:
    """The check of one FMU's histories."""
    what = f"{len(expected)} outputs over {STEPS} steps of 10 us, relative to each output's largest value"
    return Check("swept sine against python-control", largest_deviation(found, expected), limit, what)
