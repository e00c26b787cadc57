"""The machine with its struts and sensors as matrices, in the order in which this example reads them."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import control
import numpy as np

import gearpath as gp

MODEL = Path(__file__).parent / "active_mounts.toml"
MOUNTS = ("mount_1", "mount_2", "mount_3", "mount_4")
STRUTS = tuple(f"actuators.strut_{k}" for k in (1, 2, 3, 4))
SENSORS = tuple(f"sensors.{mount}" for mount in MOUNTS)
MOUNT_FORCES = tuple(f"{mount}.force_uy" for mount in MOUNTS)  # on the ground
PORTS = tuple(f"bearing_{k}.{{}}_{dof}" for k in (1, 2, 3, 4) for dof in ("uy", "rx"))
BEARING_FORCES = tuple(port.format("force") for port in PORTS)  # on the casing
BEARING_VELOCITIES = tuple(port.format("velocity") for port in PORTS)
OUTPUTS = (*SENSORS, *MOUNT_FORCES, *BEARING_FORCES, *BEARING_VELOCITIES, "mesh.velocity")
ERROR = "mesh.transmission_error"


@dataclass(frozen=True)
class Plant:
    """x' = A x + Be e + Bu u, y = C x + De e (n states): e the transmission error (m), u the struts (N), y OUTPUTS.

    No output of OUTPUTS has a direct feedthrough from the struts: there is no algebraic loop. `mesh_mass` (kg) makes
    the equivalent force of a transmission error, F_e = -m_e e''.
    """

    A: np.ndarray
    Be: np.ndarray
    Bu: np.ndarray
    C: np.ndarray
    De: np.ndarray
    mesh_mass: float

    def sensors(self) -> np.ndarray:
        """Rows of C that the controller sees (4, n)."""
        return self.C[: len(SENSORS)]


def labels(names: Sequence[str]) -> list[str]:
    """python-control's names of FMU variables."""
    return [name.replace(".", "/") for name in names]


def plant_of(system: control.StateSpace) -> Plant:
    """The matrices of `gp.state_space` or `gp.reduce`."""
    columns, rows = ([found.index(label) for label in labels(names)] for found, names in (
        (system.input_labels, (ERROR, "mesh.force", *STRUTS)), (system.output_labels, OUTPUTS)))  # fmt: skip
    e, force, *struts = columns
    if np.any(system.D[np.ix_(rows, struts)]):
        raise ValueError("a strut acts on an output at once: the loop would be algebraic")
    s = 2j * np.pi * 500.0  # any frequency: both inputs act through the same states
    both = system(s)[rows[len(SENSORS)]][[e, force]]
    mass = float((both[0] / both[1] / -(s**2)).real)
    B, C = system.B, system.C[rows]
    return Plant(system.A, B[:, e], B[:, struts], C, system.D[rows, e], mass)


def machine() -> gp.Model:
    """The model of this folder."""
    return gp.load(MODEL)


def mesh_frequency(model: gp.Model, speed: float | None = None) -> float:
    """Hz, at the speed (rev/min) of the model's source, or another."""
    source = model.system.source
    return float((source.speed if speed is None else speed) / 60.0 * source.teeth)
