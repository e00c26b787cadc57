"""What measured mobilities are worth: reciprocity and passivity of the data, and passivity of a fit."""

import numpy as np

from ..numerics.arrays import Complex, Real
from .problem import gains
from .record import DataCheck, Place

_ROUNDING = 1e-12  # of the largest eigenvalue: a negative one below this is rounding
_WIDTHS = np.linspace(-3.0, 3.0, 13)  # lines at a resonance, in parts of its half-power width


def check_data(omega: Real, mobility: Complex) -> DataCheck:
    """Reciprocity and passivity of mobilities (F, m, m) as they were measured."""
    gain = gains(mobility)
    larger = np.maximum(gain, gain.T)
    skew = abs(mobility - mobility.swapaxes(1, 2)) / np.where(larger > 0.0, larger, 1.0)
    scale = np.sqrt(np.diag(gain))
    lowest = _resistance(mobility, np.where(scale > 0.0, scale, 1.0))[:, 0]
    line = int(np.argmin(lowest))
    return DataCheck(place_of(omega, skew), float(lowest[line]), float(omega[line] / (2.0 * np.pi)))


def place_of(omega: Real, values: Real) -> Place:
    """The largest of values (F, m, m), and where it is."""
    line, a, b = (int(k) for k in np.unravel_index(np.argmax(values), values.shape))
    return Place(float(values[line, a, b]), float(omega[line] / (2.0 * np.pi)), (a, b))


def is_positive_real(eigenvalues: Real, damping: Real, shapes: Real, omega: Real) -> bool:
    """Whether modes are passive: by their signs, and by the eigenvalues of Re(Y) around every resonance and far off.

    Y (F, m, m) is summed up here again from the modes (N,), shapes (m, N); `omega` are lines of interest (rad/s).
    """
    if not ((eigenvalues >= 0.0).all() and (damping >= 0.0).all() and np.isfinite(shapes).all()):
        return False
    w_r = np.sqrt(eigenvalues)
    near = (w_r[:, None] * (1.0 + damping[:, None] * _WIDTHS)).ravel()
    far = np.geomspace(omega.min() / 100.0, 100.0 * max(omega.max(), w_r.max(initial=0.0)), 500)
    w = np.unique(np.concatenate([near[near > 0.0], far, omega]))
    scale = np.sqrt((shapes**2).sum(axis=1))
    unit = shapes / np.where(scale > 0.0, scale, 1.0)[:, None]
    drag = 2.0 * damping * w_r
    for part in np.array_split(w, max(len(w) // 500, 1)):
        square = part[:, None] ** 2
        real = square * drag / ((eigenvalues - square) ** 2 + square * drag**2)  # Re b, (F, N)
        values = np.linalg.eigvalsh(np.einsum("ar,fr,br->fab", unit, real, unit, optimize=True))
        if (values[:, 0] < -_ROUNDING * values[:, -1]).any():
            return False
    return True


def _resistance(mobility: Complex, scale: Real) -> Real:
    """Eigenvalues (F, m) of the Hermitian part of the scaled mobility, which is that of dissipation."""
    scaled = mobility / scale / scale[:, None]
    return np.asarray(np.linalg.eigvalsh((scaled + scaled.conj().swapaxes(1, 2)) / 2.0))
