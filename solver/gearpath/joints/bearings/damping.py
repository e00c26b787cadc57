"""Damping of a bearing that goes with its stiffness."""

import numpy as np
from numpy.typing import ArrayLike

from ...errors import InputError
from ...numerics.arrays import Real
from .checks import finite, positive


def proportional_damping(stiffness: ArrayLike, time: float) -> Real:
    """C = t K, N s/m and so on, with the relaxation time t (s).

    No theory gives the time. Typical of rolling bearings are 1e-6 to 1e-5 s, and the default gearbox takes 1e-6 s;
    where damping matters, measure it.
    """
    finite(time=time)
    if time < 0:
        raise InputError(f"time: {time!r} s must not be negative")
    return time * np.asarray(stiffness, float)


def loss_factor_damping(stiffness: ArrayLike, loss_factor: float, frequency: float) -> Real:
    """C = eta K / w at the frequency (Hz): the dashpot that dissipates there what K (1 + i eta) does."""
    finite(loss_factor=loss_factor)
    if loss_factor < 0:
        raise InputError(f"loss_factor: {loss_factor!r} must not be negative")
    positive(frequency=frequency)
    return loss_factor / (2.0 * np.pi * frequency) * np.asarray(stiffness, float)
