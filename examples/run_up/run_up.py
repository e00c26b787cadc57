"""A run-up with active mounts: the gear mesh source inside the gearbox's FMU, the controller's FMU, and both in a loop.

    python examples/run_up/run_up.py [--folder build/run_up]

The machine of examples/active_mounts runs up on passive mounts and with velocity feedback against proof masses. The
orders of the tooth meshing are tracked and compared with what holds at steady speed: powers with the FMU's own order
outputs, forces into the ground with the predicted loop. Draws orders.svg and spectrograms.png.
"""

import argparse
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from orders import centres, shaft_angle, tracked
from pictures import draw_orders, draw_spectrograms

import gearpath as gp

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "active_mounts"))

from cosimulate_fmpy import Running, run
from design import Loop, inertial_feedback
from levels import decibels, levels
from plant import OUTPUTS, STRUTS, Plant, machine, plant_of
from prediction import Phasors, hold, sampled

START, STOP, DURATION, STEP = 300.0, 1500.0, 8.0, 1e-4  # rev/min, s, s
RATE = (STOP - START) / DURATION  # rev/min per s
SHOWN = (400.0, 478.0, 600.0, 800.0, 1000.0, 1100.0, 1200.0, 1300.0, 1400.0)  # rev/min, of the table
FINE = np.linspace(320.0, 1480.0, 1161)  # rev/min, of the curves


@dataclass(frozen=True)
class Harmonic:
    """One order at all centres of its averages (C,), and at steady speed (FINE)."""

    order: float
    ground_force: np.ndarray  # N, RMS over the mounts, run-up
    power: np.ndarray  # W, through all bearings, run-up
    steady_force: np.ndarray  # N, at FINE, by the prediction of the loop with its delay
    steady_power: np.ndarray  # W, at FINE, likewise


@dataclass(frozen=True)
class RunUp:
    """Both run-ups: `harmonics` and `records` by name of the mounts; `speed` (rev/min) of the centres."""

    speed: np.ndarray
    harmonics: dict[str, list[Harmonic]]
    records: dict[str, dict[str, np.ndarray]]
    order_outputs: np.ndarray  # W (FINE, orders): the FMU's own, on passive mounts


def ran_up(folder: Path) -> RunUp:
    """Export, run, track; the FMUs go into the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    model = machine()
    source, plant = model.system.source, plant_of(gp.state_space(model))
    gearbox = gp.export_fmu(model, folder / "gearbox.fmu", documentation=False)
    loop = inertial_feedback()
    controller = gp.export_fmu(loop.controller, folder / "controller.fmu", step_size=STEP, documentation=False)
    steps = round(DURATION / STEP)
    angle = shaft_angle(STEP * np.arange(1, steps + 1), START, RATE)
    speed = np.sqrt(START**2 + 2.0 * RATE * 60.0 / (2.0 * np.pi) * centres(angle))
    records, harmonics = {}, {}
    for name, closed, fmu in (("passive", None, None), ("active", loop, controller)):
        records[name] = run(gearbox, fmu, STEP, steps, OUTPUTS, run_up=(START, RATE))
        harmonics[name] = [
            harmonic(
                plant, closed, records[name], angle, speed, (tone.harmonic * source.teeth, tone.amplitude, tone.phase)
            )
            for tone in source.tones
        ]
    return RunUp(speed, harmonics, records, order_outputs(gearbox, len(source.tones)))


def harmonic(
    plant: Plant,
    loop: Loop | None,
    record: dict[str, np.ndarray],
    angle: np.ndarray,
    speed: np.ndarray,
    tone: tuple[float, float, float],
) -> Harmonic:
    """Track one tone (order, amplitude in m, phase in rad) and predict it."""
    order, error, phase = tone
    on_ground = loop is None or loop.on_ground
    phasors = tracked(record, (*OUTPUTS, *STRUTS), angle, order, phase)
    f = order * speed / 60.0
    y, u = np.split(phasors, [len(OUTPUTS)], axis=1)
    now = levels(Phasors(f, y, u * hold(f, STEP)[:, None]), plant, error, on_ground=on_ground)
    expected = sampled(plant, loop.controller if loop else None, order * FINE / 60.0, STEP, error)
    steady = levels(expected, plant, error, on_ground=on_ground)
    forces = (now.ground_force, now.transmitted_power, steady.ground_force, steady.transmitted_power)
    return Harmonic(order, *forces)


def order_outputs(fmu: Path, count: int) -> np.ndarray:
    """Power of each tone by the FMU at steady speed, as it would be on passive mounts; no time passes."""
    names = [f"mesh.harmonic_{k + 1}.power" for k in range(count)]
    powers = []
    with tempfile.TemporaryDirectory() as folder:
        instance = Running(fmu, Path(folder))
        for speed in FINE:
            instance.slave.setReal(instance.at(["mesh.speed"]), [speed])
            powers.append(instance.slave.getReal(instance.at(names)))
        instance.close()
    return np.array(powers)


def text(found: RunUp) -> str:
    """The table, and how far run-up and steady speed are apart."""
    return "\n".join((*table(found), "", *apart(found)))


def table(found: RunUp) -> Iterator[str]:
    """Force of the first harmonic into the ground."""
    yield "| rev/min | mesh Hz | passive N | steady N | active N | steady N | change dB | predicted dB |"
    yield "| ---: |" + " ---: |" * 7
    passive, active = (found.harmonics[name][0] for name in ("passive", "active"))
    for speed in SHOWN:
        forces = [np.interp(speed, found.speed, h.ground_force) for h in (passive, active)]
        steady = [np.interp(speed, FINE, h.steady_force) for h in (passive, active)]
        change, predicted = (decibels(pair[1] / pair[0]).item() for pair in (forces, steady))
        cells = (speed, passive.order * speed / 60.0, forces[0], steady[0], forces[1], steady[1])
        yield f"| {' | '.join(f'{cell:.4g}' for cell in cells)} | {change:.1f} | {predicted:.1f} |"


def apart(found: RunUp) -> Iterator[str]:
    """Median and largest |dB| over the speeds that FINE spans."""
    inner = found.speed < FINE[-1]
    for name, harmonics in found.harmonics.items():
        for k, one in enumerate(harmonics):
            force = abs(decibels(one.ground_force / np.interp(found.speed, FINE, one.steady_force)))[inner]
            away = f"{np.median(force):.2f} dB apart in the median, {force.max():.1f} dB at most"
            yield f"{name}, order {one.order:g}: run-up and prediction {away}"
            if name == "passive":
                steady = np.interp(found.speed, FINE, found.order_outputs[:, k])
                power = 0.5 * decibels(abs(one.power) / steady)
                median = np.median(abs(power[inner]))
                yield f"{name}, order {one.order:g}: power and order output {median:.2f} dB apart in the median"


def main(arguments: Sequence[str] | None = None) -> RunUp:
    """Compute, print and draw."""
    parser = argparse.ArgumentParser(description="A run-up with the loop open and closed.")
    parser.add_argument("--folder", type=Path, default=Path("build") / "run_up", help="for pictures and FMUs")
    folder = parser.parse_args(arguments).folder
    found = ran_up(folder)
    print(text(found))
    draw_orders(folder / "orders.svg", found.speed, FINE, found.harmonics)
    signals = {name: record["mount_1.force_uy"] for name, record in found.records.items()}
    draw_spectrograms(folder / "spectrograms.png", signals, STEP, (START, STOP))
    return found


if __name__ == "__main__":
    main()
