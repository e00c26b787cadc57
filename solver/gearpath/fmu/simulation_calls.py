"""The calls of FMI 2.0 and 3.0 that a co-simulation takes, through fmpy's bindings."""

from __future__ import annotations

import ctypes as ct
from collections.abc import Sequence
from typing import Any, Protocol

from ..numerics.arrays import Real

_DOUBLES = ct.POINTER(ct.c_double)


class Calls(Protocol):
    """What both versions can do. `aim_at` gives the inputs' slopes and values at the end of the coming step."""

    interpolates: bool

    def set_up(self) -> None: ...
    def enter(self) -> None: ...
    def leave(self) -> None: ...
    def set(self, references: Sequence[int], values: Sequence[float]) -> None: ...
    def get(self, references: Sequence[int], values: int) -> list[float]: ...
    def set_row(self, references: Any, count: int, values: Any) -> None: ...
    def get_row(self, references: Any, count: int, values: Any) -> None: ...
    def aim_at(self, references: Any, count: int, slopes: Any, ends: Any) -> None: ...
    def step(self, time: float, step: float) -> None: ...
    def free(self) -> None: ...


class Fmi2Calls:
    """An instance through FMI 2.0."""

    def __init__(self, description: Any, folder: str) -> None:
        from fmpy.fmi2 import FMU2Slave

        self.interpolates = bool(description.coSimulation.canInterpolateInputs)
        self.slave = _instance(FMU2Slave, description, folder)
        self.slave.instantiate()

    def set_up(self) -> None:
        self.slave.setupExperiment(startTime=0.0)

    def enter(self) -> None:
        self.slave.enterInitializationMode()

    def leave(self) -> None:
        self.slave.exitInitializationMode()

    def set(self, references: Sequence[int], values: Sequence[float]) -> None:
        self.slave.setReal(references, values)

    def get(self, references: Sequence[int], values: int) -> list[float]:
        found: list[float] = self.slave.getReal(references)
        assert len(found) == values
        return found

    def set_row(self, references: Any, count: int, values: Any) -> None:
        self.slave.fmi2SetReal(self.slave.component, references, count, values)

    def get_row(self, references: Any, count: int, values: Any) -> None:
        self.slave.fmi2GetReal(self.slave.component, references, count, values)

    def aim_at(self, references: Any, count: int, slopes: Any, ends: Any) -> None:
        del ends
        orders = (ct.c_int * count)(*[1] * count)
        self.slave.fmi2SetRealInputDerivatives(self.slave.component, references, count, orders, slopes)

    def step(self, time: float, step: float) -> None:
        self.slave.fmi2DoStep(self.slave.component, time, step, 1)

    def free(self) -> None:
        self.slave.freeInstance()


class Fmi3Calls:
    """An instance through FMI 3.0; the values at the end of a step are given in its intermediate update."""

    def __init__(self, description: Any, folder: str) -> None:
        from fmpy.fmi3 import FMU3Slave

        self.interpolates = bool(description.coSimulation.providesIntermediateUpdate)
        self._ends: tuple[Any, int, Any] | None = None
        self.slave = _instance(FMU3Slave, description, folder)
        self.slave.instantiate(intermediateUpdate=self._update)

    def _update(self, _environment: Any, _time: float, set_requested: bool, *_: Any) -> None:
        if set_requested and self._ends is not None:
            references, count, values = self._ends
            self.slave.fmi3SetFloat64(self.slave.component, references, count, values, count)
            self._ends = None

    def set_up(self) -> None:
        """FMI 3 gives the start time as it enters initialisation."""

    def enter(self) -> None:
        self.slave.enterInitializationMode(startTime=0.0)

    def leave(self) -> None:
        self.slave.exitInitializationMode()

    def set(self, references: Sequence[int], values: Sequence[float]) -> None:
        self.slave.setFloat64(references, values)

    def get(self, references: Sequence[int], values: int) -> list[float]:
        found: list[float] = self.slave.getFloat64(references, nValues=values)
        return found

    def set_row(self, references: Any, count: int, values: Any) -> None:
        self.slave.fmi3SetFloat64(self.slave.component, references, count, values, count)

    def get_row(self, references: Any, count: int, values: Any) -> None:
        self.slave.fmi3GetFloat64(self.slave.component, references, count, values, count)

    def aim_at(self, references: Any, count: int, slopes: Any, ends: Any) -> None:
        del slopes
        self._ends = (references, count, ends)

    def step(self, time: float, step: float) -> None:
        self.slave.doStep(time, step)

    def free(self) -> None:
        self.slave.freeInstance()


def uints(values: Sequence[int]) -> ct.Array[ct.c_uint]:
    """Value references as C has them."""
    return (ct.c_uint * len(values))(*values)


def row(array: Real, k: int) -> Any:
    """Pointer to row k of a contiguous array."""
    return ct.cast(array.ctypes.data + k * array.strides[0], _DOUBLES)


def _instance(kind: Any, description: Any, folder: str) -> Any:
    return kind(
        guid=description.guid,
        unzipDirectory=folder,
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName=description.modelName,
    )
