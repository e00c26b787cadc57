"""All that the example computes: predictions, co-simulations by both masters, steps, margins, gain limits."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import control
import cosimulate_fmpy
import cosimulate_libcosim
import numpy as np
from design import Loop, inertial_feedback, largest_gain, loops, velocity_feedback
from levels import Levels, decibels, levels, measured
from plant import OUTPUTS, Plant, machine, mesh_frequency, plant_of
from prediction import Phasors, continuous, is_stable, sampled, sensitivity

import gearpath as gp

STEP = 1e-4  # s, of the co-simulations
DURATION = 0.5  # s; the last 0.1 s count
STEPS = (2e-4, 1e-4, 5e-5, 2e-5)  # s, of the table of steps
MARGINS = np.geomspace(5.0, 4999.0, 3000)  # Hz, up to half the sampling rate
PROOF_RESONANCES = (10.0, 20.0, 100.0, 300.0)  # Hz
PASSIVE, STEPPED = "passive mounts", "LQG, struts"
MASTERS: dict[str, Callable[..., dict[str, np.ndarray]]] = {"fmpy": cosimulate_fmpy.run}
if cosimulate_libcosim.is_installed():
    MASTERS["libcosim"] = cosimulate_libcosim.run


@dataclass(frozen=True)
class Case:
    """One controller, or none, at the mesh frequency: without delay, with it, and as measured by master."""

    loop: Loop | None
    ideal: Levels
    delayed: Levels
    found: dict[str, Levels]


@dataclass(frozen=True)
class Machine:
    """The machine, its FMU, and the first harmonic of its gear mesh."""

    plant: Plant
    fmu: Path
    frequency: float  # Hz
    error: float  # m
    phase: float  # rad

    def ideal(self, loop: Loop | None) -> Levels:
        """In continuous time."""
        return self.figures(continuous(self.plant, controller_of(loop), np.array([self.frequency]), self.error), loop)

    def delayed(self, loop: Loop | None, step: float) -> Levels:
        """As a co-simulation closes the loop."""
        return self.figures(
            sampled(self.plant, controller_of(loop), np.array([self.frequency]), step, self.error), loop
        )

    def co_simulated(self, master: str, loop: Loop | None, fmu: Path | None, step: float) -> Levels:
        """As a master finds it."""
        record = MASTERS[master](self.fmu, fmu, step, round(DURATION / step), OUTPUTS)
        return self.figures(measured(record, step, self.frequency, (1, 2), self.phase), loop)

    def figures(self, phasors: Phasors, loop: Loop | None) -> Levels:
        """Levels of this machine."""
        return levels(phasors, self.plant, self.error, on_ground=loop is None or loop.on_ground)


@dataclass(frozen=True)
class Comparison:
    """Everything that is printed and drawn."""

    machine: Machine
    cases: dict[str, Case]
    steps: dict[float, tuple[float, float]]  # s: change of the ground force, predicted and by FMPy, dB
    limits: dict[str, tuple[float, float]]  # largest stable gains without and with the delay, N s/m


def controller_of(loop: Loop | None) -> control.StateSpace | None:
    """None for the passive machine."""
    return None if loop is None else loop.controller


def change(now: Levels, before: Levels) -> float:
    """Of the force into the ground, dB."""
    return float(decibels(now.ground_force / before.ground_force).item())


def compared(folder: Path) -> Comparison:
    """Design, export, predict, co-simulate; the FMUs go into the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    model = machine()
    tone = model.system.source.tones[0]
    fmu = gp.export_fmu(model, folder / "gearbox.fmu", documentation=False)
    own = Machine(plant_of(gp.state_space(model)), fmu, mesh_frequency(model), tone.amplitude, tone.phase)
    designed: dict[str, Loop | None] = {PASSIVE: None, **loops(model, STEP)}
    fmus = {name: None if loop is None else exported(loop, folder) for name, loop in designed.items()}
    cases = {
        name: Case(
            loop,
            own.ideal(loop),
            own.delayed(loop, STEP),
            {master: own.co_simulated(master, loop, fmus[name], STEP) for master in MASTERS},
        )
        for name, loop in designed.items()
    }
    before, loop = cases[PASSIVE].ideal, designed[STEPPED]
    steps = {
        step: tuple(
            change(now, before)
            for now in (own.delayed(loop, step), own.co_simulated("fmpy", loop, fmus[STEPPED], step))
        )
        for step in STEPS
    }
    return Comparison(own, cases, steps, gain_limits(own.plant))


def exported(loop: Loop, folder: Path) -> Path:
    """The controller's FMU."""
    path = folder / f"{loop.controller.name}.fmu"
    units = dict.fromkeys(loop.controller.input_labels, "m/s") | dict.fromkeys(loop.controller.output_labels, "N")
    return gp.export_fmu(loop.controller, path, units=units, step_size=STEP, documentation=False)


def peak_sensitivity(plant: Plant, loop: Loop, step: float | None) -> float:
    """The largest over all frequencies."""
    return float(sensitivity(plant, loop.controller, MARGINS, step).max())


def gain_limits(plant: Plant) -> dict[str, tuple[float, float]]:
    """The largest stable gains of velocity feedback: against the ground, and against proof masses."""

    def limit(make: Callable[[float], Loop], step: float | None) -> float:
        return largest_gain(lambda gain: is_stable(plant, make(gain).controller, step))

    makers: dict[str, Callable[[float], Loop]] = {"struts": velocity_feedback}
    for f in PROOF_RESONANCES:
        makers[f"proof masses, {f:g} Hz"] = lambda gain, f=f: inertial_feedback(gain, f)
    return {name: (limit(make, None), limit(make, STEP)) for name, make in makers.items()}
