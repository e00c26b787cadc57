"""Starting values: the condition with the source side held, by least squares over all lines.

With S = Y_bb - Y_ba Y_aa^+ Y_ab, the receiver's mobility while v_a = 0, it says Y_aa Z S = Y_ab, and
Z^-1 Y_aa^+ Y_ab = S.
"""

from __future__ import annotations

import numpy as np

from ..numerics.arrays import Complex, Real
from .measurement import Measurement
from .parameters import Unknowns

_SINGULAR = 1e-10  # of the largest: what counts as a source that cannot move so


def starting_values(data: Measurement, unknowns: Unknowns, scale: Real) -> Real:
    """K and C from Y_aa Z S = Y_ab. Exact without noise; with it too soft, because S is as noisy as Y_ab."""
    n = unknowns.size
    Y_aa, Y_ab, _, held = _held(data, n, scale)
    basis = unknowns.basis() * np.outer(scale, scale)
    weight = 1.0 / np.linalg.norm(Y_ab, axis=(1, 2))
    left = np.einsum("fka,qab,fbl,f->fklq", Y_aa, basis, held, weight, optimize=True)
    left = left.reshape(data.lines, n * n, -1)
    both = np.concatenate([left / (1j * data.omega)[:, None, None], left], axis=2).reshape(-1, unknowns.count)
    right = (Y_ab * weight[:, None, None]).ravel()
    A, b = np.concatenate([both.real, both.imag]), np.concatenate([right.real, right.imag])
    return _least_squares(A, b)


def stiff_values(data: Measurement, unknowns: Unknowns, scale: Real) -> Real:
    """K and C from Z^-1 Y_aa^+ Y_ab = S with Z^-1 = i w F + w^2 F C F, F = K^-1: for stiff joints, where S is small.

    Raises LinAlgError where F is singular.
    """
    n, m = unknowns.size, len(unknowns.rows)
    _, Y_ab, lever, held = _held(data, n, scale)
    weight = 1.0 / np.linalg.norm(Y_ab, axis=(1, 2))
    left = np.einsum("qab,fbl,f->falq", unknowns.basis(), lever, weight, optimize=True).reshape(data.lines, n * n, m)
    w = data.omega[:, None, None]
    both = np.concatenate([1j * w * left, w**2 * left], axis=2).reshape(-1, unknowns.count)
    right = (held * weight[:, None, None]).ravel()
    found = _least_squares(np.concatenate([both.real, both.imag]), np.concatenate([right.real, right.imag]))
    flexibility, loss = (np.einsum("q,qab->ab", part, unknowns.basis()) for part in (found[:m], found[m:]))
    K = np.linalg.inv(flexibility)
    at = (unknowns.rows, unknowns.columns)
    unit = np.outer(scale, scale)[at]
    return np.concatenate([K[at] / unit, (K @ loss @ K)[at] / unit])


def _held(data: Measurement, n: int, scale: Real) -> tuple[Complex, Complex, Complex, Complex]:
    """Y_aa, Y_ab, Y_aa^+ Y_ab and S, each (F, n, n), scaled."""
    Y = data.mobility / np.outer(np.tile(scale, 2), np.tile(scale, 2))
    Y_aa, Y_ab, Y_ba, Y_bb = Y[:, :n, :n], Y[:, :n, n:], Y[:, n:, :n], Y[:, n:, n:]
    lever: Complex = np.asarray(np.linalg.pinv(Y_aa, rcond=_SINGULAR) @ Y_ab, complex)
    return Y_aa, Y_ab, lever, np.asarray(Y_bb - Y_ba @ lever)


def _least_squares(A: Real, b: Real) -> Real:
    size = np.linalg.norm(A, axis=0)
    size[size == 0.0] = 1.0
    return np.asarray(np.linalg.lstsq(A / size, b, rcond=None)[0] / size)
