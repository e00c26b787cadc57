"""Difference quotients of a running model, and how far they can be trusted.

The knowns are moved one element at a time. Central differences with two step sizes h and 10 h; their difference tells
how far the smaller can be trusted, so that a nonlinear model is not accused of its own curvature.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .contents import Fmu, Variable
from .instance import Values
from .probe_point import Point

STEP = 1e-4  # of the scale of the known


@dataclass(frozen=True)
class Slopes:
    """Difference quotients of all elements of the unknowns by all elements of the knowns."""

    unknowns: list[Variable]
    knowns: list[Variable]
    rows: list[slice]  # of the elements of each unknown
    columns: list[slice]
    matrix: Values  # (elements of unknowns, elements of knowns)
    trust: Values  # how far each quotient may be off
    scale: Values  # of the elements of the knowns


def quotients(point: Point, unknowns: list[Variable], knowns: list[Variable]) -> Slopes:
    """At a point, which is left as it was."""
    rows, columns = ranges(point.fmu, unknowns), ranges(point.fmu, knowns)
    columns_of, trusts, scales = [], [], []
    for known in knowns:
        base, scale = point.values[known.name], point.scale(known)
        for element in range(len(base)):
            fine, rough = (_quotient(point, unknowns, known, element, k * STEP * scale) for k in (1.0, 10.0))
            size = abs(point.instance.get(unknowns))
            rounding = 1e3 * np.finfo(float).eps * size / (STEP * scale)
            columns_of.append(fine)
            trusts.append(10.0 * abs(fine - rough) + 1e-6 * abs(fine) + rounding)
            scales.append(scale)
    shape = (rows[-1].stop if rows else 0, 0)
    matrix = np.array(columns_of).T if columns_of else np.zeros(shape)
    trust = np.array(trusts).T if trusts else np.zeros(shape)
    return Slopes(unknowns, knowns, rows, columns, matrix, trust, np.array(scales))


def _quotient(point: Point, unknowns: list[Variable], known: Variable, element: int, step: float) -> Values:
    base, found = point.values[known.name], []
    for side in (1.0, -1.0):
        moved = base.copy()
        moved[element] += side * step
        point.put(known, moved)
        found.append(point.instance.get(unknowns))
    point.put(known, base)
    return (found[0] - found[1]) / (2.0 * step)


def ranges(fmu: Fmu, variables: list[Variable]) -> list[slice]:
    """Where the elements of each variable are in a vector of all."""
    ends = np.cumsum([0, *(fmu.size(v) or 1 for v in variables)])
    return [slice(int(a), int(b)) for a, b in pairwise(ends)]
