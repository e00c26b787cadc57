"""A point to look at the model from: drawn inputs and states, and steps away from it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .contents import FLOATS, Fmu, Variable, real
from .instance import Instance, Values


def floats(fmu: Fmu, variables: Sequence[Variable | None]) -> list[Variable]:
    """Those that are floats and can be reached."""
    return [v for v in variables if v is not None and v.type in FLOATS and v.reference is not None and fmu.size(v)]


class Point:
    """Values of the knowns, drawn near their start within their range; sets them one by one or all."""

    def __init__(self, instance: Instance, seed: int) -> None:
        self.instance, self.fmu = instance, instance.fmu
        self.random = np.random.default_rng(seed)
        self.inputs = floats(self.fmu, [v for v in self.fmu.variables if v.causality == "input"])
        self.states = floats(self.fmu, self.fmu.states) if instance.interface == "ModelExchange" else []
        self.values = {v.name: self.start(v) for v in self.inputs}
        if self.states:
            sizes = [self.fmu.size(s) or 1 for s in self.states]
            self.nominals = instance.nominals(sum(sizes))
            whole = instance.states(sum(sizes))
            self.values |= dict(zip((s.name for s in self.states), np.split(whole, np.cumsum(sizes)[:-1])))

    def start(self, v: Variable) -> Values:
        """Start values as a vector of all elements."""
        size = self.fmu.size(v) or 1
        numbers = [real(x) or 0.0 for x in v.start or ("0",)]
        return np.array(numbers * size if len(numbers) == 1 else numbers, float)

    def scale(self, v: Variable) -> float:
        """What a change of the variable is measured by."""
        nominal = v.number("nominal")
        if nominal is None and v in self.states:
            place = sum(self.fmu.size(s) or 1 for s in self.states[: self.states.index(v)])
            nominal = float(self.nominals[place])
        largest = float(abs(self.start(v)).max(initial=0.0))
        return abs(nominal or largest or 1.0)

    def move_inputs(self) -> None:
        """Draw all inputs anew and set them."""
        for v in self.inputs:
            self.values[v.name] = self._drawn(v)
            self.instance.set(v, self.values[v.name])

    def move(self) -> None:
        """Draw inputs and states anew and set them."""
        self.move_inputs()
        for v in self.states:
            self.values[v.name] = self._drawn(v)
        self._set_states()

    def put(self, v: Variable, values: Values) -> None:
        """Set one known to other values; `values` of this point stay as they are."""
        if v in self.states:
            self._set_states({v.name: values})
        else:
            self.instance.set(v, values)

    def _set_states(self, changed: dict[str, Values] | None = None) -> None:
        if self.states:
            values = self.values | (changed or {})
            self.instance.set_states(np.concatenate([values[s.name] for s in self.states]))

    def _drawn(self, v: Variable) -> Values:
        start, scale = self.start(v), self.scale(v)
        low, high = v.number("min"), v.number("max")
        drawn = start + scale * self.random.uniform(0.2, 0.8, start.shape)
        margin = 0.02 * scale  # so that a step to either side stays in the range
        if low is not None and high is not None and high - low < 4 * margin:
            return start
        drawn = drawn if high is None else np.minimum(drawn, high - margin)
        return drawn if low is None else np.maximum(drawn, low + margin)
