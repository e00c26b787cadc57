"""One instance of the binary of this machine, called the same way in both editions (through fmpy)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from ctypes import c_double
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .contents import Fmu, Variable

Values = NDArray[np.float64]
_GETTER_2 = {"Real": "Real", "Integer": "Integer", "Enumeration": "Integer", "Boolean": "Boolean", "String": "String"}


class CallError(Exception):
    """A call that the standard allows returned an error, or no instance."""


class Instance:
    """A thin skin over fmpy: every failure is a CallError with the name of the function and what the FMU logged."""

    def __init__(self, fmu: Fmu, folder: Path, library: Path, interface: str, token: str | None = None) -> None:
        self.fmu, self.interface, self.messages = fmu, interface, list[str]()
        identifier = fmu.interfaces[interface].get("modelIdentifier", "")
        arguments = {
            "guid": fmu.token if token is None else token,
            "unzipDirectory": str(folder),
            "modelIdentifier": identifier,
            "instanceName": "conformance",
            "libraryPath": str(library),
        }
        self.calls = _class(fmu.version, interface)(**arguments)
        self.time = 0.0

    def __getattr__(self, name: str) -> Any:
        """A method of fmpy's, its failures turned into CallError."""
        method = getattr(self.calls, name)

        def call(*arguments: Any, **options: Any) -> Any:
            try:
                return method(*arguments, **options)
            except Exception as problem:  # fmpy raises plain Exception
                said = f' ("{self.messages[-1]}")' if self.messages else ""
                raise CallError(f"{name} failed: {problem}{said}") from problem

        return call

    def create(self) -> None:
        """Instantiate."""
        if self.fmu.version == 2:
            self.instantiate(callbacks=self._callbacks(), loggingOn=True)
        else:
            self.instantiate(logMessage=lambda *a: self.messages.append(_text(a[-1])), loggingOn=True)

    def _callbacks(self) -> Any:
        from fmpy import calloc, fmi2, free

        self.callbacks = fmi2.fmi2CallbackFunctions()
        self.callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(lambda *a: self.messages.append(_text(a[4])))
        self.callbacks.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(calloc)
        self.callbacks.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(free)
        return self.callbacks

    def enter_initialization(self, time: float = 0.0) -> None:
        """From a new instance to initialization mode."""
        self.time = time
        if self.fmu.version == 2:
            self.setupExperiment(startTime=time)
            self.enterInitializationMode()
        else:
            self.enterInitializationMode(startTime=time)

    def leave_initialization(self) -> None:
        """To continuous time (model exchange) or to the first communication point."""
        self.exitInitializationMode()
        if self.interface == "ModelExchange":
            self.settle()

    def settle(self) -> tuple[bool, float]:
        """Handle events until none is left: whether a next event has a time, and that time."""
        for _ in range(100):
            found = self.newDiscreteStates() if self.fmu.version == 2 else self.updateDiscreteStates()
            again, ended = found[:2]
            if ended:
                raise CallError("the FMU wants to end before it began")
            if not again:
                self.enterContinuousTimeMode()
                return bool(found[4]), float(found[5])
        raise CallError("the FMU asks for another event iteration, 100 times over")

    def step(self, size: float) -> None:
        """One communication step."""
        self.doStep(self.time, size)
        self.time += size

    def get(self, variables: Sequence[Variable]) -> Values:
        """Values of float variables, arrays row by row, all in one vector."""
        parts: dict[str, Any] = {}
        for kind in dict.fromkeys(v.type for v in variables):
            chosen = [v for v in variables if v.type == kind]
            parts[kind] = iter(self.read(kind, chosen))
        sizes = [(v.type, self.fmu.size(v) or 1) for v in variables]
        return np.array([next(parts[kind]) for kind, size in sizes for _ in range(size)], float)

    def read(self, kind: str, variables: Sequence[Variable]) -> Sequence[Any]:
        """Values of variables of one type, as fmpy gives them."""
        references = [v.reference for v in variables]
        if self.fmu.version == 2:
            return list(getattr(self, f"get{_GETTER_2[kind]}")(references))
        count = sum(self.fmu.size(v) or 1 for v in variables)
        return list(getattr(self, f"get{kind}")(references, count))

    def set(self, variable: Variable, values: Iterable[float]) -> None:
        """Set one float variable."""
        method = f"set{_GETTER_2[variable.type] if self.fmu.version == 2 else variable.type}"
        getattr(self, method)([variable.reference], [float(x) for x in values])

    def states(self, count: int) -> Values:
        """The continuous states (model exchange)."""
        values = (c_double * count)()
        self.getContinuousStates(values, count)
        return np.array(values)

    def set_states(self, values: Values) -> None:
        """Set the continuous states (model exchange)."""
        self.setContinuousStates((c_double * len(values))(*values), len(values))

    def derivatives(self, count: int) -> Values:
        """Derivatives of the continuous states (model exchange)."""
        values = (c_double * count)()
        (self.getDerivatives if self.fmu.version == 2 else self.getContinuousStateDerivatives)(values, count)
        return np.array(values)

    def nominals(self, count: int) -> Values:
        """Nominal values of the continuous states (model exchange)."""
        values = (c_double * count)()
        self.getNominalsOfContinuousStates(values, count)
        return np.array(values)

    def directional(self, unknowns: Sequence[Variable], known: Variable, seed: Sequence[float]) -> Values:
        """Directional derivative of all elements of the unknowns."""
        references, count = [v.reference for v in unknowns], sum(self.fmu.size(v) or 1 for v in unknowns)
        if self.fmu.version == 2:
            return np.array(self.getDirectionalDerivative(references, [known.reference], list(seed)))
        return np.array(self.getDirectionalDerivative(references, [known.reference], list(seed), count))

    def adjoint(self, unknowns: Sequence[Variable], known: Variable, seed: Sequence[float]) -> Values:
        """Adjoint derivative: seed^T J, by the elements of the known (FMI 3)."""
        references, count = [v.reference for v in unknowns], self.fmu.size(known) or 1
        return np.array(self.getAdjointDerivative(references, [known.reference], list(seed), count))

    def save(self) -> Any:
        """The whole state."""
        return self.getFMUstate() if self.fmu.version == 2 else self.getFMUState()

    def restore(self, state: Any) -> None:
        """Back to a state."""
        (self.setFMUstate if self.fmu.version == 2 else self.setFMUState)(state)

    def serialized(self, state: Any) -> bytes:
        """A state as bytes."""
        return bytes(self.serializeFMUstate(state) if self.fmu.version == 2 else self.serializeFMUState(state))

    def deserialized(self, data: bytes) -> Any:
        """A state from bytes."""
        return self.deSerializeFMUstate(data) if self.fmu.version == 2 else self.deserializeFMUState(data)

    def free(self) -> None:
        """End it, whatever state it is in; the library stays loaded."""
        getattr(self.calls, f"fmi{self.fmu.version}FreeInstance")(self.calls.component)


def _class(version: int, interface: str) -> Any:
    from fmpy import fmi2, fmi3

    model = interface == "ModelExchange"
    if version == 2:
        return fmi2.FMU2Model if model else fmi2.FMU2Slave
    return fmi3.FMU3Model if model else fmi3.FMU3Slave


def _text(message: object) -> str:
    return message.decode("utf-8", "replace") if isinstance(message, bytes) else str(message)
