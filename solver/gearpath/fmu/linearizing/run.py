"""Integrating an FMU from where it is to a later time, with its inputs held, by fmpy's CVode and its event handling."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..conformance.instance import CallError, Instance
from .point import Point

_TOLERANCE = 1e-8  # relative, of the states


def run(path: Path, point: Point, event: tuple[bool, float], time: float) -> None:
    """From continuous-time mode at the point's time to continuous-time mode at `time` (s), events handled.

    `event`: whether the FMU has announced an event at a time, and that time. Raises CallError where it cannot go on.
    """
    from fmpy import read_model_description, simulate_fmu

    instance = point.instance
    continued = _Continued(instance, event)
    try:
        simulate_fmu(
            str(path),
            start_time=instance.time,
            stop_time=time,
            relative_tolerance=_TOLERANCE,
            output=[],
            record_events=False,
            fmi_type=point.instance.interface,
            model_description=read_model_description(str(path), validate=False),
            fmu_instance=continued,
            step_finished=lambda reached, _: continued.reaches(reached),
        )
    except Exception as problem:  # fmpy raises plain Exception
        raise continued.problem or CallError(f"the run to {time:g} s failed: {problem}") from problem
    if continued.problem:
        raise continued.problem
    if continued.reached < time - 1e-6 * (time - instance.time):
        raise CallError(f"the FMU wants to end at {continued.reached:g} s, before {time:g} s")
    instance.time = time
    if point.states and not np.isfinite(instance.states(len(point.states))).all():
        raise CallError(f"a state is not finite at {time:g} s")
    point.arrived()


class _Continued:
    """An instance as fmpy's simulation sees it: initialised already, and not to be ended.

    The solver calls from C, where no exception comes through: the first one is kept, and stops the run.
    """

    def __init__(self, instance: Instance, event: tuple[bool, float]) -> None:
        self.instance, self.event = instance, event
        self.begun, self.problem, self.reached = False, None, instance.time
        self._initial = {
            **dict.fromkeys(("setupExperiment", "enterInitializationMode", "exitInitializationMode")),
            **dict.fromkeys(("newDiscreteStates", "updateDiscreteStates"), (False, False, False, False, *event)),
        }

    problem: CallError | None

    def reaches(self, time: float) -> bool:
        """Whether to go on after a step to `time`."""
        self.reached = time
        return self.problem is None

    def enterContinuousTimeMode(self) -> None:
        """The first time it is there already."""
        if self.begun:
            self.instance.enterContinuousTimeMode()
        self.begun = True

    def terminate(self) -> None:
        """It goes on living."""

    def __getattr__(self, name: str) -> Any:
        if not self.begun and name in self._initial:
            return lambda *_, **__: self._initial[name]
        method = getattr(self.instance, name)

        def call(*arguments: Any, **options: Any) -> Any:
            try:
                return method(*arguments, **options)
            except CallError as problem:
                self.problem = self.problem or problem
                return None

        return call
