"""Whether measured mobilities can be used at all, said in one sentence where they cannot."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from ..errors import InputError
from ..numerics.arrays import Complex, Real

_NEGATIVE = 0.5  # Re(Y_ii) below so much of -|Y_ii|: not noise
_OFTEN = 0.05  # of all driving-point values, when they are no mobilities
_SKEW = 0.3  # relative difference of Y_ij and Y_ji, above which they are not the same quantity


def checked_lines(frequencies_hz: ArrayLike) -> Real:
    """Frequencies as angular frequencies (F,), rad/s. Raises InputError unless finite, positive and different."""
    try:
        f = np.asarray(frequencies_hz, dtype=float)
    except (TypeError, ValueError) as error:
        raise InputError(f"frequencies: {frequencies_hz!r} are not numbers; give them in Hz") from error
    if f.ndim != 1 or not f.size or not (np.isfinite(f) & (f > 0.0)).all():
        raise InputError("frequencies: give a list of finite, positive frequencies in Hz, one for each line")
    if len(np.unique(f)) != len(f):
        raise InputError("frequencies: a frequency occurs twice; average its lines first")
    return 2.0 * np.pi * f


def checked_joints(joints: Mapping[str, Sequence[str]]) -> dict[str, tuple[str, ...]]:
    """Degrees of freedom by joint. Raises InputError where there are none, or one occurs twice."""
    out = {name: (dofs,) if isinstance(dofs, str) else tuple(dofs) for name, dofs in joints.items()}
    if not out or not all(out.values()):
        raise InputError("joints: give every joint with its degrees of freedom, as {'bearing_1': ('uy', 'rx')}")
    for name, dofs in out.items():
        if len(set(dofs)) != len(dofs):
            raise InputError(f"joints: {name} has a degree of freedom twice in {dofs}; name each once")
    return out


def checked_matrix(what: str, mobility: ArrayLike, lines: int, size: int) -> Complex:
    """Mobilities (F, N, N). Raises InputError for another shape, and for numbers that are not finite."""
    try:
        Y = np.asarray(mobility, dtype=complex)
    except (TypeError, ValueError) as error:
        raise InputError(f"{what}: not an array of complex numbers; give ({lines}, {size}, {size})") from error
    if Y.shape != (lines, size, size):
        raise InputError(
            f"{what}: shape {Y.shape} does not fit {lines} frequencies and {size // 2} degrees of freedom on 2 sides; "
            f"give ({lines}, {size}, {size}), the source sides of all joints first, then the receiver sides"
        )
    wrong = np.argwhere(~np.isfinite(Y))
    if len(wrong):
        k, i, j = wrong[0]
        raise InputError(f"{what}: entry ({i}, {j}) of line {k} is {Y[k, i, j]}; leave out lines without a value")
    return Y


def check_mobilities(Y: Complex, ports: Sequence[str]) -> None:
    """Raises InputError where driving points stand still or cannot be mobilities, or reciprocity fails."""
    own = np.einsum("fii->fi", Y)
    for k, name in enumerate(ports):
        if not own[:, k].all():
            raise InputError(
                f"mobility: {name} does not move under its own force; a joint to the ground cannot be told from its "
                "source, and a free degree of freedom has no mobility: leave the joint out"
            )
    negative = own.real < -_NEGATIVE * np.abs(own)
    if negative.mean() > _OFTEN:
        if own.imag.min() >= -_NEGATIVE * np.abs(own).max():
            likely = "they look like accelerances: divide by i w"
        elif own.imag.max() <= _NEGATIVE * np.abs(own).max():
            likely = "they look like receptances: multiply by i w"
        else:
            likely = "check the directions of forces and motions and the order of rows and columns"
        raise InputError(
            f"mobility: the real part of {negative.mean():.0%} of the driving-point values is negative, which no "
            f"passive machine's mobility has (velocity by force, e^(+i w t)); {likely}"
        )
    i, j = np.triu_indices(Y.shape[1], 1)
    size = np.sqrt(np.abs(own[:, i] * own[:, j]))
    apart = np.abs(Y[:, i, j] - Y[:, j, i]) / size
    worst = np.median(apart, axis=0)
    if worst.max() > _SKEW:
        a, b = ports[i[worst.argmax()]], ports[j[worst.argmax()]]
        raise InputError(
            f"mobility: {a} under {b} and {b} under {a} differ by {worst.max():.0%} of their driving points, but are "
            "equal by reciprocity; check signs, units and the order of rows and columns"
        )


def checked_noise(noise: object, lines: int, size: int) -> float | Real | None:
    """Relative noise, or standard deviations (F, N, N). Raises InputError unless finite and positive."""
    if noise is None:
        return None
    try:
        value = np.asarray(noise, dtype=float)
    except (TypeError, ValueError) as error:
        raise InputError(f"noise: {noise!r} is not a number; give 0.01 for 1 % of each FRF") from error
    if value.shape not in ((), (size, size), (lines, size, size)):
        raise InputError(f"noise: shape {value.shape} is neither a number nor ({lines}, {size}, {size})")
    if not (np.isfinite(value) & (value > 0.0)).all():
        raise InputError("noise: give positive, finite deviations, or leave it out to have the noise found")
    return float(value) if value.shape == () else np.broadcast_to(value, (lines, size, size))
