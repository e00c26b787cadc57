"""Joints stiffer than their neighbours: how far the mobilities are from linear in an error of K and C.

A change d of the joints' impedance changes the assembly's mobilities by exactly

    Y(Z + d) - Y(Z) = -(Y B^T) (d - d G d + ...) (B Y) = -(Y B^T) d (I + G d)^-1 (B Y),   G = B Y B^T,   B = [I, -I]

G is the relative mobility over the joints, Y_aa - Y_ab - Y_ba + Y_bb. Over a soft joint G d is small for any error that
noise leaves. Over a joint much stiffer than its neighbours G is 1/Z, the measurement is linear in 1/Z, and where
an error of one standard deviation has |G d| = b, K lies between K / (1 + 1.96 b) and K / (1 - 1.96 b) with 95 %
probability (Fieller 1954): without an upper end where b > 0.51. That is exact for one degree of freedom. A full matrix
leaves the linear range sooner, for a small error in one direction stiffens or softens the others; by trial, 4 b does.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from ..errors import AccuracyError
from ..numerics.arrays import Complex, Real
from .measurement import Measurement
from .parameters import Unknowns
from .record import NORMAL_95

_SEVERAL = 4.0  # times the bend, for joints of several degrees of freedom
_SURE = 3.0  # standard deviations of the noise power: more relative motion than that is motion


def bend(pieces: Iterable[tuple[Real, Complex, Complex]], unknowns: Unknowns, size: Real, moves: Real) -> Real:
    """|d G d| / |d| of moves d, the columns of `moves` (q, k), as (k,): mean square over lines by what each tells of d.

    pieces: omega (F,), Y (F, N, N) and whitened slopes A (F, e, q) of some lines; size (N,): `Measurement.size`.
    """
    n, m = unknowns.size, len(unknowns.rows)
    scale = np.outer(np.sqrt(size[:n] * size[n:]), np.sqrt(size[:n] * size[n:]))
    stiff, drag = (np.einsum("qk,qab->kab", part, unknowns.basis() * scale) for part in (moves[:m], moves[m:]))
    total, share = np.zeros(moves.shape[1]), np.zeros(moves.shape[1])
    for omega, Y, A in pieces:
        told = (np.abs(A @ moves) ** 2).sum(axis=1)
        d = stiff / (1j * omega)[:, None, None, None] + drag
        length = (np.abs(d) ** 2).sum(axis=(2, 3))
        further = (np.abs(d @ (_relative(Y) / scale)[:, None] @ d) ** 2).sum(axis=(2, 3))
        total += told.sum(axis=0)
        share += (told * np.divide(further, length, out=np.zeros_like(length), where=length > 0.0)).sum(axis=0)
    return np.asarray(np.sqrt(np.divide(share, total, out=np.zeros_like(share), where=total > 0.0)))


def widening(unknowns: Unknowns, bent: Real) -> Real:
    """(2 m,): what standard errors of that `bend` are multiplied by; infinite where an interval has no end."""
    several = np.array([len(dofs) > 1 for dofs in unknowns.joints.values() for _ in dofs])[unknowns.rows]
    room = 1.0 - NORMAL_95 * bent * np.tile(np.where(several, _SEVERAL, 1.0), 2)
    return np.asarray(np.divide(1.0, room, out=np.full(len(room), np.inf), where=room > 0.0))


def too_stiff(data: Measurement, unknowns: Unknowns, noise: float) -> NDArray[np.bool_]:
    """(n,): degrees of freedom whose two sides move alike within a relative noise, as far as its size is known."""
    n, N, Y = unknowns.size, 2 * unknowns.size, data.mobility
    s2 = (noise * data.unit_deviation(Y)) ** 2
    power = np.mean(np.abs(Y[:, :n] - Y[:, n:]) ** 2 / (s2[:, :n] + s2[:, n:]), axis=(0, 2))
    spread = np.sqrt((1.0 / N + 2.0 / (N * (N - 1))) / data.lines)  # of the power, and of a noise from Y_ij - Y_ji
    return np.asarray(power < 1.0 + _SURE * spread)


def check_deformed(data: Measurement, unknowns: Unknowns, noise: float) -> NDArray[np.bool_]:
    """`too_stiff`. Raises AccuracyError where all are."""
    stiff = too_stiff(data, unknowns, noise)
    if stiff.all():
        raise refusal(data, unknowns, stiff, noise)
    return stiff


def refusal(data: Measurement, unknowns: Unknowns, stiff: NDArray[np.bool_], noise: float) -> AccuracyError:
    """What to say of joints that are `too_stiff`."""
    names = [f"{joint}.{dof}" for joint, dofs in unknowns.joints.items() for dof in dofs]
    seen = ", ".join(name for name, it in zip(names, stiff) if it)
    return AccuracyError(
        f"identification: joint too stiff for its neighbours at this noise: both sides of {seen} move alike within "
        f"{noise:.2g} of {'each FRF' if data.deviation is None else 'the given deviations'}; measure with less noise, "
        "on more lines, or where the neighbours give way less than the joint"
    )


def _relative(Y: Complex) -> Complex:
    n = Y.shape[1] // 2
    return np.asarray(Y[:, :n, :n] - Y[:, :n, n:] - Y[:, n:, :n] + Y[:, n:, n:])
