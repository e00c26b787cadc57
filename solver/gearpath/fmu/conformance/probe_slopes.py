"""Declared dependencies against what moves, and directional and adjoint derivatives against differences."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from .contents import Fmu, Variable, true
from .finding import Finding, error, warning
from .instance import CallError, Instance, Values
from .probe_point import Point, floats
from .probe_quotients import STEP, Slopes, quotients, ranges

DIRECTIONAL = error("directional-derivative", "Directional derivatives are those of the model.", "2.1.9", "2.2")
ADJOINT = error("adjoint-derivative", "Adjoint derivatives are the transposed directional ones.", None, "2.2")
UNDECLARED = error("dependency-undeclared", "What moves an unknown is among its dependencies.", "2.2.8", "2.4.8")
FEEDTHROUGH = warning(
    "dependency-feedthrough", "Outputs depend only on inputs that move them at once.", "2.2.8", "2.4.8"
)

_MOVED = 1e-9  # of the largest movement of an unknown: below is rounding


def check(fmu: Fmu, folder: Path, library: Path, interface: str) -> Iterator[Finding]:
    """At the start for initial unknowns, and in the middle of the simulation for outputs and derivatives."""
    place = f"{library.name} ({interface})"
    instance = Instance(fmu, folder, library, interface)
    instance.create()
    instance.enter_initialization()
    yield from _initial(instance, place)
    instance.leave_initialization()
    point = Point(instance, 3)
    kinds = ("Output", "Derivative") if interface == "ModelExchange" else ("Output",)
    entries = [e for kind in kinds for e in fmu.listed(kind)]
    unknowns = floats(fmu, [fmu.by_key.get(e.key) for e in entries if e.key is not None])
    point.move_inputs()
    at_rest = quotients(point, unknowns, point.inputs)
    point.move()
    if interface == "CoSimulation":
        for _ in range(3):
            instance.step(STEP)
    slopes = quotients(point, unknowns, point.inputs + point.states)
    yield from _undeclared(fmu, place, slopes, kinds)
    if interface == "ModelExchange":  # a communication point need not show new inputs at once
        yield from _feedthrough(fmu, place, at_rest, slopes)
    flags, given = fmu.interfaces[interface], None
    if true(flags.get("providesDirectionalDerivative" + ("s" if fmu.version == 3 else ""))):
        given = _jacobian(instance, slopes)
        yield from _directional(fmu.version, place, slopes, given)
    if true(flags.get("providesAdjointDerivatives")):
        yield from _adjoint(instance, place, slopes, given)
    instance.free()


def _undeclared(fmu: Fmu, place: str, slopes: Slopes, kinds: tuple[str, ...]) -> Iterator[Finding]:
    declared = {e.key: e.dependencies for kind in kinds for e in fmu.listed(kind)}
    moved = abs(slopes.matrix) * slopes.scale
    for unknown, rows in zip(slopes.unknowns, slopes.rows):
        listed = declared.get(fmu.key(unknown))
        if listed is None:
            continue
        largest = moved[rows].max(initial=0.0)
        for known, columns in zip(slopes.knowns, slopes.columns):
            if moved[rows, columns].max(initial=0.0) > _MOVED * largest and fmu.key(known) not in listed:
                message = f'{place}: "{unknown.name}" moves with "{known.name}", which is not among its dependencies'
                yield UNDECLARED.found(fmu.version, f"{message}; list it")


def _feedthrough(fmu: Fmu, place: str, at_rest: Slopes, slopes: Slopes) -> Iterator[Finding]:
    """Neither in motion nor at rest, where no large states drown what the inputs do."""
    inputs = len(at_rest.scale)
    moved = (at_rest.matrix != 0.0) | (slopes.matrix[:, :inputs] != 0.0)
    declared = {e.key: e.dependencies or () for e in fmu.listed("Output")}
    for unknown, rows in zip(at_rest.unknowns, at_rest.rows):
        for known, columns in zip(at_rest.knowns, at_rest.columns):
            if fmu.key(known) in declared.get(fmu.key(unknown), ()) and not moved[rows, columns].any():
                message = f'{place}: "{unknown.name}" does not move with "{known.name}", one of its dependencies'
                yield FEEDTHROUGH.found(fmu.version, f"{message}; leave it out, it makes loops where none are")


def _jacobian(instance: Instance, slopes: Slopes) -> Values:
    """All directional derivatives, by unit seeds, shaped as the difference quotients."""
    columns = []
    for known, elements in zip(slopes.knowns, slopes.columns):
        for seed in np.eye(elements.stop - elements.start):
            columns.append(instance.directional(slopes.unknowns, known, list(seed)))
    return np.array(columns).T.reshape(slopes.matrix.shape)


def _directional(version: int, place: str, slopes: Slopes, given: Values) -> Iterator[Finding]:
    """One finding for every known with a wrong entry in its columns."""
    wrong = ~(abs(given - slopes.matrix) <= slopes.trust)
    for known, columns in zip(slopes.knowns, slopes.columns):
        if wrong[:, columns].any():
            row, column = np.argwhere(wrong[:, columns])[0]
            unknown = next(v for v, rows in zip(slopes.unknowns, slopes.rows) if row < rows.stop)
            said, measured = given[row, columns][column], slopes.matrix[row, columns][column]
            message = f'{place}: the derivative of "{unknown.name}" by "{known.name}" is given as {said:.6g}'
            yield DIRECTIONAL.found(version, f"{message}, differences say {measured:.6g}; correct it")


def _adjoint(instance: Instance, place: str, slopes: Slopes, given: Values | None) -> Iterator[Finding]:
    """For a drawn seed: seed^T J, J from the directional derivatives, or from differences where there are none."""
    J = slopes.matrix if given is None else given
    trust = slopes.trust if given is None else 1e-9 * abs(J)
    size = abs(J).max(axis=1, initial=0.0)
    size[size == 0.0] = size.max(initial=0.0) or 1.0
    seed = np.random.default_rng(4).standard_normal(len(size)) / size
    for known, columns in zip(slopes.knowns, slopes.columns):
        found = instance.adjoint(slopes.unknowns, known, list(seed))
        if not np.all(abs(found - seed @ J[:, columns]) <= abs(seed) @ trust[:, columns]):
            message = f'{place}: the adjoint derivative by "{known.name}" is not the transposed directional one'
            yield ADJOINT.found(instance.fmu.version, f"{message}; correct it")


def _initial(instance: Instance, place: str) -> Iterator[Finding]:
    """Move every known of the initialization a little: all that moves among the initial unknowns is declared."""
    fmu = instance.fmu
    entries = [e for e in fmu.listed("InitialUnknown") if e.dependencies is not None and e.key is not None]
    unknowns = floats(fmu, [fmu.by_key.get(e.key) for e in entries if e.key is not None])
    knowns = [v for v in fmu.variables if v.initial == "exact" and v.variability != "constant"]
    declared = {e.key: e.dependencies or () for e in entries}
    rows, moved = ranges(fmu, unknowns), {}
    for known in floats(fmu, [v for v in knowns if v.causality != "structuralParameter"]):
        try:
            moved[known.name] = (known, _moved(instance, known, unknowns))
        except CallError:
            continue  # a value that the model refuses
    for unknown, elements in zip(unknowns, rows):
        largest = max((m[elements].max() for _, m in moved.values()), default=0.0)
        for known, movement in moved.values():
            if movement[elements].max() > _MOVED * largest and fmu.key(known) not in declared[fmu.key(unknown)]:
                message = f'{place}: at the start "{unknown.name}" moves with "{known.name}"'
                yield UNDECLARED.found(fmu.version, f"{message}, which is not among its dependencies; list it")


def _moved(instance: Instance, known: Variable, unknowns: list[Variable]) -> Values:
    base = np.array(instance.read(known.type, [known]), float)
    nominal = abs(known.number("nominal") or 0.0)
    scale = np.maximum(abs(base), nominal) if nominal or base.any() else np.ones(len(base))
    before = instance.get(unknowns)
    try:
        instance.set(known, base + 1e-3 * scale)
        after = instance.get(unknowns)
    finally:
        instance.set(known, base)
    return np.nan_to_num(abs(after - before))
