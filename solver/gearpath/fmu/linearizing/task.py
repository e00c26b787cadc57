"""What is to be linearised, and where: checked before anything runs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from numbers import Real as Number
from pathlib import Path
from typing import Any

from ...errors import InputError
from ..conformance.contents import Variable, real, true
from .opened import KIND, Unpacked
from .point import Point
from .run import run
from .signals import Signal, dotted, hint, inputs_of, outputs_of, signals, states_of
from .start import Start, starts

METHODS = ("auto", "derivatives", "differences")
_SMALLEST = 1e-6  # relative step: the steps shrink from there, and rounding grows as they do


@dataclass(frozen=True)
class Task:
    """An FMU, its signals, and the way to its operating point."""

    path: Path
    unpacked: Unpacked
    states: list[Variable]
    inputs: list[Signal]
    outputs: list[Signal]
    start_values: list[Start]
    begin_states: Mapping[str, float]
    start: float  # s
    time: float  # s
    method: str  # "auto" only where the FMU provides derivatives
    relative_step: float

    def reach(self) -> Point:
        """A new instance at the operating point. Raises CallError where the FMU refuses."""
        point = Point(self.unpacked, self.states, self.inputs, self.outputs)
        try:
            event = point.begin(self.start_values, self.begin_states, self.start)
            if self.time > self.start:
                run(self.path, point, event, self.time)
        except BaseException:
            point.close()
            raise
        return point


def task_of(
    path: Path,
    unpacked: Unpacked,
    inputs: str | Iterable[str] | None,
    outputs: str | Iterable[str] | None,
    start_values: Mapping[str, Any],
    states: Mapping[str, float],
    time: float | None,
    method: str,
    relative_step: float,
) -> Task:
    """The checked task. Raises InputError."""
    fmu = unpacked.fmu
    found = states_of(fmu)
    chosen = inputs_of(fmu, inputs), outputs_of(fmu, outputs, found)
    count = sum(fmu.size(state) or 1 for state in found)
    if not chosen[0] and count and 1 in (count, len(chosen[1])):
        raise InputError(
            f"inputs: none, with {count} state(s) and {len(chosen[1])} output(s), which python-control cannot hold: "
            "without inputs it needs two of each; name more outputs (states may be some), or an input"
        )
    start = _start_time(unpacked)
    return Task(
        path,
        unpacked,
        found,
        *chosen,
        starts(fmu, start_values),
        _checked_states(states, [signal.name for state in found for signal in signals(fmu, state)]),
        start,
        start if time is None else _checked_time(time, start),
        _checked_method(path, unpacked, method),
        _checked_step(relative_step),
    )


def _checked_method(path: Path, unpacked: Unpacked, method: str) -> str:
    if method not in METHODS:
        raise InputError(f"method: {method!r} is not known; choose one of {', '.join(METHODS)}")
    flag = "providesDirectionalDerivative" + ("s" if unpacked.fmu.version == 3 else "")
    if true(unpacked.fmu.interfaces[KIND].get(flag)):
        return method
    if method == "derivatives":
        raise InputError(
            f'{path}: provides no directional derivatives for model exchange; use method="differences" or "auto"'
        )
    return "differences"


def _checked_step(step: float) -> float:
    if not (isinstance(step, Number) and _SMALLEST <= step <= 1.0):
        raise InputError(
            f"relative_step: {step!r} is not a number from {_SMALLEST:g} to 1; in smaller steps differences drown in "
            "rounding"
        )
    return float(step)


def _checked_time(time: float, start: float) -> float:
    if not (isinstance(time, Number) and math.isfinite(time) and time >= start):
        raise InputError(f"time: {time!r} is not a number of seconds from the FMU's start time, {start:g} s, on")
    return float(time)


def _checked_states(states: Mapping[str, float], known: list[str]) -> dict[str, float]:
    found = {}
    for given, value in states.items():
        name = dotted(given, known)
        if name not in known:
            raise InputError(f"states: the FMU has no state {given!r}; {hint(name, known)}")
        try:
            found[name] = float(value)
        except (TypeError, ValueError) as problem:
            raise InputError(f"states: {name} = {value!r} is not a number") from problem
        if not math.isfinite(found[name]):
            raise InputError(f"states: {name} = {value!r} is not finite; give a finite number")
    return found


def _start_time(unpacked: Unpacked) -> float:
    experiment = unpacked.fmu.root.find("DefaultExperiment")
    start = real(experiment.get("startTime")) if experiment is not None else None
    return start if start is not None and math.isfinite(start) else 0.0
