"""Starting values: the condition with the source side held, by least squares over all lines."""

from __future__ import annotations

import numpy as np

from ..numerics.arrays import Real
from .measurement import Measurement
from .parameters import Unknowns

_SINGULAR = 1e-10  # of the largest: what counts as a source that cannot move so


def starting_values(data: Measurement, unknowns: Unknowns, scale: Real) -> Real:
    """K and C from Y_aa Z S = Y_ab with S = Y_bb - Y_ba Y_aa^+ Y_ab, the receiver's mobility while v_a = 0.

    Exact without noise. With noise it is biased, because S is as noisy as Y_ab.
    """
    n = unknowns.size
    Y = data.mobility / np.outer(np.tile(scale, 2), np.tile(scale, 2))
    Y_aa, Y_ab, Y_ba, Y_bb = Y[:, :n, :n], Y[:, :n, n:], Y[:, n:, :n], Y[:, n:, n:]
    held = Y_bb - Y_ba @ (np.linalg.pinv(Y_aa, rcond=_SINGULAR) @ Y_ab)
    basis = unknowns.basis() * np.outer(scale, scale)
    weight = 1.0 / np.linalg.norm(Y_ab, axis=(1, 2))
    left = np.einsum("fka,qab,fbl,f->fklq", Y_aa, basis, held, weight, optimize=True)
    left = left.reshape(data.lines, n * n, -1)
    both = np.concatenate([left / (1j * data.omega)[:, None, None], left], axis=2).reshape(-1, unknowns.count)
    right = (Y_ab * weight[:, None, None]).ravel()
    A, b = np.concatenate([both.real, both.imag]), np.concatenate([right.real, right.imag])
    size = np.linalg.norm(A, axis=0)
    size[size == 0.0] = 1.0
    return np.asarray(np.linalg.lstsq(A / size, b, rcond=None)[0] / size)
