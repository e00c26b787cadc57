"""Directional and adjoint derivatives of an FMU, and differences of its values, in either version of FMI."""

import ctypes as ct
import re

import numpy as np
from fmi3_driver import Fmu3
from fmu_driver import OK, Fmu, reals

LEVELS = {"mesh.transmission_error": 1.3e-6, "mesh.force": 11.0, "actuators.shaker": -7.0}


class Tangent:
    """Derivatives of one instance, in either version of FMI."""

    def __init__(self, unpacked, *, exchange: bool) -> None:
        self.version = int(unpacked.description.fmiVersion[0])
        self.fmu = Fmu3(unpacked, exchange=exchange) if self.version == 3 else Fmu(unpacked, kind=int(not exchange))
        named = unpacked.description.modelVariables
        derivatives = [v for v in named if v.derivative is not None]
        self.outputs = [v.name for v in named if v.causality == "output"]
        self.over_time = [n for n in self.outputs if "alpha" not in n and not n.startswith("frf.")]
        self.over_frequency = [n for n in self.outputs if n not in self.over_time]
        self.derivatives = [v.name for v in derivatives]
        self.states = [v.derivative.name for v in derivatives]
        self.inputs = [v.name for v in named if v.causality == "input" and v.name != "frequency"]
        self.parameters = [v.name for v in named if v.causality == "parameter"]

    def size(self, names) -> int:
        return sum(self.fmu.sizes(names)) if self.version == 3 else len(names)

    def shape(self, name) -> tuple:
        return self.fmu.shape[name] if self.version == 3 else ()

    def along(self, unknowns, knowns, seed) -> np.ndarray:
        result = (ct.c_double * self.size(unknowns))()
        arguments = [self.fmu.references(unknowns), len(unknowns), self.fmu.references(knowns), len(knowns)]
        seed = reals(np.ravel(seed))
        if self.version == 3:
            arguments += [seed, len(seed), result, len(result)]
        else:
            arguments += [seed, result]
        assert self.fmu.call(f"fmi{self.version}GetDirectionalDerivative", *arguments) == OK, self.fmu.messages
        return np.array(result)

    def jacobian(self, unknowns, knowns) -> np.ndarray:
        return np.array([self.along(unknowns, knowns, row) for row in np.eye(self.size(knowns))]).T

    def adjoint(self, unknowns, knowns, weights) -> np.ndarray:
        result, weights = (ct.c_double * self.size(knowns))(), reals(weights)
        arguments = [self.fmu.references(unknowns), len(unknowns), self.fmu.references(knowns), len(knowns)]
        arguments += [weights, len(weights), result, len(result)]
        assert self.fmu.call("fmi3GetAdjointDerivative", *arguments) == OK, self.fmu.messages
        return np.array(result)

    def difference(self, unknowns, known, direction, step) -> np.ndarray:
        """Five-point difference of the FMU's values along a direction of one variable."""
        start, values = self.fmu.get([known]), []
        for k in (-2, -1, 1, 2):
            self.set(known, start + k * step * np.ravel(direction))
            values.append(self.fmu.get(unknowns))
        self.set(known, start)
        return (values[0] - 8 * values[1] + 8 * values[2] - values[3]) / (12 * step)

    def set(self, name, values) -> None:
        assert self.fmu.set({name: values if self.shape(name) else values.item()}) == OK, self.fmu.messages

    def size_of(self, name, direction) -> float:
        """A size for moves along a direction: the value, or of matrix entries that of their diagonals."""
        entry = re.fullmatch(r"(.*)\[(\d),(\d)\]", name)
        if entry:
            return float(np.sqrt(np.prod(self.fmu.get([f"{entry[1]}[{i},{i}]" for i in entry.groups()[1:]]))))
        if len(self.shape(name)) == 2:
            rows = np.flatnonzero(direction.any(axis=1))
            return float(np.sqrt(np.prod(np.diag(self.fmu.array(name))[[rows[0], rows[-1]]])))
        return float(np.abs(self.fmu.get([name])).max())

    def kinds(self, names) -> np.ndarray:
        """A label for every element, the same for those of one size: a quantity, half of the states, a matrix's row."""
        labels = []
        for name in names:
            shape = self.shape(name)
            if name.startswith("der("):
                rates = shape[0] // 2 if shape else int(".x)" in name)
                labels += ["rate"] * rates + ["acceleration"] * (self.size([name]) - rates)
            elif len(shape) == 2:
                labels += [f"{name} {row}" for row in range(shape[0]) for _ in range(shape[1])]
            else:
                quantity = re.sub(r"\.(re|im)$", "", name).rsplit(".", 1)[-1]
                labels += ["alpha" if "alpha" in quantity else quantity] * int(np.prod(shape))
        return np.array(labels)

    def directions(self, name) -> list[np.ndarray]:
        """What a variable can be moved along: itself, each element, or symmetric pairs of entries of a matrix."""
        shape = self.shape(name)
        if len(shape) < 2:
            return list(np.eye(*shape)) if shape else [np.ones(1)]
        units = np.eye(shape[0])
        pairs = [(units[i], units[k]) for i in range(shape[0]) for k in range(i, shape[0])]
        return [np.maximum(np.outer(a, b), np.outer(b, a)) for a, b in pairs]

    def moved(self, seed=0):
        """States and inputs that are not zero, all at about their nominal values."""
        rng = np.random.default_rng(seed)
        if self.version == 3:
            nominal = float(self.fmu.variables["state"].nominal)
            states = {"state": nominal * rng.normal(size=self.fmu.shape["state"])}
        else:
            named = {v.name: v for v in self.fmu.unpacked.description.modelVariables}
            states = {n: float(named[n].nominal) * rng.normal() for n in self.states}
        assert self.fmu.set(states | {n: LEVELS.get(n, 1e-3) for n in self.inputs}) == OK, self.fmu.messages
