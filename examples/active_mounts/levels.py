"""From phasors to what is compared: forces into the ground, powers, alpha; and from time series to phasors."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from plant import OUTPUTS, STRUTS, Plant
from prediction import Phasors, hold


@dataclass(frozen=True)
class Levels:
    """Over frequency (F,): RMS values over all mounts (N) and mean powers (W).

    A rigid ground takes up no power, whatever presses on it: so the mount power is what the mounts dissipate, and
    beside it stand the forces, which would make power in any ground that gives way. `ground_force` has the mounts'
    forces and the reactions of struts, phase included. `strut_power` is what the actuators take from the casing.
    """

    ground_force: np.ndarray
    mount_force: np.ndarray
    strut_force: np.ndarray
    mount_power: np.ndarray
    strut_power: np.ndarray
    transmitted_power: np.ndarray
    input_power: np.ndarray

    @property
    def alpha(self) -> np.ndarray:
        """Power through the bearings into the casing over input power."""
        return self.transmitted_power / self.input_power


def levels(found: Phasors, plant: Plant, error: float, *, on_ground: bool) -> Levels:
    """The figures of an answer to a transmission error of this amplitude (m) and phase 0; `on_ground`: of struts."""
    v, mounts, forces, velocities, mesh = np.split(found.y, [4, 8, 16, 24], axis=1)
    w = 2.0 * np.pi * found.frequency
    return Levels(
        ground_force=_rms(mounts - found.u if on_ground else mounts),
        mount_force=_rms(mounts),
        strut_force=_rms(found.u),
        mount_power=_power(v, mounts),
        strut_power=-_power(v, found.u),
        transmitted_power=_power(velocities, forces),
        input_power=_power(mesh, (plant.mesh_mass * w**2 * error)[:, None]),
    )


def measured(
    record: Mapping[str, np.ndarray], step: float, frequency: float, orders: Sequence[int], phase: float
) -> Phasors:
    """Phasors at `frequency` (Hz) of a record from t = step on, by least squares over all `orders` of it at once.

    Only its last cycles count: see `window`. `phase` (rad) is the transmission error's, and that of the phasors is
    against it.
    """
    size = len(record["mesh.velocity"])
    at = np.arange(size)[window(size, step, frequency)]
    angle = 2.0 * np.pi * frequency * step * (at + 1.0)
    waves = [part(order * angle) for order in orders for part in (np.cos, np.sin)]
    signals = np.array([record[name][at] for name in (*OUTPUTS, *STRUTS)]).T
    cosine, sine = np.linalg.lstsq(np.array([*waves, np.ones(len(at))]).T, signals, rcond=None)[0][:2]
    phasors = (cosine - 1j * sine) * np.exp(-1j * phase)
    f = np.array([frequency])
    return Phasors(f, phasors[None, : len(OUTPUTS)], phasors[None, len(OUTPUTS) :] * hold(f, step)[:, None])


def window(size: int, step: float, frequency: float, cycles: int = 52) -> slice:
    """The last cycles of a record."""
    return slice(size - round(cycles / (frequency * step)), size)


def decibels(ratio: np.ndarray | float) -> np.ndarray:
    """20 lg of a ratio of amplitudes."""
    return np.asarray(20.0 * np.log10(ratio))


def _rms(phasors: np.ndarray) -> np.ndarray:
    return np.asarray(np.sqrt(0.5 * np.sum(np.abs(phasors) ** 2, axis=1)))


def _power(velocity: np.ndarray, force: np.ndarray) -> np.ndarray:
    return np.asarray(0.5 * np.real(np.sum(np.conj(velocity) * force, axis=1)))
