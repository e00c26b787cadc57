"""Maximum likelihood K and C: the mobilities adjusted least, in parts of their noise, so that the condition holds.

    minimise sum_(i<=j) |Y_ij - Y0_ij|^2 / s_ij^2   over Y and theta   subject to   m(Y, theta) = 0

By Gauss-Helmert steps: with w = m + a (Y0 - Y) V of covariance S, theta + dtheta is the least squares solution of
L^-1 (w + A dtheta) = 0, S = L L^H, and Y = Y0 - s^2 a^H S^-1 (w + A dtheta) V^H. That m, a and V are taken at the
adjusted Y and not at the noisy one is what makes the estimate nearly unbiased.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..errors import AccuracyError
from ..numerics.arrays import Complex, Real
from ..numerics.lines import chunks
from .bend import bend, refusal, too_stiff
from .condition import Linearised, linearise
from .measurement import Measurement
from .parameters import Unknowns
from .squares import Squares

UNSTEADY = 0.25  # largest unsteadiness of a line that is used
_ASTRAY = 4.0  # of the median line's: a larger adjustment shows a line that noise has led elsewhere
_FIRST = 8  # steps about the noisy mobilities, while the lines are chosen
_STEPS = 60
SETTLED = 1e-3  # step in standard errors
ROUNDING = 1e-10  # step in parts of the unknowns, where only rounding is left


@dataclass(frozen=True)
class Estimate:
    """The unknowns, and what the lines say of them."""

    theta: Real
    squares: Squares  # for mobilities of relative noise 1, or of the known deviations
    noise: float  # that is left, relative; in parts of the deviations where those are known
    discarded: dict[int, str]  # line -> why it is not used
    bend: Real  # (q,): |G d| of the error d of every unknown for noise 1, see bend.py
    strangers: Squares  # the same equations with stiffness between different joints as further unknowns


class _Lines:
    """The condition on some lines about adjusted mobilities."""

    def __init__(self, data: Measurement, unknowns: Unknowns, scale: Real) -> None:
        self.data, self.unknowns, self.scale, self.Y = data, unknowns, scale, data.mobility

    def near(self, theta: Real) -> Iterator[tuple[slice, Linearised]]:
        """The linearised condition in pieces of bounded memory."""
        n = self.unknowns.size
        for part in chunks(self.data.lines, 16 * n**2 * (6 * n**2 + 4 * self.unknowns.count)):
            yield part, linearise(self.Y[part], self.unknowns.impedance(theta, self.data.omega[part]), self.scale)

    def unsteadiness(self, theta: Real, noise: float) -> Real:
        """Of every line, (F,)."""
        return np.concatenate(
            [at.unsteadiness(noise * self.data.on(part).unit_deviation(self.Y[part])) for part, at in self.near(theta)]
        )

    def squares(self, theta: Real, strangers: Real | None = None) -> Squares:
        """The condition as least squares for the step of theta, with stiffness in strange entries if asked."""
        pieces = self._whitened(theta, strangers)
        return Squares.of((A.reshape(-1, A.shape[2]), w.ravel()) for _, _, _, w, A, _ in pieces)

    def step(self, theta: Real) -> tuple[Squares, Real, Complex]:
        """Least squares, its solution, and the mobilities that go with it."""
        blocks, kept = [], []
        for part, at, s, w, A, L in self._whitened(theta, None):
            blocks.append((A.reshape(-1, A.shape[2]), w.ravel()))
            both = np.concatenate([w[:, :, None], A], axis=2)
            kept.append((part, at, s, np.linalg.solve(L.conj().swapaxes(1, 2), both)))  # S^-1 [w A]
        squares = Squares.of(blocks)
        change, Y = squares.solution(), self.Y.copy()
        for part, at, s, dual in kept:
            Y[part] = self.data.mobility[part] - at.back(dual @ np.append(1.0, change), s)
        return squares, change, Y

    def bend(self, theta: Real, moves: Real) -> Real:
        """Of moves of theta, the columns of (q, k), as (k,)."""
        pieces = ((self.data.omega[part], self.Y[part], A) for part, *_, A, _ in self._whitened(theta, None))
        return bend(pieces, self.unknowns, self.data.size, moves)

    def _whitened(
        self, theta: Real, strangers: Real | None
    ) -> Iterator[tuple[slice, Linearised, Real, Complex, Complex, Complex]]:
        """Of each piece: the lines, the condition, s, L^-1 w, L^-1 A and L."""
        for part, at in self.near(theta):
            Y, Y0, iw = self.Y[part], self.data.mobility[part], 1j * self.data.omega[part, None, None]
            s = self.data.on(part).unit_deviation(Y)
            w = at.value.reshape(len(Y), -1) + at.of_mobility(Y0 - Y)
            A = at.of_impedance(self.unknowns.basis())
            columns = [w[:, :, None], A / iw, A]
            if strangers is not None:
                columns.append(at.of_impedance(strangers) / iw)
            try:
                L: Complex = np.asarray(np.linalg.cholesky(at.covariance(s)), complex)
            except np.linalg.LinAlgError as error:
                raise unsettled(self.data, self.unknowns, self.data.first_noise) from error
            x: Complex = np.asarray(np.linalg.solve(L, np.concatenate(columns, axis=2)), complex)
            yield part, at, s, x[:, :, 0], x[:, :, 1:], L


def fit(data: Measurement, unknowns: Unknowns, theta: Real, scale: Real) -> Estimate:
    """From starting values to the estimate.

    Raises AccuracyError where noise leaves too few lines, or the steps do not settle.
    """
    theta, discarded = _choose(data, unknowns, theta, scale)
    used = np.setdiff1d(np.arange(data.lines), list(discarded))
    lines = _Lines(data.on(used), unknowns, scale)
    for count in range(_STEPS):
        if len(used) < unknowns.least_lines:
            raise AccuracyError(
                f"identification: noise hides the joints on {len(discarded)} of {data.lines} lines, or they are too "
                "stiff for their neighbours at this noise; measure with less noise, or more lines away from the "
                "machine's resonances"
            )
        squares, change, Y = lines.step(theta)
        theta = theta + change
        moved = np.sqrt((np.abs(Y - lines.data.mobility) ** 2 / lines.data.unit_deviation(Y) ** 2).mean(axis=(1, 2)))
        astray = moved > _ASTRAY * max(float(np.median(moved)), ROUNDING)
        if count and astray.any():
            discarded |= dict.fromkeys(used[astray].tolist(), "its mobilities were adjusted to something else")
            used = used[~astray]
            lines = _Lines(data.on(used), unknowns, scale)
            continue
        lines.Y = Y
        error = squares.noise() * np.sqrt(np.diagonal(squares.covariance()))
        if count and ((np.abs(change) <= SETTLED * error).all() or squares.small(change, theta, ROUNDING)):
            strangers = lines.squares(theta, unknowns.strangers()[0])
            bent = lines.bend(theta, squares.moves())
            return Estimate(theta, squares, squares.noise(), dict(sorted(discarded.items())), bent, strangers)
    raise unsettled(data, unknowns, squares.noise())


def _choose(data: Measurement, unknowns: Unknowns, theta: Real, scale: Real) -> tuple[Real, dict[int, str]]:
    """Better starting values about the noisy mobilities, and the lines that noise does not hide."""
    noise = data.first_noise
    every = _Lines(data, unknowns, scale)
    for _ in range(_FIRST):
        unsteady = every.unsteadiness(theta, noise)
        used = unsteady <= max(UNSTEADY, float(np.sort(unsteady)[(len(unsteady) - 1) // 4]))
        squares = _Lines(data.on(used), unknowns, scale).squares(theta)
        change = squares.solution()
        theta = theta + change
        noise = data.known_noise or squares.noise()
        error = noise * np.sqrt(np.diagonal(squares.covariance()))
        if (np.abs(change) <= 0.1 * error).all() or squares.small(change, theta, ROUNDING):
            break
    unsteady = every.unsteadiness(theta, noise)
    hidden = np.flatnonzero(unsteady > UNSTEADY)
    return theta, {int(k): f"hidden by noise ({unsteady[k]:.2g} > {UNSTEADY})" for k in hidden}


def unsettled(data: Measurement, unknowns: Unknowns, noise: float) -> AccuracyError:
    """Why steps may not settle: joints that do not visibly deform, or all that else makes the condition fail."""
    noise = data.known_noise or noise
    stiff = too_stiff(data, unknowns, noise)
    if stiff.any():
        return refusal(data, unknowns, stiff, noise)
    return AccuracyError(
        "identification: the steps did not settle; a joint between the two parts is missing from `joints`, rows and "
        "columns are not in the order of `joints` (all source sides, then all receiver sides), noise hides the joints "
        "or they are too stiff for their neighbours at this noise, or the two parts move in too few ways to tell these "
        "joints apart: measure with less noise or on more lines, or give `without`, the mobilities of the machine "
        "without the joints"
    )
