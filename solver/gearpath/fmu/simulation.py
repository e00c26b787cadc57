"""Running a co-simulation FMU through fmpy, step by step, fast enough for a few 100,000 steps."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import GearpathError, MissingExtraError
from ..numerics.arrays import Real
from .simulation_calls import Calls, Fmi2Calls, Fmi3Calls, row, uints

_ENTRY = re.compile(r"(.+)\[(\d+),(\d+)\]$")


class RunningFmu:
    """An instance of a co-simulation FMU of either version of FMI, made by `running`."""

    def __init__(self, calls: Calls, description: Any) -> None:
        self.calls, self.description = calls, description
        self.interpolates = calls.interpolates
        self._variable = {v.name: v for v in description.modelVariables}
        self.time = 0.0

    def references(self, names: Sequence[str]) -> list[int]:
        """Value references of variables; raises GearpathError for one that the FMU does not have."""
        missing = [name for name in names if name not in self._variable]
        if missing:
            raise GearpathError(f"the FMU has no variable {missing[0]!r}; export it again from this model")
        return [self._variable[name].valueReference for name in names]

    def start(self, values: Mapping[str, float] | None = None) -> None:
        """Set parameters and start values, and go through initialisation."""
        self.calls.set_up()
        self.calls.enter()
        self.set(values or {})
        self.calls.leave()
        self.time = 0.0

    def set(self, values: Mapping[str, float]) -> None:
        """Set real variables by name; entries of a symmetric matrix (`name[i,k]`) also where it is an array."""
        whole = {name: value for name, value in values.items() if name in self._variable}
        if whole:
            self.calls.set(self.references(list(whole)), list(whole.values()))
        for name, matrix in self._matrices({k: v for k, v in values.items() if k not in whole}).items():
            self.calls.set(self.references([name]), list(matrix.ravel()))

    def get(self, names: Sequence[str]) -> Real:
        """Scalar real variables by name."""
        return np.array(self.calls.get(self.references(names), len(names)), float)

    def _matrices(self, entries: Mapping[str, float]) -> dict[str, Real]:
        matrices: dict[str, Real] = {}
        for entry, value in entries.items():
            found = _ENTRY.fullmatch(entry)
            if found is None:
                self.references([entry])  # says that there is none
                continue
            name, i, k = found[1], int(found[2]) - 1, int(found[3]) - 1
            if name not in matrices:
                reference = self.references([name])
                shape = [int(d.start) for d in self._variable[name].dimensions]
                matrices[name] = np.array(self.calls.get(reference, int(np.prod(shape)))).reshape(shape)
            matrices[name][i, k] = matrices[name][k, i] = value
        return matrices

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
        set_refs, get_refs = uints(self.references(names)), uints(self.references(outputs))
        out = np.empty((steps + 1 - record_from, len(outputs)))
        calls, start = self.calls, self.time
        for k in range(steps + 1):
            calls.set_row(set_refs, len(names), row(u, k))
            if k >= record_from:
                calls.get_row(get_refs, len(outputs), row(out, k - record_from))
            if k == steps:
                break
            if interpolate:
                calls.aim_at(set_refs, len(names), row(slopes, k), row(u, k + 1))
            calls.step(start + k * step, step)
            if k % 5000 == 4999:
                progress(5000)
        self.time = start + steps * step
        return out


@contextmanager
def running(path: Path) -> Iterator[RunningFmu]:
    """Unpack an FMU, instantiate it, and clean up at the end."""
    try:
        import fmpy
    except ImportError as error:
        raise MissingExtraError("fmpy", "fmu") from error
    description = fmpy.read_model_description(str(path))
    with tempfile.TemporaryDirectory(prefix="gearpath-") as folder:
        fmpy.extract(str(path), folder)
        kind = Fmi3Calls if description.fmiVersion.startswith("3") else Fmi2Calls
        calls = kind(description, folder)
        try:
            yield RunningFmu(calls, description)
        finally:
            calls.free()
