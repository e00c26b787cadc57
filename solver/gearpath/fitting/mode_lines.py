"""Mobility of single modes on scaled lines, and how it changes with their frequencies and damping ratios.

b(x) = i x / D,    D = x_r^2 - x^2 + 2 i zeta_r x_r x                     x_r = 0 is a rigid-body mode
db / d ln x_r   = -i x (2 x_r^2 + 2 i zeta_r x_r x) / D^2
db / d ln zeta_r = -i x (2 i zeta_r x_r x) / D^2
"""

import numpy as np

from ..numerics.arrays import Complex, Real


def mode_lines(x: Real, frequency: Real, damping: Real) -> Complex:
    """b of every mode, (N, F), of scaled frequencies and damping ratios (N,)."""
    return np.asarray(1j * x / _denominator(x, frequency, damping))


def mode_lines_and_slopes(x: Real, frequency: Real, damping: Real) -> Real:
    """b, db / d ln x_r and db / d ln zeta_r as real numbers, (3 N, 2 F): real parts before imaginary ones."""
    D = _denominator(x, frequency, damping)
    b = 1j * x / D
    drag = (2j * damping * frequency)[:, None] * x
    along = -b / D
    lines = np.vstack([b, along * (2.0 * frequency[:, None] ** 2 + drag), along * drag])
    return np.hstack([lines.real, lines.imag])


def _denominator(x: Real, frequency: Real, damping: Real) -> Complex:
    return np.asarray(frequency[:, None] ** 2 - x**2 + (2j * damping * frequency)[:, None] * x)
