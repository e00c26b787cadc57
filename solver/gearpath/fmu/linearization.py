"""A, B, C, D of any FMU with model exchange, as a python-control object."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InputError
from ..numerics.arrays import Real
from ..statespace.named import StateSpace
from ..statespace.signals import signal_name, signal_names, with_units
from .conformance.instance import CallError
from .linearizing.jacobian import Jacobian, by_derivatives, by_differences, disagreement
from .linearizing.opened import opened
from .linearizing.point import Point
from .linearizing.task import Task, task_of

_DISAGREE, _ROUGH = 1e-4, 1e-4


class Linearization(StateSpace):
    """x' = dx0 + A (x - x0) + B (u - u0), y = y0 + C (x - x0) + D (u - u0): an FMU near an operating point.

    As a `control.StateSpace` it relates the deviations from that point; units are as the FMU declares them, or "".
    `error` estimates the largest error of an entry, relative to the largest of its row, both times the nominal value of
    their column: of the differences, or how far the FMU's own derivatives and differences are apart.
    """

    method: str  # "derivatives" of the FMU, or "differences"
    time: float  # s
    x0: Real  # states, in the order of state_labels
    u0: Real
    y0: Real
    dx0: Real  # x' at the operating point; 0 at an equilibrium
    error: float
    warnings: tuple[str, ...]


def linearize(
    path: Path,
    *,
    inputs: str | Iterable[str] | None,
    outputs: str | Iterable[str] | None,
    start_values: Mapping[str, Any],
    states: Mapping[str, float],
    time: float | None,
    method: str,
    relative_step: float,
) -> Linearization:
    """The linearised FMU; see `gearpath.linearize`."""
    with opened(path) as unpacked:
        task = task_of(path, unpacked, inputs, outputs, start_values, states, time, method, relative_step)
        try:
            found = _linearized(task)
        except CallError as problem:
            raise InputError(f"{path}: {problem}; correct the values given, or the FMU") from problem
    for note in found.warnings:
        warnings.warn(f"{path}: {note}", stacklevel=3)
    return found


def _linearized(task: Task) -> Linearization:
    notes: list[str] = []
    if task.method != "differences":
        try:
            return _at_point(task, lambda point: _given(point, task.relative_step, notes), "derivatives", notes)
        except _RefusedError as problem:
            if task.method == "derivatives":
                raise CallError(str(problem)) from problem
            notes[:] = [f"the FMU refused its directional derivatives, differences take their place ({problem})"]
    return _at_point(task, lambda point: _differences(point, task.relative_step, notes), "differences", notes)


class _RefusedError(Exception):
    """The FMU does not give the derivatives that it declares."""


def _at_point(
    task: Task, differentiate: Callable[[Point], tuple[Jacobian, float]], method: str, notes: list[str]
) -> Linearization:
    point = task.reach()
    try:
        values = point.values()
        _check_finite(point, values)
        notes += _moved_states(point, task)
        jacobian, error = differentiate(point)
        return _made(task, point, values, jacobian, method, error, tuple(notes))
    finally:
        point.close()


def _given(point: Point, relative_step: float, notes: list[str]) -> tuple[Jacobian, float]:
    try:
        jacobian = by_derivatives(point)
    except CallError as problem:
        raise _RefusedError(str(problem)) from problem
    try:
        error = disagreement(point, jacobian, relative_step)
    except CallError:
        return jacobian, math.nan  # cannot be moved: nothing to compare with
    if error > _DISAGREE:
        notes.append(
            f"the FMU's directional derivatives and differences are {error:.1g} apart, relative to the largest of a "
            'row; compare with method="differences"'
        )
    return jacobian, error


def _differences(point: Point, relative_step: float, notes: list[str]) -> tuple[Jacobian, float]:
    jacobian = by_differences(point, relative_step)
    moved = abs(jacobian.matrix) * jacobian.scales
    largest = moved.max(axis=1, initial=0.0, keepdims=True)
    # a row of zeros may be what rounding left of it: its error is related to the value itself
    against = np.where(largest > 0.0, largest, abs(point.values())[:, None])
    relative = jacobian.error * jacobian.scales / np.where(against > 0.0, against, np.inf)
    error = float(relative.max(initial=0.0))
    if error > _ROUGH:
        row, column = np.unravel_index(int(relative.argmax()), relative.shape)
        knowns = [s.name for s in [*point.states, *point.inputs]]
        unknowns = [f"der({s.name})" for s in point.states] + [s.name for s in point.outputs]
        notes.append(
            f"the differences of {unknowns[row]} by {knowns[column]} do not converge (error about {error:.1g} of the "
            "largest of its row): the model may have a kink at the operating point"
        )
    return jacobian, error


def _check_finite(point: Point, values: Real) -> None:
    names = [f"the derivative of {s.name!r}" for s in point.states] + [f"{s.name!r}" for s in point.outputs]
    for name, value in zip(names, values):
        if not math.isfinite(value):
            raise CallError(f"{name} is {value:g} at the operating point")


def _moved_states(point: Point, task: Task) -> list[str]:
    """States that an event put elsewhere than they were given, where no time has passed."""
    if task.time > task.start:
        return []
    found = dict(zip((s.name for s in point.states), point.x))
    moved = [name for name, value in task.begin_states.items() if not math.isclose(found[name], value, rel_tol=1e-9)]
    return [f"an event moved the state {name!r} to {found[name]:g}" for name in moved]


def _made(
    task: Task, point: Point, values: Real, jacobian: Jacobian, method: str, error: float, notes: tuple[str, ...]
) -> Linearization:
    n, J = len(point.states), jacobian.matrix
    name = str(task.unpacked.fmu.root.get("modelName") or task.path.stem)
    labels = [signal_names([s.name for s in group]) for group in (point.inputs, point.outputs, point.states)]
    made = Linearization(
        J[:n, :n],
        J[:n, n:],
        J[n:, :n],
        J[n:, n:],
        inputs=labels[0],
        outputs=labels[1],
        states=labels[2],
        name=signal_name(name),
        remove_useless_states=False,
    )
    made.method, made.time, made.error, made.warnings = method, point.instance.time, error, notes
    made.x0, made.u0, made.y0, made.dx0 = point.x, point.u, values[n:], values[:n]
    about = f"Linearization of {name} at {point.instance.time:g} s, by {method}: deviations from x0, u0, y0."
    with_units(made, about, *([s.unit for s in group] for group in (point.inputs, point.outputs, point.states)))
    return made
