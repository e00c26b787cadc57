"""Jacobian of state derivatives and outputs by states and inputs: as the FMU gives it, or by differences."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...numerics.arrays import Real
from ..conformance.instance import CallError
from .point import Point
from .quotients import derivative


@dataclass(frozen=True)
class Jacobian:
    """matrix[i, k] = d unknown_i / d known_k: rows derivatives, then outputs; columns states, then inputs."""

    matrix: Real
    error: Real  # estimate, of every entry; 0 where the FMU gave it
    scales: Real  # of the columns: nominal or present value


def by_derivatives(point: Point) -> Jacobian:
    """One directional derivative for each state and input. Raises CallError where the FMU refuses.

    Outputs that are a state or an input under another name need no call, and some FMUs refuse it.
    """
    fmu, knowns, count = point.fmu, [*point.states, *point.inputs], len(point.states)
    same = {signal.variable.reference for signal in knowns}
    called = {s.variable.name: s.variable for s in point.outputs if s.variable.reference not in same}
    unknowns = [*point.rates, *called.values()]
    starts = dict(zip((v.name for v in unknowns), np.cumsum([0, *(fmu.size(v) or 1 for v in unknowns)])))
    matrix = np.zeros((count + len(point.outputs), len(knowns)))
    for k, known in enumerate(knowns):
        seed = np.zeros(fmu.size(known.variable) or 1)
        seed[known.element] = 1.0
        found = point.instance.directional(unknowns, known.variable, list(seed)) if unknowns else np.zeros(0)
        matrix[:count, k] = found[:count]
        for i, output in enumerate(point.outputs, count):
            if output.variable.reference in same:
                aliased = (output.variable.reference, output.element)
                matrix[i, k] = float(aliased == (known.variable.reference, known.element))
            else:
                matrix[i, k] = found[starts[output.variable.name] + output.element]
    if not np.isfinite(matrix).all():
        raise CallError("a directional derivative is not finite")
    return Jacobian(matrix, np.zeros_like(matrix), point.scales())


def by_differences(point: Point, relative_step: float) -> Jacobian:
    """Extrapolated differences of each state and input. Raises CallError where no step has finite values."""
    scales, values = point.scales(), point.values()
    matrix, error = np.zeros((len(values), len(scales))), np.zeros((len(values), len(scales)))
    for k, known in enumerate([*point.states, *point.inputs]):
        direction = np.zeros(len(scales))
        direction[k] = 1.0
        matrix[:, k], error[:, k] = _slope(point, direction, relative_step * scales[k], known.name)
    undeclared = ~declared(point)
    matrix[undeclared & (abs(matrix) <= 10.0 * error)] = 0.0  # rounding, where the FMU says that nothing depends
    return Jacobian(matrix, error, scales)


def disagreement(point: Point, given: Jacobian, relative_step: float) -> float:
    """Largest deviation of the FMU's derivatives from differences in one direction, relative to what moves each row.

    What the differences cannot resolve does not count.
    """
    scales = given.scales
    if not len(scales) or not len(given.matrix):
        return 0.0
    direction = scales * np.random.default_rng(7).choice([-1.0, 1.0], len(scales)) * _free(point, scales)
    found, error = _slope(point, direction, relative_step, "all of them together")
    moves = abs(given.matrix) @ abs(direction)
    apart = np.maximum(abs(found - given.matrix @ direction) - 10.0 * error, 0.0)
    return float((apart / np.maximum(np.maximum(moves, abs(found)), 1e-300)).max())


def declared(point: Point) -> np.ndarray[tuple[int, int], np.dtype[np.bool_]]:
    """Which entries may differ from 0 by the dependencies that the FMU declares; all where it declares none."""
    fmu, knowns = point.fmu, [*point.states, *point.inputs]
    lists = {e.key: e.dependencies for kind in ("Output", "Derivative") for e in fmu.listed(kind)}
    rows = [v for v in point.rates for _ in range(fmu.size(v) or 1)] + [s.variable for s in point.outputs]
    allowed = np.ones((len(rows), len(knowns)), bool)
    for i, variable in enumerate(rows):
        keys = lists.get(fmu.key(variable))
        if keys is not None:
            references = {v.reference for key in keys if (v := fmu.by_key.get(key)) is not None}
            allowed[i] = [known.variable.reference in references for known in knowns]
    return allowed


def _slope(point: Point, direction: Real, largest: float, name: str) -> tuple[Real, Real]:
    """Derivative along a direction of the knowns, and its error."""
    problems: list[CallError] = []

    def values(h: float) -> Real | None:
        try:
            point.put(point.known + h * direction)
            found = point.values()
        except CallError as problem:
            problems.append(problem)
            return None
        return found if np.isfinite(found).all() else None

    low, high = _room(point, direction)
    sides = ((low, high), (0.0, high), (low, 0.0))  # one side alone, where the other has no values
    found = next((f for a, b in sides if (f := derivative(values, largest, a, b)) is not None), None)
    if found is None:
        reason = str(problems[0]) if problems else "derivatives or outputs are not finite beside the operating point"
        raise CallError(f"no difference for {name}: {reason}")
    point.put(point.known)
    return found


def _room(point: Point, direction: Real) -> tuple[float, float]:
    """How far the declared minima and maxima let the knowns go along the direction."""
    low, high = -np.inf, np.inf
    for signal, value, part in zip([*point.states, *point.inputs], point.known, direction):
        least, most = signal.variable.number("min"), signal.variable.number("max")
        ends = [(least - value) if least is not None else -np.inf, (most - value) if most is not None else np.inf]
        if part != 0.0 and ends[0] <= 0.0 <= ends[1]:
            near, far = sorted(end / part for end in ends)
            low, high = max(low, near), min(high, far)
    return low, high


def _free(point: Point, scales: Real) -> Real:
    """0 for knowns that lie at a bound, which no direction may cross, and 1 for the others."""
    unit = np.eye(len(scales)) * scales
    return np.array([float(min(-low, high) > 0.01) for low, high in (_room(point, row) for row in unit)])
