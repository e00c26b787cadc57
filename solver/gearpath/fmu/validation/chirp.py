"""Swept sine through the FMU against python-control's forced response of the exactly discretised time twin.

Halfway, every joint and every modal damping is exchanged in the running FMU, and the expected response goes on with
the other system.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...errors import MissingExtraError
from ...network.modal import ModalNetwork
from ...numerics.arrays import Real
from ...statespace import state_space
from ..checks import Check
from ..simulation import RunningFmu
from .exchange import parameters
from .measure import Drive, largest_deviation, spring_force

STEPS = 10_000


@dataclass(frozen=True)
class Sweep:
    """Input samples u_0 ... u_n of every load, and the step between them (s)."""

    inputs: dict[str, Real]
    step: float
    drive: Drive

    def part(self, start: int, stop: int) -> "Sweep":
        """The samples from `start` to `stop` inclusive."""
        cut = {name: signal[start : stop + 1] for name, signal in self.inputs.items()}
        return Sweep(cut, self.step, self.drive)


def sweep(network: ModalNetwork, start: float, stop: float) -> Sweep:
    """A logarithmic sweep up and down the band (Hz) for every load, each at its own pace; errors in um, forces in N."""
    step = min(1e-5, 0.2 / stop)
    t, signals, forces, rounding = step * np.arange(STEPS // 2 + 1), {}, [], 0.0
    for k, load in enumerate(network.loads):
        rate = np.log(stop / start) / t[-1] * (1.0 + 0.1 * k)
        up = np.sin(2 * np.pi * start * np.expm1(rate * t) / rate)
        signal = np.concatenate([up, up[-2::-1]])
        size = 1e-6 if load.is_transmission_error else 1.0
        forces.append(size * (load.equivalent_mass * (2 * np.pi * stop) ** 2 or 1.0))
        # 5000 steps leave up to 5000 eps, 1e-12, of the forces that cancel in every one of them
        rounding = max(rounding, 2e-2 * size * spring_force(network, load))
        signals[load.name] = size * signal
    return Sweep(signals, step, Drive(max(forces), 2 * np.pi * stop, rounding))


def forced_response(network: ModalNetwork, signals: Sweep, state: Real | None = None) -> tuple[dict[str, Real], Real]:
    """All time-domain outputs by python-control (held inputs, exact discretisation), and the state at the end."""
    try:
        import control
    except ImportError as error:
        raise MissingExtraError("python-control", "control") from error
    system = control.sample_system(state_space(network), signals.step, method="zoh")
    u = np.array([signals.inputs[load.name] for load in network.loads])
    start = np.zeros(system.nstates) if state is None else state
    response = control.forced_response(system, signals.step * np.arange(u.shape[1]), u, start, return_states=True)
    names = [o.name for o in network.outputs if o.quantity != "power"]
    found = dict(zip(names, np.asarray(response.outputs).reshape(len(names), -1)))
    for output in network.outputs:
        if output.quantity == "power":
            joint = next(j for j in network.joints if j.name == output.joint)
            products = [found[f"{joint.name}.force_{d}"] * found[f"{joint.name}.velocity_{d}"] for d in joint.dofs]
            found[output.name] = np.sum(products, axis=0)
    return {o.name: found[o.name] for o in network.outputs}, np.asarray(response.states)[:, -1]


def state_after(network: ModalNetwork, changed: ModalNetwork, signals: Sweep, state: Real) -> Real:
    """The state when the network becomes another one: all motion goes on as it was.

    The state holds s = q' - X d e, so that another modal damping X means another s for the same velocity q'.
    """
    out, N = state.copy(), len(network.eigenvalues)
    for load in network.loads:
        if load.mesh_displacement is not None:
            change = (network.damping - changed.damping) * load.mesh_displacement
            out[N:] += change * signals.inputs[load.name][-1]
    return out


def run(
    fmu: RunningFmu, network: ModalNetwork, signals: Sweep, progress: Callable[[int], None] = lambda _: None
) -> dict[str, Real]:
    """Simulate the FMU with held inputs; histories of all time-domain outputs."""
    names = [o.name for o in network.outputs]
    return dict(zip(names, fmu.run(signals.inputs, signals.step, names, progress=progress).T))


def checks(
    fmu: RunningFmu,
    network: ModalNetwork,
    changed: ModalNetwork,
    signals: Sweep,
    limit: float,
    progress: Callable[[int], None],
) -> tuple[list[Check], dict[str, Real]]:
    """Both halves of the sweep, and the histories of the first."""
    half = STEPS // 2
    first, second = signals.part(0, half), signals.part(half, STEPS)
    found = run(fmu, network, first, progress)
    fmu.set(parameters(changed))
    after = run(fmu, changed, second, progress)
    fmu.set(parameters(network))
    expected, state = forced_response(network, first)
    expected_after, _ = forced_response(changed, second, state_after(network, changed, first, state))
    what = f"{len(expected)} outputs over {half} steps of {1e6 * signals.step:.3g} us, relative to their largest value"
    return [
        Check(
            "swept sine against python-control",
            largest_deviation(network.outputs, found, expected, signals.drive),
            limit,
            what,
        ),
        Check(
            "the same after all joints and dampings were exchanged",
            largest_deviation(changed.outputs, after, expected_after, signals.drive),
            10.0 * limit,  # the exchange itself starts a transient from a state that was rounded
            what,
        ),
    ], found
