"""The tables of README.md."""

from collections.abc import Iterator, Sequence
from math import asin, degrees, isinf

import design
import numpy as np
from comparison import MASTERS, PASSIVE, STEP, STEPPED, Case, Comparison, change, controller_of, peak_sensitivity
from levels import decibels
from prediction import sampled

PRICE_BAND = np.arange(50.0, 600.5, 0.5)  # Hz


def text(found: Comparison) -> str:
    """All tables."""
    return "\n\n".join("\n".join(part(found)) for part in (settings, forces, powers, margins, price, steps, limits))


def settings(found: Comparison) -> Iterator[str]:
    """What was chosen."""
    order = found.cases[STEPPED].loop.controller.nstates
    yield f"Mesh frequency {found.machine.frequency:g} Hz, transmission error {1e6 * found.machine.error:g} um, step"
    yield f"{1e6 * STEP:g} us. Velocity feedback {design.GAIN:g} N s/m; proof masses {design.PROOF_MASS:g} kg at"
    yield f"{design.RESONANCE:g} Hz with damping ratio {design.RATIO:g}, {design.INERTIAL_GAIN:g} N s/m. LQG: weight of"
    yield f"the strut forces {design.EFFORT:g}; transmission error {1e6 * design.ERROR_RMS:g} um RMS, a filter of"
    yield f"damping ratio {design.ERROR_DAMPING:g}, noise of the struts {design.DISTURBANCE:g} N/Hz^0.5, of the sensors"
    yield f"{1e6 * design.NOISE:g} um/s/Hz^0.5; reduced model of {order - 2} states."


def price(found: Comparison) -> Iterator[str]:
    """Where a loop, with its delay, makes the force into the ground larger than passive mounts do."""
    own = found.machine

    def force(case: Case) -> np.ndarray:
        answer = sampled(own.plant, controller_of(case.loop), PRICE_BAND, STEP, own.error)
        return own.figures(answer, case.loop).ground_force

    before, rows = force(found.cases[PASSIVE]), []
    for name, case in found.cases.items():
        ratio = decibels(force(case) / before)
        worst = int(ratio.argmax())
        if case.loop:
            rows.append((name, f"{ratio[worst]:.1f}", f"{PRICE_BAND[worst]:.0f}", f"{ratio.min():.1f}"))
    yield from table(("50 to 600 Hz", "largest increase, dB", "at Hz", "largest decrease, dB"), rows)


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> Iterator[str]:
    """Lines of a Markdown table, all columns but the first to the right."""
    yield f"| {' | '.join(head)} |"
    yield "| --- |" + " ---: |" * (len(head) - 1)
    for row in rows:
        yield f"| {' | '.join(row)} |"


def forces(found: Comparison) -> Iterator[str]:
    """Change of the force into the ground, and how far co-simulations are from their prediction."""
    before = found.cases[PASSIVE].ideal
    head = ("ground force, dB", "without delay", "predicted", *MASTERS, "apart")
    rows = []
    for name, case in found.cases.items():
        expected = change(case.delayed, before)
        values = [change(levels, before) for levels in case.found.values()]
        apart = max(abs(value - expected) for value in values)
        shown = (change(case.ideal, before), expected, *values)
        rows.append((name, *(f"{value:z.2f}" for value in shown), f"{apart:.3f}"))
    return table(head, rows)


def powers(found: Comparison) -> Iterator[str]:
    """Forces and powers as predicted with the delay; alpha as the masters found it, too."""
    head = ("with delay", "ground N", "mounts N", "actuators N", "mounts mW", "actuators mW", "casing mW", "alpha")
    rows = [
        (
            name,
            *(f"{value.item():.2f}" for value in (case.delayed.ground_force, case.delayed.mount_force)),
            f"{case.delayed.strut_force.item():.2f}",
            *(f"{1e3 * value.item():z.3f}" for value in (case.delayed.mount_power, case.delayed.strut_power)),
            f"{1e3 * case.delayed.transmitted_power.item():.3f}",
            f"{case.delayed.alpha.item():.3f}",
        )
        for name, case in found.cases.items()
    ]
    yield from table(head, rows)
    yield ""
    head = ("alpha", "without delay", "predicted", *MASTERS)
    yield from table(
        head,
        [
            (name, *(f"{level.alpha.item():.3f}" for level in (case.ideal, case.delayed, *case.found.values())))
            for name, case in found.cases.items()
        ],
    )


def margins(found: Comparison) -> Iterator[str]:
    """From the peak of the sensitivity on the complete machine."""
    rows = []
    looped = {name: case.loop for name, case in found.cases.items() if case.loop}
    for name, loop in looped.items():
        for delay, step in (("no", None), (f"{1e3 * STEP:g} ms", STEP)):
            peak = peak_sensitivity(found.machine.plant, loop, step)
            low, high = peak / (peak + 1.0), peak / (peak - 1.0) if peak > 1.0 + 1e-3 else float("inf")
            phase = degrees(2.0 * asin(0.5 / peak))
            above = "any" if isinf(high) else f"{high:.2f}"
            order = f"{loop.controller.nstates}"
            rows.append((name, order, delay, f"{peak:.2f}", f"{low:.2f}", above, f"{phase:.0f}"))
    head = ("loop", "states", "step", "peak of (I - KG)^-1", "gain from", "gain to", "phase, deg")
    return table(head, rows)


def steps(found: Comparison) -> Iterator[str]:
    """What the step of the co-simulation costs."""
    rows = [(f"{1e6 * step:g}", f"{both[0]:.2f}", f"{both[1]:.2f}") for step, both in found.steps.items()]
    return table(("LQG, struts: step, us", "predicted, dB", "fmpy, dB"), rows)


def limits(found: Comparison) -> Iterator[str]:
    """Gains of velocity feedback, N s/m."""
    rows = [
        (name, *("none" if isinf(limit) else f"{float(f'{limit:.3g}'):.0f}" for limit in both))
        for name, both in found.limits.items()
    ]
    return table(("largest stable gain, N s/m", "without delay", f"step {1e3 * STEP:g} ms"), rows)
