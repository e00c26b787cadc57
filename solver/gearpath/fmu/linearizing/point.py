"""An instance of an FMU at its operating point: values there, and values beside it."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from contextlib import suppress

import numpy as np

from ..conformance.contents import Variable, true
from ..conformance.instance import CallError, Instance, Values
from .opened import KIND, Unpacked
from .signals import Signal, signals
from .start import Start, set_starts


class Point:
    """Continuous-time mode of model exchange, with the states x and chosen inputs u held."""

    def __init__(self, fmu: Unpacked, states: Sequence[Variable], inputs: list[Signal], outputs: list[Signal]) -> None:
        self.fmu, self.inputs, self.outputs = fmu.fmu, inputs, outputs
        self.states = [signal for state in states for signal in signals(fmu.fmu, state)]
        rates = [self.fmu.by_key.get(entry.key or 0) for entry in self.fmu.listed("Derivative")]
        self.rates = [v for v in rates if v is not None]  # the derivatives of the states, in their order
        place = os.getcwd()
        try:
            self.instance = Instance(fmu.fmu, fmu.folder, fmu.library, KIND)
        except Exception as problem:  # fmpy raises plain Exception, and may stay in the library's folder
            os.chdir(place)
            raise CallError(f"{fmu.library.name} cannot be loaded ({problem})") from problem
        self.x = self.u = np.zeros(0)
        self._held: dict[str, Values] = {}  # whole input variables

    def begin(self, start_values: list[Start], states: Mapping[str, float], time: float) -> tuple[bool, float]:
        """Through initialisation, event iteration and the states given to continuous time; the next event in time."""
        self.instance.create()
        set_starts(self.instance, start_values)
        self.instance.enter_initialization(time)
        self.instance.exitInitializationMode()
        event = self.instance.settle()
        if states:
            present = self.instance.states(len(self.states))
            self.instance.set_states(np.array([states.get(s.name, x) for s, x in zip(self.states, present)]))
            event = self.settle()
        self.arrived()
        return event

    def settle(self) -> tuple[bool, float]:
        """Tell the FMU that its states have changed, and handle the events that follow from it."""
        if self._needs_completed_step():
            self.instance.completedIntegratorStep()
        self.instance.enterEventMode()
        return self.instance.settle()

    def arrived(self) -> None:
        """The present states and inputs are those of the operating point."""
        self.x = self.instance.states(len(self.states)) if self.states else np.zeros(0)
        variables = dict.fromkeys(signal.variable.name for signal in self.inputs)
        self._held = {name: self.instance.get([self.fmu.by_name[name]]) for name in variables}
        self.u = np.array([self._held[s.variable.name][s.element] for s in self.inputs])

    @property
    def known(self) -> Values:
        """States and inputs of the operating point, one after the other."""
        return np.concatenate([self.x, self.u])

    def values(self) -> Values:
        """Derivatives of the states and the chosen outputs, at the present states and inputs."""
        derivatives = self.instance.derivatives(len(self.states)) if self.states else np.zeros(0)
        variables = [self.fmu.by_name[name] for name in dict.fromkeys(s.variable.name for s in self.outputs)]
        whole = dict(zip((v.name for v in variables), self._split(variables)))
        return np.concatenate([derivatives, [whole[s.variable.name][s.element] for s in self.outputs]])

    def put(self, known: Values) -> None:
        """Other states and inputs; the operating point stays what it is."""
        count = len(self.states)
        if count:
            self.instance.set_states(known[:count])
        changed = {name: values.copy() for name, values in self._held.items()}
        for signal, value in zip(self.inputs, known[count:]):
            changed[signal.variable.name][signal.element] = value
        for name, values in changed.items():
            self.instance.set(self.fmu.by_name[name], values)

    def scales(self) -> Values:
        """What changes of states and inputs are measured by: nominal or present value, whichever is larger."""
        nominals = self.instance.nominals(len(self.states)) if self.states else np.zeros(0)
        nominals = np.where(np.isfinite(nominals) & (nominals > 0.0), nominals, 1.0)
        given = [abs(s.variable.number("nominal") or 1.0) for s in self.inputs]
        return np.asarray(np.maximum(abs(self.known), np.concatenate([nominals, given])))

    def close(self) -> None:
        """End and unload it."""
        if getattr(self.instance.calls, "component", None):
            with suppress(CallError):
                self.instance.terminate()
            with suppress(CallError):
                self.instance.freeInstance()

    def _split(self, variables: list[Variable]) -> list[Values]:
        sizes = [self.fmu.size(v) or 1 for v in variables]
        return np.split(self.instance.get(variables), np.cumsum(sizes)[:-1]) if variables else []

    def _needs_completed_step(self) -> bool:
        flags = self.fmu.interfaces[KIND]
        if self.fmu.version == 2:
            return not true(flags.get("completedIntegratorStepNotNeeded"))
        return true(flags.get("needsCompletedIntegratorStep"))
