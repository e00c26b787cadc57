"""Sine steady state of the running FMU against the mobility synthesis, and the energy balance of its histories.

Ten frequencies at once: the machine is linear, so the response to a sum of tones is the sum of the responses. All
tones are multiples of one base frequency and are switched on so smoothly that no resonance rings; after the ramp one
base period is recorded, over which sums of samples are exact Fourier integrals and exact mean powers.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...network.modal import ModalNetwork
from ...network.power import power_flow
from ...network.records import Load, Output
from ...network.response import frequency_response
from ...network.time_twin import time_twin
from ...numerics.arrays import Complex, Real
from ..checks import Check, Comparison
from ..simulation import RunningFmu
from .measure import Drive, largest_deviation, relative, spring_force

_TONES = 10
_IMAGES = 20  # of the sampling frequency, on either side


@dataclass(frozen=True)
class Steady:
    """Recorded base period of a run with tones."""

    frequency: Real  # (k,), Hz
    amplitude: Complex  # (k,), of the input
    outputs: tuple[str, ...]
    record: Real  # (samples, outputs), one base period
    step: float

    def phasors(self) -> Complex:
        """Fourier coefficients of every output at the tones, (k, outputs)."""
        samples = len(self.record)
        t = self.step * np.arange(samples)
        kernel = np.exp(-2j * np.pi * self.frequency[:, None] * t)
        return np.asarray(2.0 / samples * kernel @ self.record)

    def column(self, name: str) -> Real:
        """History of one output."""
        return np.asarray(self.record[:, self.outputs.index(name)])


def base_frequency(start: float, stop: float) -> float:
    """The frequency (Hz) that all tones are multiples of: its period is recorded."""
    return 10.0 if start >= 10.0 and stop - start >= 40 * 10.0 else 1.0


def tones(start: float, stop: float, poles: Complex) -> Real:
    """Ten frequencies (Hz) over the band, evenly on a logarithmic scale, none close to a damped natural frequency.

    Near a resonance that hardly decays even a smooth start rings for long.
    """
    base = base_frequency(start, stop)
    resonances = np.unique(abs(poles.imag)) / (2 * np.pi)
    chosen: list[float] = []
    for wanted in np.geomspace(max(start, base), max(stop, base * 2 * _TONES), _TONES):
        low, high = max(0.87 * wanted, min(start, wanted)), min(1.15 * wanted, max(stop, wanted))
        candidates = base * np.arange(max(np.ceil(low / base), 1), max(np.floor(high / base), np.ceil(low / base)) + 1)
        candidates = np.array([c for c in candidates if c not in chosen])
        if not candidates.size:
            candidates = np.array([max(chosen) + base])
        distance = abs(candidates[:, None] - resonances[None, :]).min(axis=1, initial=np.inf)
        score = np.minimum(distance, 40.0) - 1e-3 * abs(candidates - wanted)
        chosen.append(float(candidates[np.argmax(score)]))
    return np.sort(np.array(chosen))


def smooth_ramp(t: Real, duration: float) -> Real:
    """0 before, 1 after `duration`, infinitely differentiable: its spectrum falls faster than any power."""
    s = np.clip(t / duration, 0.0, 1.0)
    with np.errstate(divide="ignore", over="ignore"):
        rise, rest = np.exp(-1.0 / s), np.exp(-1.0 / (1.0 - s))
    return np.asarray(rise / (rise + rest))


def run_tones(
    fmu: RunningFmu,
    load: Load,
    frequency: Real,
    outputs: tuple[str, ...],
    base: float,
    step: float,
    settle: float,
    progress: Callable[[int], None],
) -> Steady:
    """Simulate the tones of equal drive F_e (N, or the load's own unit) until they are steady."""
    amplitude = np.full(len(frequency), 1.0 + 0.0j)
    if load.is_transmission_error:
        amplitude = amplitude / (load.equivalent_mass * (2 * np.pi * frequency) ** 2)
    amplitude = amplitude * np.exp(1j * np.arange(len(frequency)) ** 2)  # spread phases: no common peak
    first, samples = round(settle / step), round(1.0 / (base * step))
    t = np.asarray(step * np.arange(first + samples), float)
    u = np.zeros(len(t))
    for f, a in zip(frequency, amplitude):
        u += np.real(a * np.exp(2j * np.pi * f * (t - t[first])))
    u *= smooth_ramp(t, 0.7 * settle)
    record = fmu.run({load.name: u}, step, outputs, record_from=first, interpolate=fmu.interpolates, progress=progress)
    return Steady(frequency, amplitude, outputs, record, step)


def hold_factor(frequency: Real, step: float, interpolates: bool) -> Complex:
    """What sampling the input does to a tone: sinc^2 of a linear, sinc and half a step's delay of a held one."""
    x = np.pi * frequency * step
    if interpolates:
        return np.asarray((np.sin(x) / x) ** 2 + 0j)
    return np.asarray(np.sin(x) / x * np.exp(-1j * x))


def sampled_response(
    network: ModalNetwork, load: Load, outputs: Sequence[Output], frequency: Real, step: float, interpolates: bool
) -> Complex:
    """What a simulation that is exact for its held or linear input must find at the samples, (k, outputs).

    The input between the samples is the tone and its images at f + m/h, each weighted by `hold_factor`; every image
    passes the structure at its own frequency (the synthesis), and all meet in the samples. The sum converges fast once
    the transfers' limit at high frequency, D + C B/(i w), is taken out of it: sampled, that limit has a closed form.
    """
    twin = time_twin(network, outputs, [load])
    D, slope = twin.D[:, 0], (twin.C @ twin.B)[:, 0]
    z = np.exp(2j * np.pi * frequency * step)
    integrator = step / (z - 1.0) * ((z + 1.0) / 2.0 if interpolates else 1.0)
    total = D + integrator[:, None] * slope
    for m in range(-_IMAGES, _IMAGES + 1):
        image = frequency + m / step
        H = frequency_response(network, 2 * np.pi * abs(image), outputs, [load])[:, :, 0]
        H = np.where(image[:, None] > 0.0, H, H.conj())
        limit = D + slope / (2j * np.pi * image[:, None])
        total += hold_factor(image, step, interpolates)[:, None] * (H - limit)
    return np.asarray(total)


def steady_state_check(
    network: ModalNetwork, load: Load, steady: Steady, interpolates: bool, limit: float
) -> tuple[Check, list[Comparison]]:
    """Transfers of the simulated steady state against the synthesis, all linear outputs."""
    linear = [o for o in network.outputs if o.quantity != "power" and o.name in steady.outputs]
    columns = [steady.outputs.index(o.name) for o in linear]
    simulated = steady.phasors()[:, columns] / steady.amplitude[:, None]
    expected = sampled_response(network, load, linear, steady.frequency, steady.step, interpolates)
    exact = frequency_response(network, 2 * np.pi * steady.frequency, linear, [load])[:, :, 0]
    # every tone drives with the same force: what is compared is the response to it
    amplitude = abs(steady.amplitude)
    names = [o.name for o in linear]
    found, wanted = (dict(zip(names, (values * amplitude[:, None]).T)) for values in (simulated, expected))
    rounding = 1e-4 * spring_force(network, load) * float(amplitude.max())
    drive = Drive(1.0, 2 * np.pi * float(steady.frequency[-1]), rounding)
    deviation = largest_deviation(linear, found, wanted, drive)
    shown = simulated / hold_factor(steady.frequency, steady.step, interpolates)[:, None]
    comparisons = [
        Comparison(o.name, f"{o.unit} per {load.unit}", steady.frequency, shown[:, k], steady.frequency, exact[:, k])
        for k, o in enumerate(linear)
    ]
    what = (
        f"against the mobility synthesis: {len(linear)} outputs at {len(steady.frequency)} frequencies, "
        "relative to the largest response"
    )
    return Check(f"sine steady state, {load.name}", deviation, limit, what), comparisons


def energy_checks(network: ModalNetwork, load: Load, steady: Steady, interpolates: bool, limit: float) -> list[Check]:
    """Mean powers from the simulated histories: in at the mesh, out through the paths, against all that is lost.

    Judged by the power that is lost, or by a thousandth of the apparent power where hardly any is.
    """
    omega = 2 * np.pi * steady.frequency
    drive = steady.amplitude * hold_factor(steady.frequency, steady.step, interpolates)
    velocity = steady.phasors()[:, steady.outputs.index(load.name.removesuffix(".force") + ".velocity")]
    put_in = 0.5 * float(np.real(np.vdot(drive, velocity)))
    powers = [f"{name}.power" for name in network.paths if f"{name}.power" in steady.outputs]
    through = sum(float(np.mean(steady.column(name))) for name in powers)
    flow = power_flow(replace(network, excitation=load.name), omega)
    dissipated = float(abs(drive) ** 2 @ flow.dissipated_power.sum(axis=0))
    transmitted = float(abs(drive) ** 2 @ flow.transmitted_power)
    size = np.array(max(dissipated, 0.5e-3 * float(abs(drive) @ abs(velocity))))
    return [
        Check(
            "energy balance: input",
            relative(np.array(abs(put_in - dissipated)), size),
            limit,
            f"mean power at {load.name} in the histories ({put_in:.4g} W) against the power lost in all elements",
        ),
        Check(
            "energy balance: paths",
            relative(np.array(abs(through - transmitted)), size),
            limit,
            f"mean power through all paths in the histories ({through:.4g} W) against the synthesis, part of the input",
        ),
    ]
