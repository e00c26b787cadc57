"""Both FMUs in a loop of FMPy's slaves: read all, set all, move all."""

import tempfile
from collections.abc import Sequence
from pathlib import Path

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Slave
from plant import SENSORS, STRUTS


class Running:
    """An instance of an FMU, with variables by name."""

    def __init__(self, path: Path, folder: Path) -> None:
        description = fmpy.read_model_description(str(path))
        fmpy.extract(str(path), str(folder))
        self.references = {v.name: v.valueReference for v in description.modelVariables}
        self.slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=str(folder),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=description.modelName,
        )
        self.slave.instantiate()
        self.slave.setupExperiment()
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()

    def at(self, names: Sequence[str]) -> list[int]:
        """Value references."""
        return [self.references[name] for name in names]

    def close(self) -> None:
        """End the instance."""
        self.slave.terminate()
        self.slave.freeInstance()


def run(
    gearbox: Path,
    controller: Path | None,
    step: float,
    steps: int,
    outputs: Sequence[str],
    run_up: tuple[float, float] | None = None,
) -> dict[str, np.ndarray]:
    """The gearbox's outputs and the struts' forces at the end of every step (steps,), from rest, by name.

    A strut's force there is that which acts over the next step. `run_up`: speed at the beginning (rev/min) and its rate
    (rev/min per s), given with its derivative so that the source is integrated exactly.
    """
    with tempfile.TemporaryDirectory() as folder:
        plant = Running(gearbox, Path(folder) / "gearbox")
        hand = None if controller is None else Running(controller, Path(folder) / "controller")
        rows = _steps(plant, hand, step, steps, outputs, run_up)
        for instance in (plant, hand):
            if instance is not None:
                instance.close()
    return dict(zip((*outputs, *STRUTS), rows.T))


def _steps(
    plant: Running,
    hand: Running | None,
    step: float,
    steps: int,
    outputs: Sequence[str],
    run_up: tuple[float, float] | None,
) -> np.ndarray:
    struts, sensors, watched, speed = (plant.at(names) for names in (STRUTS, SENSORS, outputs, ["mesh.speed"]))
    seen, given = (hand.at(SENSORS), hand.at(STRUTS)) if hand else ([], [])
    forces, velocities = [0.0] * len(STRUTS), plant.slave.getReal(sensors)
    rows = np.empty((steps, len(watched) + len(struts)))
    for k in range(steps):
        if hand:  # both were read at the end of the last step
            plant.slave.setReal(struts, forces)
            hand.slave.setReal(seen, velocities)
        if run_up:
            plant.slave.setReal(speed, [run_up[0] + run_up[1] * step * k])
            plant.slave.setRealInputDerivatives(speed, [1], [run_up[1]])
        plant.slave.doStep(step * k, step)
        if hand:
            hand.slave.doStep(step * k, step)
            forces, velocities = hand.slave.getReal(given), plant.slave.getReal(sensors)
        rows[k] = [*plant.slave.getReal(watched), *forces]
    return rows
