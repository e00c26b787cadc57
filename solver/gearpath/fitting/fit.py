"""The fit of real modes to measured mobilities."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from ..components.driving_points import complaint
from ..errors import InputError
from ..numerics.arrays import Complex, Real
from .complex_modes import complex_residual
from .diagnosis import check_data, is_positive_real, place_of
from .misfit import SYSTEMATIC, correlation, errors, largest_error
from .order import Told, grow
from .problem import Problem
from .quantity import as_mobility
from .record import DataCheck, ModalFit
from .refine import Trial

_FEWEST, _MOST = 8, 300  # lines, modes
_NOISY = 12.0  # deviation of single lines that noise explains, in parts of the root mean square


def fit_mobility(
    frequencies_hz: ArrayLike,
    frf: ArrayLike,
    *,
    quantity: str = "mobility",
    modes: int | None = None,
    tolerance: float = 1e-3,
    progress: Callable[[int, float], None] = lambda *_: None,
) -> ModalFit:
    """Real modes fitted to a square matrix of measured FRFs: passive, reciprocal, and no more modes than they need.

    Args:
        frequencies_hz: lines (F,), Hz, increasing; gaps may be left.
        frf: (F, m, m), response row and force column in the same order, SI units; (F,) for one channel.
        quantity: "accelerance", "mobility" or "receptance".
        modes: most second-order coordinates, residual terms included; None: as many as are worth it.
        tolerance: largest error aimed at, |fit - Y| relative to the FRF's own largest gain in the band. In noise the
            fit ends where a further mode would fit noise, and says so.
        progress: called as progress(modes, error) as modes are added; large data take many seconds.

    Modes are added where they take most from the misfit and all are refined together by nonlinear least squares
    (`order`, `pursuit`, `refine`). Notes say what the data are not, such as driving points that are not those of
    `quantity`. Raises InputError for data of another shape, not finite or without any response.
    """
    f, H = _checked(frequencies_hz, frf, modes, tolerance)
    omega = 2.0 * np.pi * f
    Y = as_mobility(omega, H, quantity)
    wrong = complaint(omega, Y, quantity, [f"channel {k}" for k in range(Y.shape[1])])
    fit = fit_modes(omega, Y, modes, tolerance, progress)
    return replace(fit, notes=(f"the data are given as {quantity}, but {wrong}", *fit.notes)) if wrong else fit


def fit_modes(
    omega: Real,
    mobility: Complex,
    modes: int | None,
    tolerance: float,
    progress: Told = lambda *_: None,
) -> ModalFit:
    """Real modes of a checked mobility (F, m, m) at increasing `omega` (rad/s); see `fit_mobility`."""
    data = check_data(omega, mobility)
    problem = Problem.of(omega, (mobility + mobility.swapaxes(1, 2)) / 2.0)
    most = min(_MOST, problem.stacked.size // (4 * (problem.channels + 2))) if modes is None else modes
    found = grow(problem, max(most, 1), tolerance, progress)
    trial = found.modes.picked(np.argsort(found.modes.frequency, kind="stable"))
    relative = errors(problem, found.residual)
    eigenvalues = (trial.frequency * problem.top) ** 2
    damping = np.where(eigenvalues > 0.0, trial.damping, 0.0)
    shapes = np.sqrt(problem.top) * problem.scale[:, None] * trial.shapes.T
    low, high = trial.frequency >= problem.x[0], trial.frequency <= 1.0
    related = correlation(problem, found.residual)
    return ModalFit(
        eigenvalues=eigenvalues,
        damping_ratios=damping,
        shapes=shapes,
        band=(float(omega[0] / (2.0 * np.pi)), float(omega[-1] / (2.0 * np.pi))),
        in_band=int(np.count_nonzero(low & high)),
        error=problem.unpacked(relative.max(axis=0)),
        rms=problem.unpacked(np.sqrt((relative**2).mean(axis=0))),
        worst=place_of(omega, problem.unpacked(relative)),
        correlation=related,
        passive=is_positive_real(eigenvalues, damping, shapes, omega),
        data=data,
        notes=_notes(problem, trial, found.residual, data, tolerance, modes, related),
    )


def _checked(frequencies_hz: ArrayLike, frf: ArrayLike, modes: int | None, tolerance: float) -> tuple[Real, Complex]:
    try:
        f, H = np.asarray(frequencies_hz, float), np.asarray(frf, complex)
    except (TypeError, ValueError) as error:
        raise InputError("fit_mobility: frequencies or FRFs are not numbers; give arrays") from error
    H = H[:, None, None] if H.ndim == 1 else H
    if f.ndim != 1 or H.ndim != 3 or H.shape != (len(f), H.shape[1], H.shape[1]) or not H.shape[1]:
        raise InputError(f"fit_mobility: shapes {f.shape} and {H.shape} do not fit; give (F,) and (F, m, m)")
    if len(f) < _FEWEST:
        raise InputError(f"fit_mobility: {len(f)} lines are too few for a fit; give at least {_FEWEST}")
    if not (np.isfinite(f).all() and f[0] > 0.0 and (np.diff(f) > 0.0).all()):
        raise InputError("fit_mobility: frequencies are not finite, positive and increasing; sort them, without 0 Hz")
    if not np.isfinite(H).all():
        raise InputError("fit_mobility: FRFs have entries that are not finite; leave such lines out")
    if not np.einsum("faa->fa", H).any():
        raise InputError("fit_mobility: no driving point responds; give the matrix of FRFs, force and response alike")
    dead = ~np.einsum("faa->fa", H).any(axis=0) & (H.any(axis=(0, 1)) | H.any(axis=(0, 2)))
    if dead.any():
        raise InputError(
            f"fit_mobility: channel {int(np.argmax(dead))} answers to others and not to its own force, as nothing "
            "passive does; measure its driving point"
        )
    if modes is not None and (isinstance(modes, bool) or not isinstance(modes, (int, np.integer)) or modes < 1):
        raise InputError(f"fit_mobility: {modes!r} is not a number of modes; give a whole number from 1 up")
    if not (isinstance(tolerance, (int, float, np.floating)) and 0.0 < tolerance < 1.0):
        raise InputError(f"fit_mobility: tolerance {tolerance!r} is not allowed; give a number above 0 and below 1")
    return f, H


def _notes(
    problem: Problem,
    modes: Trial,
    residual: Real,
    data: DataCheck,
    tolerance: float,
    most: int | None,
    related: float,
) -> tuple[str, ...]:
    notes = []
    worst, rms = largest_error(problem, residual), float(np.sqrt((errors(problem, residual) ** 2).mean()))
    if worst > tolerance:
        if related <= SYSTEMATIC:
            notes.append(f"the misfit is noise ({rms:.2g} of each FRF's largest gain); more modes would fit noise")
        else:
            notes.append(_shortfall(problem, modes, worst, tolerance, most))
    noise = max(tolerance, _NOISY * rms * math.sqrt(max(1.0 - related, 0.0)))  # what goes on from line to line is none
    if data.skew.value > noise:
        notes.append(f"the data are not reciprocal by {data.skew}; the fit and the network take the mean")
    if data.resistance < -noise * np.sqrt(problem.channels):
        notes.append(
            f"the data are not passive: they give off power at {data.resistance_frequency:.5g} Hz "
            f"(resistance {data.resistance:.2g} of the driving points' largest gains); the fit is passive"
        )
    return tuple(notes)


def _shortfall(problem: Problem, modes: Trial, worst: float, tolerance: float, most: int | None) -> str:
    """Why the fit stopped above its tolerance."""
    bent = largest_error(problem, complex_residual(problem, modes))
    if bent < worst / 2.0:
        return (
            f"the misfit is more than noise: complex modes at these poles would leave {bent:.2g} in place of "
            f"{worst:.2g}; their damping couples modes, which the time twin cannot hold"
        )
    if most is not None and len(modes) >= most:
        return f"{most} modes leave more than the tolerance, {tolerance:g}; allow more"
    return "the misfit is more than noise, and no further real mode lessens it by what it costs"
