"""A gearbox with a gear mesh source, and what its outputs must be: closed form and Gauss-Legendre quadrature.

From the matrices of python-control and the definition of the source alone,
    e = sum a_i cos(o_i theta + phi_i),   o_i = harmonic_i * teeth + shift_i,   theta' = 2 pi n / 60.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import scipy.linalg

import gearpath as gp

MODELS = Path(__file__).resolve().parents[3] / "models"
TEETH, SPEED = 37, 2950.0
HARMONICS = ((1, 1e-6, 0.3), (2, 3e-7, -1.1))  # order, amplitude, phase
SIDEBANDS = ((1, -1.0, 2e-7, 2.0), (1, 0.98, 1e-7, 0.7), (2, -2.413, 5e-8, -2.9))  # harmonic, order, ...
NAMES = ("mesh.harmonic_1", "mesh.harmonic_2", "mesh.sideband_1", "mesh.sideband_2", "mesh.sideband_3")
OUT = "mesh.transmission_error"


def with_source(name="gearbox.toml", **changes) -> gp.Model:
    """A model of the folder models/ with the tones above."""
    source = {
        "speed": SPEED,
        "teeth": TEETH,
        "harmonics": [dict(zip(("order", "amplitude", "phase"), tone)) for tone in HARMONICS],
        "sidebands": [dict(zip(("harmonic", "order", "amplitude", "phase"), tone)) for tone in SIDEBANDS],
    }
    return gp.load(MODELS / name).replace({"source": source | changes})


@dataclass(frozen=True)
class Tones:
    """The tones at a speed (rev/min)."""

    harmonic: np.ndarray
    shift: np.ndarray
    amplitude: np.ndarray
    phase: np.ndarray
    teeth: float = TEETH

    @property
    def order(self) -> np.ndarray:
        return self.harmonic * self.teeth + self.shift

    def omega(self, speed: float) -> np.ndarray:
        return self.order * 2 * np.pi * speed / 60

    def at(self, angle) -> np.ndarray:
        """e at some angles (rad)."""
        return np.cos(np.multiply.outer(angle, self.order) + self.phase) @ self.amplitude

    def only(self, *wanted: int) -> "Tones":
        keep = np.isin(np.arange(len(self.amplitude)), wanted)
        return replace(self, amplitude=np.where(keep, self.amplitude, 0.0))


def tones() -> Tones:
    rows = [(h, 0.0, a, p) for h, a, p in HARMONICS] + list(SIDEBANDS)
    return Tones(*np.array(rows, float).T)


class Machine:
    """x' = A x + b e, y = C x + d e, with all linear outputs, and powers as products of them."""

    def __init__(self, model: gp.Model, load: str = OUT) -> None:
        system = gp.state_space(model)
        column = [name.replace("/", ".") for name in system.input_labels].index(load)
        self.A, self.C = np.asarray(system.A), np.asarray(system.C)
        self.b, self.d = np.asarray(system.B)[:, column], np.asarray(system.D)[:, column]
        self.linear = [name.replace("/", ".") for name in system.output_labels]
        self.powers = {
            f"{name}.power": [(f"{name}.force_{dof}", f"{name}.velocity_{dof}") for dof in joint.dofs]
            for name, joint in model.system.joints.items()
            if not joint.between[1].is_ground
        }
        self.names = [*self.linear, *self.powers]

    def outputs(self, x, e) -> np.ndarray:
        """All outputs, (times, names), of states (times, n) and errors (times,)."""
        y = np.asarray(x) @ self.C.T + np.multiply.outer(e, self.d)
        at = self.linear.index
        products = [sum(y[:, at(f)] * y[:, at(v)] for f, v in pairs) for pairs in self.powers.values()]
        return np.column_stack([y, *products])

    def steady(self, tones: Tones, speed: float, t) -> tuple[np.ndarray, np.ndarray]:
        """Particular solution sum Re((i w I - A)^-1 b a e^(i (w t + phi))) and e, at the times t."""
        omega, one = tones.omega(speed), np.eye(len(self.A))
        phasor = tones.amplitude * np.exp(1j * tones.phase)
        states = np.array([np.linalg.solve(1j * w * one - self.A, self.b * a) for w, a in zip(omega, phasor)])
        wave = np.exp(1j * np.multiply.outer(t, omega))
        return (wave @ states).real, (wave @ phasor).real

    def at_steady_speed(self, tones: Tones, speed: float, h: float, steps: int, start=0.0, first: int = 0):
        """States (steps + 1, n) and errors at the times first h, (first + 1) h, ... after rest or the state `start`."""
        t = h * np.arange(first, first + steps + 1)
        particular, e = self.steady(tones, speed, t)
        propagator, free = scipy.linalg.expm(self.A * h), np.empty_like(particular)
        free[0] = start - particular[0]
        for k in range(steps):
            free[k + 1] = propagator @ free[k]
        return free + particular, e

    def in_run_up(self, tones: Tones, start: float, rate: float, h: float, steps: int, nodes: int = 40):
        """The same where the speed is start + rate t: the integral of e^(A (h - s)) b e by quadrature in every step."""
        s, weight = np.polynomial.legendre.leggauss(nodes)
        s, weight = h * (s + 1) / 2, h * weight / 2
        gain = np.column_stack([scipy.linalg.expm(self.A * (h - at)) @ self.b * w for at, w in zip(s, weight)])
        t = h * np.arange(steps + 1)
        within = tones.at(run_up_angle(start, rate, t[:-1, None] + s))
        propagator, x = scipy.linalg.expm(self.A * h), np.zeros((steps + 1, len(self.A)))
        for k in range(steps):
            x[k + 1] = propagator @ x[k] + gain @ within[k]
        return x, tones.at(run_up_angle(start, rate, t))


def run_up_angle(start: float, rate: float, t):
    """The shaft's angle (rad) where the speed is start + rate t, rev/min."""
    return 2 * np.pi / 60 * (start * t + rate * t**2 / 2)


def deviation(found, expected, names: Sequence[str]) -> float:
    """Largest deviation of any output, relative to the largest value of that kind of output."""
    found, expected = np.asarray(found), np.asarray(expected)
    largest = abs(expected).max(axis=0)
    kind = [name.rsplit(".", 1)[1] for name in names]
    size = np.array([max(large for large, other in zip(largest, kind) if other == mine) for mine in kind])
    return float((abs(found - expected).max(axis=0) / np.where(size > 0, size, 1.0)).max())
