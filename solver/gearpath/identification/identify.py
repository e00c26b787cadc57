"""Joints from the mobilities of the assembled machine on both their sides: checks, fit, and what it is worth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import gammaincc

from ..errors import AccuracyError, InputError
from ..numerics.arrays import Real
from .bend import check_deformed, widening
from .checks import check_mobilities, checked_joints, checked_lines, checked_matrix, checked_noise
from .fit import Estimate, fit
from .known import fit_known
from .measurement import Measurement
from .parameters import Unknowns
from .passive import nearest_passive
from .record import CrossTalk, IdentifiedJoint, JointIdentification
from .start import starting_values, stiff_values

_MISFIT = 1.3  # times the known noise: more is not noise
_UNLIKELY = 1e-3
_VISIBLE = 1e-6  # of the joints' own stiffness: less between them is rounding


def identify(
    frequencies_hz: ArrayLike,
    mobility: ArrayLike,
    joints: Mapping[str, Sequence[str]],
    noise: object = None,
    without: ArrayLike | None = None,
) -> JointIdentification:
    """K and C of all joints between two parts, from mobilities (F, 2 n, 2 n); see `gearpath.identify_joint`."""
    unknowns = Unknowns.of(checked_joints(joints))
    omega = checked_lines(frequencies_hz)
    F, n = len(omega), unknowns.size
    Y = checked_matrix("mobility", mobility, F, 2 * n)
    check_mobilities(Y, port_names(unknowns.joints))
    if unknowns.least_lines > F:
        raise InputError(
            f"frequencies: {F} lines are too few for {unknowns.count} unknown entries and the size of the noise; "
            f"measure at least {unknowns.least_lines}"
        )
    data = Measurement.of(omega, Y, checked_noise(noise, F, 2 * n))
    if data.known_noise is not None:
        check_deformed(data, unknowns, data.known_noise)
    if without is None:
        scale = np.sqrt(data.size[:n] * data.size[n:])
        found = _fit(data, unknowns, scale)
    else:
        found = fit_known(data, unknowns, checked_matrix("without", without, F, 2 * n))
    return _record(data, unknowns, found)


def _fit(data: Measurement, unknowns: Unknowns, scale: Real) -> Estimate:
    """From the usual starting values, or those for stiff joints where the first lead nowhere."""
    try:
        return fit(data, unknowns, starting_values(data, unknowns, scale), scale)
    except AccuracyError as error:
        try:
            return fit(data, unknowns, stiff_values(data, unknowns, scale), scale)
        except (AccuracyError, np.linalg.LinAlgError):
            raise error from None


def port_names(joints: Mapping[str, Sequence[str]]) -> tuple[str, ...]:
    """Names of rows and columns: bearing_1.source.uy ..., then bearing_1.receiver.uy ..."""
    return tuple(f"{name}.{side}.{dof}" for side in ("source", "receiver") for name, d in joints.items() for dof in d)


def _record(data: Measurement, unknowns: Unknowns, found: Estimate) -> JointIdentification:
    known = data.known_noise
    trusted = data.noise if data.deviation is None else 1.0
    noise = found.noise if trusted is None else max(trusted, found.noise)
    covariance = noise**2 * found.squares.covariance()
    lost = found.squares.lost()
    wider = widening(unknowns, noise * found.bend)
    stiff = check_deformed(data, unknowns, known or found.noise)
    rigid = np.tile(stiff[unknowns.rows] | stiff[unknowns.columns], 2)
    told = ~lost & ~rigid & np.isfinite(wider)
    error = np.full(len(wider), np.inf)
    error[told] = (wider * np.sqrt(np.diagonal(covariance)))[told]
    values, errors = unknowns.split(found.theta), unknowns.split(error)
    joints, start, m = {}, 0, len(unknowns.rows)
    for name, dofs in unknowns.joints.items():
        (K, C), (dK, dC) = values[name], errors[name]
        count = len(dofs) * (len(dofs) + 1) // 2
        matrices = []
        for matrix, at in ((K, slice(start, start + count)), (C, slice(m + start, m + start + count))):
            matrices.append(matrix if lost[at].any() else nearest_passive(matrix, covariance[at, at]))
        joints[name] = IdentifiedJoint(dofs, K, C, dK, dC, *matrices)
        start += count
    talk = _cross_talk(unknowns, found, found.noise if known is None else max(known, found.noise))
    used = np.setdiff1d(np.arange(data.lines), list(found.discarded))
    f = data.omega / (2.0 * np.pi)
    undetermined, unbounded = _entries(unknowns, lost), _entries(unknowns, ~lost & ~told)
    misfit = None if known is None else found.noise / known
    return JointIdentification(
        joints=joints,
        noise=found.noise,
        misfit=misfit,
        lines=len(used),
        discarded={float(f[k]): why for k, why in found.discarded.items()},
        band=(float(f[used].min()), float(f[used].max())),
        condition=found.squares.condition,
        undetermined=undetermined,
        cross_talk=talk,
        covariance=covariance,
        notes=tuple(_notes(joints, misfit, talk, undetermined, unbounded, len(found.discarded) / data.lines)),
    )


def _entries(unknowns: Unknowns, chosen: NDArray[np.bool_]) -> tuple[str, ...]:
    """Names of some of the unknowns, in their order."""
    names = []
    for what in ("stiffness", "damping"):
        for joint, dofs in unknowns.joints.items():
            i, j = np.triu_indices(len(dofs))
            names += [f"{joint}.{what}[{a + 1},{b + 1}]" for a, b in zip(i, j)]
    return tuple(name for name, taken in zip(names, chosen) if taken)


def _cross_talk(unknowns: Unknowns, found: Estimate, noise: float) -> CrossTalk | None:
    """Stiffness between different joints: the likelihood ratio of the linearised equations with it and without."""
    _, rows, columns = unknowns.strangers()
    if not len(rows):
        return None
    K = np.zeros(unknowns.size)
    own = unknowns.rows == unknowns.columns
    K[unknowns.rows[own]] = np.abs(found.theta[: len(unknowns.rows)][own])
    with np.errstate(divide="ignore"):
        share = np.abs(found.strangers.solution()[unknowns.count :]) / np.sqrt(K[rows] * K[columns])
    worst = int(share.argmax())
    owner = [name for name, dofs in unknowns.joints.items() for _ in dofs]
    gain = 2.0 * (found.squares.left() - found.strangers.left()) / noise**2
    more = found.strangers.rank - found.squares.rank
    probability = float(gammaincc(more / 2.0, max(gain, 0.0) / 2.0)) if more else 1.0
    return CrossTalk(float(share[worst]), (owner[rows[worst]], owner[columns[worst]]), probability)


def _notes(
    joints: Mapping[str, IdentifiedJoint],
    misfit: float | None,
    talk: CrossTalk | None,
    undetermined: tuple[str, ...],
    unbounded: tuple[str, ...],
    discarded: float,
) -> list[str]:
    notes = []
    if undetermined:
        notes.append(
            f"{len(undetermined)} entries are not determined, for the two parts move in too few ways at these joints: "
            + ", ".join(undetermined)
        )
    strange = misfit is not None and misfit > _MISFIT
    if strange:
        notes.append(
            f"{misfit:.3g} times the known noise is left over: a connection beside these joints, nonlinearity, or "
            "joints that are not K and C"
        )
    if unbounded:
        why = "with so much left over" if strange else "joint too stiff for its neighbours at this noise:"
        notes.append(f"{why} the deformation is not seen well enough to bound {', '.join(unbounded)}")
    if talk is not None and talk.probability < _UNLIKELY and talk.value > _VISIBLE:
        notes.append(
            f"stiffness between {talk.pair[0]} and {talk.pair[1]}, {talk.value:.2g} of their own, would explain the "
            f"data better (probability {talk.probability:.1g} by chance): the measurement misses a connection"
        )
    if all(np.trace(joint.stiffness_interval()[1]) < 0.0 for joint in joints.values()):
        notes.append("all stiffness is negative: phasors must turn with e^(+i w t); conjugate those of e^(-i w t)")
    for name, joint in joints.items():
        for what, matrix, passive in (
            ("stiffness", joint.stiffness, joint.passive_stiffness),
            ("damping", joint.damping, joint.passive_damping),
        ):
            if passive is not matrix:
                notes.append(f"the {what} of {name} is not positive semidefinite as found; passive_{what} is")
    if discarded > 0.5:
        notes.append(f"{discarded:.0%} of the lines are discarded")
    return notes
