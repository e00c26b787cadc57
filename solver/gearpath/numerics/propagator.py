"""Exact discretisation of x' = A x + B u for inputs that are held or vary linearly over a step."""

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from .arrays import Real


@dataclass(frozen=True)
class Propagator:
    """x(t + h) = Phi x(t) + held u(t) + ramp (u(t + h) - u(t)): no step-size error, stable where A is."""

    transition: Real  # Phi = exp(A h), (n, n)
    held: Real  # (n, m)
    ramp: Real  # (n, m)

    def step(self, x: Real, u: Real, change: Real) -> Real:
        """State after one step in which the inputs go from u to u + change."""
        return np.asarray(self.transition @ x + self.held @ u + self.ramp @ change)


def discretise(A: Real, B: Real, step: float) -> Propagator:
    """Propagator over `step` seconds, from the exponential of the augmented matrix (Van Loan 1978).

    exp([[A h, B h, 0], [0, 0, I], [0, 0, 0]]) = [[Phi, held, ramp], [0, I, I], [0, 0, I]]

    The inputs are taken in units that make B no larger than A: a transmission error in metres would otherwise have the
    exponential squared so often that it loses five digits.
    """
    n, m = B.shape
    sizes, largest = abs(B).sum(axis=0), abs(A).sum(axis=0).max(initial=0.0)
    ratio = np.divide(sizes, largest, out=np.ones(m), where=(sizes > 0) & (largest > 0))
    unit = np.exp2(-np.rint(np.log2(ratio)))  # powers of two round nothing
    augmented = np.zeros((n + 2 * m, n + 2 * m))
    augmented[:n, :n], augmented[:n, n : n + m] = A * step, B * unit * step
    augmented[n : n + m, n + m :] = np.eye(m)
    E = scipy.linalg.expm(augmented)
    return Propagator(E[:n, :n], E[:n, n : n + m] / unit, E[:n, n + m :] / unit)
