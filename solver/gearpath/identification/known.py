"""K and C where the machine without the joints is known: fitted in the mobilities themselves.

    Y = Y_0 - Y_0 B^T (I + Z W)^-1 Z B Y_0,   W = B Y_0 B^T,   dY = -(Y B^T) dZ (B Y)

Y_0 (N, N) are the mobilities at the same ports without the joints, B = [I, -I]. Nothing else is unknown, so every
entry of Y is an equation, and ports that other joints connect may be left out.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..errors import AccuracyError
from ..numerics.arrays import Complex, Real
from ..numerics.lines import chunks
from .bend import bend
from .fit import ROUNDING, SETTLED, Estimate
from .measurement import Measurement
from .parameters import Unknowns
from .squares import Squares

_STEPS = 60


def fit_known(data: Measurement, unknowns: Unknowns, without: Complex) -> Estimate:
    """The estimate from mobilities `without` the joints, (F, N, N). Raises AccuracyError where steps do not settle."""
    theta, nothing = _start(data, unknowns, without), unknowns.basis()[:0]
    for _ in range(_STEPS):
        squares = _squares(data, unknowns, without, theta, nothing)
        change = squares.solution()
        theta = theta + change
        error = squares.noise() * np.sqrt(np.diagonal(squares.covariance()))
        if (np.abs(change) <= SETTLED * error).all() or squares.small(change, theta, ROUNDING):
            strangers = _squares(data, unknowns, without, theta, unknowns.strangers()[0])
            pieces = ((data.omega[p], Y, A) for p, Y, A, _ in _rows(data, unknowns, without, theta, nothing))
            bent = bend(pieces, unknowns, data.size, squares.moves())
            return Estimate(theta, squares, squares.noise(), {}, bent, strangers)
    raise AccuracyError(
        "identification: the steps did not settle; check that `without` are mobilities of this machine without the "
        "joints, at the same ports in the same order, and that no joint is too stiff for its neighbours at this noise"
    )


def coupled(without: Complex, Z: Complex) -> Complex:
    """Y (F, N, N) of the machine with joints of impedance Z (F, n, n)."""
    n = Z.shape[1]
    columns = without[:, :, :n] - without[:, :, n:]  # Y_0 B^T
    rows = without[:, :n] - without[:, n:]
    W = rows[:, :, :n] - rows[:, :, n:]
    return np.asarray(without - columns @ np.linalg.solve(np.eye(n) + Z @ W, Z @ rows))


def _start(data: Measurement, unknowns: Unknowns, without: Complex) -> Real:
    """Least squares of (Y_0 B^T) Z (B Y) = Y_0 - Y, linear in Z."""
    n, Y = unknowns.size, data.mobility
    s = data.unit_deviation(Y)[:, :, :, None]
    left = without[:, :, :n] - without[:, :, n:]
    A = np.einsum("fia,qab,fbj->fijq", left, unknowns.basis(), Y[:, :n] - Y[:, n:], optimize=True) / s
    A = np.concatenate([A / (1j * data.omega)[:, None, None, None], A], axis=3)
    b = (Y - without) / s[..., 0]
    return Squares.of([(A.reshape(-1, A.shape[3]), b.ravel())]).solution()


def _squares(data: Measurement, unknowns: Unknowns, without: Complex, theta: Real, strangers: Real) -> Squares:
    pieces = _rows(data, unknowns, without, theta, strangers)
    return Squares.of((A.reshape(-1, A.shape[2]), b.ravel()) for _, _, A, b in pieces)


def _rows(
    data: Measurement, unknowns: Unknowns, without: Complex, theta: Real, strangers: Real
) -> Iterator[tuple[slice, Complex, Complex, Complex]]:
    """Lines, Y, and slopes and rest of all entries i <= j, in parts of their deviations."""
    n = unknowns.size
    i, j = np.triu_indices(2 * n)
    basis = np.concatenate([unknowns.basis(), strangers])
    m = len(unknowns.rows)
    for part in chunks(data.lines, 32 * len(i) * (2 * m + len(basis))):
        omega = data.omega[part]
        Y = coupled(without[part], unknowns.impedance(theta, omega))
        s = data.on(part).unit_deviation(Y)[:, i, j]
        columns, rows = Y[:, :, :n] - Y[:, :, n:], Y[:, :n] - Y[:, n:]
        slope = -np.einsum("fia,qab,fbj->fijq", columns, basis, rows, optimize=True)[:, i, j] / s[:, :, None]
        elastic = slope / (1j * omega)[:, None, None]
        A = np.concatenate([elastic[:, :, :m], slope[:, :, :m], elastic[:, :, m:]], axis=2)
        yield part, Y, A, (Y - data.mobility[part])[:, i, j] / s
