"""Directional and adjoint derivatives: against differences of the FMU's own values, and the state equations.

Time outputs, state derivatives and A, B, C, D are polynomials of every input, state and parameter, of degree 3 at most, for
which the five-point difference has no error but rounding.
"""

import xml.etree.ElementTree as ET

import fmu_oracle as oracle
import numpy as np
import pytest
from fmi3_driver import Fmu3
from fmu_driver import ERROR, OK, Fmu, reals
from fmu_helpers import ROOT, export, stale
from fmu_networks import CHANGES, changed, gearbox
from fmu_piecewise import in_entries

import gearpath as gp

LEVELS = {"mesh.transmission_error": 1.3e-6, "mesh.force": 11.0, "actuators.shaker": -7.0}
MATRICES = ("system.A", "system.B", "system.C", "system.D")


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
        result = (ct_double * self.size(unknowns))()
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
        result, weights = (ct_double * self.size(knowns))(), reals(weights)
        arguments = [self.fmu.references(unknowns), len(unknowns), self.fmu.references(knowns), len(knowns)]
        arguments += [weights, len(weights), result, len(result)]
        assert self.fmu.call("fmi3GetAdjointDerivative", *arguments) == OK, self.fmu.messages
        return np.array(result)

    def difference(self, unknowns, known, direction, step) -> np.ndarray:
        """Five-point difference of the FMU's values along a direction of one variable."""
        start, values = self.fmu.get([known]), []
        for k in (-2, -1, 1, 2):
            assert self.fmu.set({known: start + k * step * np.ravel(direction)}) == OK, self.fmu.messages
            values.append(self.fmu.get(unknowns))
        assert self.fmu.set({known: start}) == OK
        return (values[0] - 8 * values[1] + 8 * values[2] - values[3]) / (12 * step)

    def directions(self, name):
        """Directions a variable can move in: 1, unit vectors, or symmetric matrices of one or two entries."""
        shape = self.shape(name)
        if len(shape) < 2:
            return list(np.eye(shape[0])) if shape else [np.ones(1)]
        units = [(i, k) for i in range(shape[0]) for k in range(i, shape[0])]
        return [np.sign(np.outer(np.eye(shape[0])[i], np.eye(shape[0])[k]) * 1.0 + np.outer(np.eye(shape[0])[k], np.eye(shape[0])[i])) for i, k in units]
