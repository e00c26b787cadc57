"""The closed loop by itself: in continuous time, and as a co-simulation closes it, sample by sample.

A master that moves both FMUs at once (Jacobi) lets each see the other's outputs of the step's beginning, held over the
step h. The transmission error is made inside the gearbox's FMU and is not held. At the communication points, with
z = e^(i w h):

    y = G_e(i w) e + G_h(z) u,    u = (C_K (z - A_h)^-1 B_h + D_K / z) y

G_h, A_h and B_h are exact zero-order holds of the struts on the machine and of the sensors on the controller. D_K waits
one step: an FMU's output is read before its input is set. Nothing is neglected, so that a co-simulation must find these
very numbers; what h costs is the difference from the loop in continuous time.
"""

from dataclasses import dataclass

import control
import numpy as np
from design import COUNT
from plant import Plant
from scipy.linalg import expm


@dataclass(frozen=True)
class Phasors:
    """Peak amplitudes over frequency: outputs y (F, p) at the communication points, and the struts' forces u (F, 4).

    u is the fundamental of the force that acts: of the staircase, where it is held.
    """

    frequency: np.ndarray
    y: np.ndarray
    u: np.ndarray


def continuous(plant: Plant, controller: control.StateSpace | None, f: np.ndarray, error: float = 1.0) -> Phasors:
    """The answer to a transmission error of this amplitude (m) without any delay."""
    s = 2j * np.pi * np.asarray(f, dtype=float)
    Ge, Gu = _machine(plant, s)
    K = np.zeros((len(s), COUNT, COUNT)) if controller is None else _transfer(controller, s)
    u = _closed(Ge, Gu, K)
    return Phasors(s.imag / (2 * np.pi), error * (Ge + _times(Gu, u)), error * u)


def sampled(
    plant: Plant, controller: control.StateSpace | None, f: np.ndarray, step: float, error: float = 1.0
) -> Phasors:
    """The same where a co-simulation closes the loop with this step (s)."""
    s = 2j * np.pi * np.asarray(f, dtype=float)
    z = np.exp(s * step)
    Ge, _ = _machine(plant, s)
    Ad, Bd = held(plant.A, plant.Bu, step)
    Gu = _transfer(control.ss(Ad, Bd, plant.C, np.zeros((len(plant.C), COUNT)), step), z)
    K = np.zeros((len(s), COUNT, COUNT)) if controller is None else _delayed(controller, z, step)
    u = _closed(Ge, Gu, K)
    return Phasors(s.imag / (2 * np.pi), error * (Ge + _times(Gu, u)), error * u * hold(f, step)[:, None])


def hold(f: np.ndarray, step: float) -> np.ndarray:
    """Fundamental of a staircase per sample: (1 - e^(-i w h)) / (i w h)."""
    x = 2j * np.pi * np.asarray(f, dtype=float) * step
    return np.asarray((1.0 - np.exp(-x)) / x)


def held(A: np.ndarray, B: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """e^(A h) and the integral of e^(A t) B over a step."""
    n, m = B.shape
    both = expm(step * np.block([[A, B], [np.zeros((m, n + m))]]))
    return both[:n, :n], both[:n, n:]


def closed_matrix(plant: Plant, controller: control.StateSpace, step: float | None = None) -> np.ndarray:
    """State matrix of the loop: of x' = A x without a step, of x+ = A x with one (its last states are the samples)."""
    K, sensors = controller, plant.sensors()
    if step is None:
        direct = plant.A + plant.Bu @ K.D @ sensors
        return np.block([[direct, plant.Bu @ K.C], [K.B @ sensors, K.A]])
    Ad, Bd = held(plant.A, plant.Bu, step)
    Kd, Ld = held(K.A, K.B, step)
    return np.block(
        [
            [Ad, Bd @ K.C, Bd @ K.D],
            [Ld @ sensors, Kd, np.zeros((len(Kd), COUNT))],
            [sensors, np.zeros((COUNT, len(Kd) + COUNT))],
        ]
    )


def is_stable(plant: Plant, controller: control.StateSpace, step: float | None = None) -> bool:
    """Whether everything decays."""
    values = np.linalg.eigvals(closed_matrix(plant, controller, step))
    return bool(values.real.max() < 0.0 if step is None else abs(values).max() < 1.0)


def sensitivity(plant: Plant, controller: control.StateSpace, f: np.ndarray, step: float | None = None) -> np.ndarray:
    """Largest singular value of (I - K G)^-1 at the struts, over frequency (F,).

    With its peak M, the loop stays stable for gains from M/(M + 1) to M/(M - 1) and phases up to 2 asin(1/(2 M)) in all
    struts at once.
    """
    s = 2j * np.pi * np.asarray(f, dtype=float)
    if step is None:
        _, G = _machine(plant, s)
        K = _transfer(controller, s)
    else:
        z = np.exp(s * step)
        Ad, Bd = held(plant.A, plant.Bu, step)
        G = _transfer(control.ss(Ad, Bd, plant.sensors(), np.zeros((COUNT, COUNT)), step), z)
        K = _delayed(controller, z, step)
    return np.asarray(1.0 / np.linalg.svd(np.eye(COUNT) - K @ G[:, :COUNT], compute_uv=False)[:, -1])


def _machine(plant: Plant, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """From the transmission error (F, p) and from the struts (F, p, 4) to the outputs."""
    B = np.column_stack([plant.Be, plant.Bu])
    D = np.column_stack([plant.De, np.zeros((len(plant.C), COUNT))])
    G = _transfer(control.ss(plant.A, B, plant.C, D), s)
    return G[:, :, 0], G[:, :, 1:]


def _transfer(system: control.StateSpace, points: np.ndarray) -> np.ndarray:
    """C (p - A)^-1 B + D at the points p (F): (F, outputs, inputs), by the modes of A."""
    if not system.nstates:
        return np.broadcast_to(system.D, (len(points), *system.D.shape))
    values, T = np.linalg.eig(system.A)
    right, left = system.C @ T, np.linalg.solve(T, system.B.astype(complex))
    return np.asarray((right / (points[:, None, None] - values)) @ left + system.D)


def _delayed(controller: control.StateSpace, z: np.ndarray, step: float) -> np.ndarray:
    """The controller behind a sampler: its own steps are exact, its feedthrough waits one."""
    Ad, Bd = held(controller.A, controller.B, step)
    moving = _transfer(control.ss(Ad, Bd, controller.C, np.zeros((COUNT, COUNT)), step), z)
    return np.asarray(moving + controller.D / z[:, None, None])


def _closed(Ge: np.ndarray, Gu: np.ndarray, K: np.ndarray) -> np.ndarray:
    """u = K (Ge e + Gu u) for e = 1: (F, 4)."""
    to_sensors, among = Ge[:, :COUNT], Gu[:, :COUNT]
    return np.asarray(np.linalg.solve(np.eye(COUNT) - K @ among, _times(K, to_sensors)[..., None])[..., 0])


def _times(matrices: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    return np.asarray((matrices @ vectors[..., None])[..., 0])
