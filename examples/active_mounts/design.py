"""Controllers from the casing's velocity at the mounts to the force on the casing there.

All are python-control systems v (m/s, 4) -> u (N, 4) with the machine's names, so that their FMUs fit the gearbox's.
"""

from collections.abc import Callable
from dataclasses import dataclass

import control
import numpy as np
from plant import SENSORS, STRUTS, Plant, labels, machine, mesh_frequency, plant_of
from scipy.linalg import block_diag, solve_continuous_are

import gearpath as gp

COUNT = len(STRUTS)
GAIN = 3000.0  # N s/m, of the velocity feedback of every strut
PROOF_MASS, RESONANCE, RATIO = 0.5, 20.0, 0.2  # kg, Hz, damping ratio of an inertial actuator
INERTIAL_GAIN = 3000.0  # N s/m
BAND = (50.0, 1200.0)  # Hz, of the reduced model: beyond the mesh frequency's double
TOLERANCE = 1e-2  # of the reduced model
EFFORT = 0.3  # weight of the strut forces beside that of the forces into the ground
ERROR_RMS, ERROR_DAMPING = 1e-6, 0.02  # m and damping ratio of the narrow band of transmission error
DISTURBANCE = 1.0  # N/Hz^0.5, two-sided white noise on every strut: what the model does not know
NOISE = 1e-5  # m/s/Hz^0.5, two-sided white noise of every sensor


@dataclass(frozen=True)
class Loop:
    """A controller, and where its actuators find their reaction: the ground (struts) or proof masses."""

    controller: control.StateSpace
    on_ground: bool = True


def named(A: np.ndarray, B: np.ndarray, C: np.ndarray, D: np.ndarray, name: str) -> control.StateSpace:
    """x' = A x + B v, u = C x + D v with the signals' names."""
    return control.ss(A, B, C, D, inputs=labels(SENSORS), outputs=labels(STRUTS), name=name)


def velocity_feedback(gain: float = GAIN) -> Loop:
    """u = -g v: a dashpot to the ground beside every mount."""
    empty = np.zeros((0, COUNT))
    return Loop(named(np.zeros((0, 0)), empty, empty.T, -gain * np.eye(COUNT), "velocity_feedback"))


def inertial_feedback(gain: float = INERTIAL_GAIN, resonance: float = RESONANCE) -> Loop:
    """The same force against a proof mass m on a spring k and a dashpot c, one on every mount.

    m nu' = -k delta - c (nu - v) + g v,  delta' = nu - v,  u = k delta + c (nu - v) - g v: the actuator is part of the
    controller, loads the casing by its mass also at g = 0, and turns its force round below its resonance.
    """
    w = 2.0 * np.pi * resonance
    k, c = PROOF_MASS * w**2, 2.0 * RATIO * w * PROOF_MASS
    A = np.array([[0.0, 1.0], [-k / PROOF_MASS, -c / PROOF_MASS]])
    B = np.array([[-1.0], [(c + gain) / PROOF_MASS]])
    parts = (A, B, np.array([[k, c]]), np.array([[-c - gain]]))
    return Loop(named(*(block_diag(*[part] * COUNT) for part in parts), "inertial_feedback"), on_ground=False)


def lqg(reduced: Plant, frequency: float, delay: float = 0.0) -> Loop:
    """The controller that makes E[sum F_ground^2 + EFFORT sum u^2] least for noise around the mesh frequency (Hz).

    The forces into the ground are those of the mounts less the struts', F_ground = F_mount - u. The transmission error
    is white noise through e = w^2/(s^2 + 2 zeta w s + w^2), with ERROR_RMS; struts and sensors have noise of their own.
    `delay` (s) is put in front of the struts as (1 - s delay/2)/(1 + s delay/2).
    """
    w, n = 2.0 * np.pi * frequency, len(reduced.A)
    shape = np.array([[0.0, w], [-w, -2.0 * ERROR_DAMPING * w]])
    A = block_diag(reduced.A, shape)
    A[:n, n] = reduced.Be
    B = np.vstack([reduced.Bu, np.zeros((2, COUNT))])
    white = np.zeros((n + 2, 1))
    white[n + 1] = ERROR_RMS * np.sqrt(4.0 * ERROR_DAMPING * w)
    seen = np.hstack([reduced.C, reduced.De[:, None], np.zeros((len(reduced.C), 1))])
    sensors, mounts = seen[:COUNT], seen[COUNT : 2 * COUNT]
    pressed, through = np.zeros((COUNT, n + 2)), np.eye(COUNT)  # strut force = pressed x + through u
    if delay:
        A = np.block([[A, B], [np.zeros((COUNT, n + 2)), -2.0 / delay * np.eye(COUNT)]])
        B = np.vstack([-B, 4.0 / delay * np.eye(COUNT)])
        sensors, mounts, pressed = (np.hstack([rows, np.zeros((COUNT, COUNT))]) for rows in (sensors, mounts, pressed))
        white = np.vstack([white, np.zeros((COUNT, 1))])
        pressed[:, n + 2 :], through = np.eye(COUNT), -np.eye(COUNT)
    ground = mounts - pressed
    shaken = np.vstack([reduced.Bu, np.zeros((len(A) - n, COUNT))])
    R, N = through.T @ through + EFFORT * np.eye(COUNT), -ground.T @ through
    X = solve_continuous_are(A, B, ground.T @ ground, R, s=N)
    K = np.linalg.solve(R, B.T @ X + N.T)
    V = NOISE**2 * np.eye(COUNT)
    Y = solve_continuous_are(A.T, sensors.T, white @ white.T + DISTURBANCE**2 * shaken @ shaken.T, V)
    L = np.linalg.solve(V, sensors @ Y).T
    name = "lqg_with_delay" if delay else "lqg"
    return Loop(named(A - B @ K - L @ sensors, L, -K, np.zeros((COUNT, COUNT)), name))


def loops(model: gp.Model | None = None, step: float = 1e-4) -> dict[str, Loop]:
    """All controllers by name; `step` (s) is the delay that the last one knows of."""
    model = machine() if model is None else model
    reduced, frequency = plant_of(gp.reduce(model, tolerance=TOLERANCE, band=BAND)), mesh_frequency(model)
    return {
        "velocity feedback, struts": velocity_feedback(),
        "velocity feedback, proof masses": inertial_feedback(),
        "LQG, struts": lqg(reduced, frequency),
        "LQG for the delay, struts": lqg(reduced, frequency, step),
    }


def largest_gain(stable: Callable[[float], bool], start: float = 10.0, most: float = 1e7) -> float:
    """The gain (to 0.5 %) at which a loop that is stable at small gains stops to be so; infinite beyond `most`."""
    high = start
    while stable(high):
        high *= 2.0
        if high > most:
            return float("inf")
    low = high / 2.0 if high > start else 0.0
    while high - low > 5e-3 * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if stable(middle) else (low, middle)
    return low
