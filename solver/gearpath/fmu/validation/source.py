"""The gear mesh source: time histories against python-control, order outputs against the power flow.

For python-control every tone is an undamped oscillator beside the states, started with its phase.
"""

from dataclasses import replace

import numpy as np

from ...errors import MissingExtraError
from ...network.modal import ModalNetwork
from ...network.power import power_flow
from ...network.records import MeshSource
from ...numerics.arrays import Real
from ...statespace import state_space
from ..checks import Check
from ..reference_experiment import oscillators
from ..simulation import RunningFmu
from .measure import Drive, largest_deviation, relative, spring_force
from .spectrum import expected_ratios

STEPS = 1000
_AMPLITUDE, _SPEED = 1e-6, 1000.0  # m and rev/min, for tones that are off and a shaft at rest
_RESOLVED = 40  # steps in a cycle of the highest tone


def silenced(network: ModalNetwork, kind: str) -> dict[str, float]:
    """Values that switch off the source of an FMU, so that the excitation is its inputs alone."""
    if network.source is None or kind != "native":
        return {}
    return {f"{tone.name}.amplitude": 0.0 for tone in network.source.tones}


def checks(fmu: RunningFmu, network: ModalNetwork, source: MeshSource, limit: float, order_limit: float) -> list[Check]:
    """Both checks, of an instance that has not been started; tones that are off are switched on."""
    tones = tuple(replace(tone, amplitude=tone.amplitude or _AMPLITUDE) for tone in source.tones)
    source = replace(source, tones=tones, speed=source.speed or _SPEED)
    prefix = source.load.rsplit(".", 1)[0]
    fmu.start({f"{tone.name}.amplitude": tone.amplitude for tone in tones} | {f"{prefix}.speed": source.speed})
    orders = _order_deviation(fmu, network, source)
    rate = float(abs(_rates(source)).max())
    step = min(1e-5, 2 * np.pi / _RESOLVED / rate) if rate else 1e-5
    names = [o.name for o in network.outputs]
    found = dict(zip(names, fmu.run({source.load: np.zeros(STEPS + 1)}, step, names).T))
    load = next(item for item in network.loads if item.name == source.load)
    size = sum(tone.amplitude for tone in tones)
    drive = Drive(size * load.equivalent_mass * rate**2, rate or 1.0, 2e-2 * size * spring_force(network, load))
    deviation = largest_deviation(network.outputs, found, expected(network, source, step), drive)
    what = f"{len(names)} outputs over {STEPS} steps of {1e6 * step:.3g} us at {source.speed:g} rev/min"
    each = f"frequency, alpha and power of {len(tones)} tones"
    return [
        Check("gear mesh source against python-control", deviation, limit, f"{what}, relative to their largest value"),
        Check("order outputs against the power flow", orders, order_limit, each),
    ]


def _rates(source: MeshSource) -> Real:
    """Angular frequencies of the tones, rad/s."""
    return np.array([(t.harmonic * source.teeth + t.shift) * source.speed * 2 * np.pi / 60 for t in source.tones])


def expected(network: ModalNetwork, source: MeshSource, step: float) -> dict[str, Real]:
    """All time-domain outputs by python-control, from rest, with no other input than the source."""
    try:
        import control
    except ImportError as error:
        raise MissingExtraError("python-control", "control") from error
    plant = state_space(network)
    turn, read, begin = oscillators(source)
    load = [item.name for item in network.loads].index(source.load)
    n, k = plant.nstates, len(turn)
    A = np.block([[plant.A, np.outer(plant.B[:, load], read)], [np.zeros((k, n)), turn]])
    C = np.hstack([plant.C, np.outer(plant.D[:, load], read)])
    start = np.concatenate([np.zeros(n), begin])
    both = control.StateSpace(A, np.zeros((n + k, 1)), C, np.zeros((len(C), 1)), remove_useless_states=False)
    sampled = control.sample_system(both, step, method="zoh")
    response = control.forced_response(sampled, step * np.arange(STEPS + 1), np.zeros((1, STEPS + 1)), start)
    linear = [o.name for o in network.outputs if o.quantity != "power"]
    found = dict(zip(linear, np.asarray(response.outputs).reshape(len(linear), -1)))
    for output in network.outputs:
        if output.quantity == "power":
            joint = next(j for j in network.joints if j.name == output.joint)
            products = [found[f"{joint.name}.force_{d}"] * found[f"{joint.name}.velocity_{d}"] for d in joint.dofs]
            found[output.name] = np.sum(products, axis=0)
    return found


def _order_deviation(fmu: RunningFmu, network: ModalNetwork, source: MeshSource) -> float:
    """Largest deviation of any order output, the ratios relative to what flows."""
    rate = abs(_rates(source))
    turning = rate > 0
    parts = [fmu.get([f"{tone.name}.{part}" for tone in source.tones]) for part in ("frequency", "alpha", "power")]
    frequency, alpha, power = (values[turning] for values in parts)
    standing = max((abs(values[~turning]).max(initial=0.0) for values in parts), default=0.0)
    if standing > 0 or not turning.any():
        return float(np.inf) if standing > 0 else 0.0
    driven, omega = replace(network, excitation=source.load), rate[turning]
    flow = power_flow(driven, omega)
    ratios, size = expected_ratios(driven, flow, omega)
    input_power = flow.input_power * np.array([t.amplitude for t in source.tones])[turning] ** 2
    return float(
        np.max(
            [
                relative(abs(frequency - omega / (2 * np.pi)), omega / (2 * np.pi)),
                relative(abs(alpha - ratios[:, 0]), size),
                relative(abs(power - ratios[:, 0] * input_power), size * input_power),
            ]
        )
    )
