"""Running a co-simulation FMU through fmpy, step by step, fast enough for a few 100,000 steps."""

from __future__ import annotations

import ctypes as ct
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import GearpathError, MissingExtraError
from ..numerics.arrays import Real


class RunningFmu:
    """An instance of an FMI 2.0 co-simulation FMU, made by `running`."""

    def __init__(self, slave: Any, description: Any) -> None:
        self.slave, self.description = slave, description
        self.interpolates = bool(description.coSimulation.canInterpolateInputs)
        self._reference = {v.name: v.valueReference for v in description.modelVariables}
        self.time = 0.0

    def references(self, names: Sequence[str]) -> list[int]:
        """Value references of variables; raises GearpathError for one that the FMU does not have."""
        missing = [name for name in names if name not in self._reference]
        if missing:
            raise GearpathError(f"the FMU has no variable {missing[0]!r}; export it again from this model")
        return [self._reference[name] for name in names]

    def start(self, values: Mapping[str, float] | None = None) -> None:
        """Set parameters and start values, and go through initialisation."""
        self.slave.setupExperiment(startTime=0.0)
        self.set(values or {})
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()
        self.time = 0.0

    def set(self, values: Mapping[str, float]) -> None:
        """Set real variables by name."""
        if values:
            self.slave.setReal(self.references(list(values)), list(values.values()))

    def get(self, names: Sequence[str]) -> Real:
        """Real variables by name."""
        return np.array(self.slave.getReal(self.references(names)), float)

    def run(
        self,
        inputs: Mapping[str, Real],
        step: float,
        outputs: Sequence[str],
        *,
        record_from: int = 0,
        interpolate: bool = False,
        progress: Callable[[int], None] = lambda _: None,
    ) -> Real:
        """Feed samples u_0 ... u_n of every input over n steps; outputs at the samples from `record_from` on.

        Between samples the inputs are held, or (`interpolate`) follow the straight line to the next sample. Shape
        (n + 1 - record_from, outputs).
        """
        names = list(inputs)
        u = np.ascontiguousarray(np.column_stack([inputs[name] for name in names]), float)
        slopes = np.ascontiguousarray(np.diff(u, axis=0) / step)
        steps = len(u) - 1
        set_refs, get_refs = _uints(self.references(names)), _uints(self.references(outputs))
        orders = (ct.c_int * len(names))(*[1] * len(names))
        out = np.empty((steps + 1 - record_from, len(outputs)))
        slave, c = self.slave, self.slave.component
        start = self.time
        for k in range(steps + 1):
            slave.fmi2SetReal(c, set_refs, len(names), _row(u, k))
            if k >= record_from:
                slave.fmi2GetReal(c, get_refs, len(outputs), _row(out, k - record_from))
            if k == steps:
                break
            if interpolate:
                slave.fmi2SetRealInputDerivatives(c, set_refs, len(names), orders, _row(slopes, k))
            slave.fmi2DoStep(c, start + k * step, step, 1)
            if k % 5000 == 4999:
                progress(5000)
        self.time = start + steps * step
        return out


@contextmanager
def running(path: Path) -> Iterator[RunningFmu]:
    """Unpack an FMU, instantiate it, and clean up at the end."""
    try:
        import fmpy
        from fmpy.fmi2 import FMU2Slave
    except ImportError as error:
        raise MissingExtraError("fmpy", "fmu") from error
    description = fmpy.read_model_description(str(path))
    with tempfile.TemporaryDirectory(prefix="gearpath-") as folder:
        fmpy.extract(str(path), folder)
        slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=folder,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=description.modelName,
        )
        slave.instantiate()
        try:
            yield RunningFmu(slave, description)
        finally:
            slave.freeInstance()


def _uints(values: Sequence[int]) -> ct.Array[ct.c_uint]:
    return (ct.c_uint * len(values))(*values)


_DOUBLES = ct.POINTER(ct.c_double)


def _row(array: Real, k: int) -> Any:
    """Pointer to row k of a contiguous array."""
    return ct.cast(array.ctypes.data + k * array.strides[0], _DOUBLES)
