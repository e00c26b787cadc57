"""One rolling bearing at work: its state, every element's load, stiffness over the load and over the cage's position.

Matrices are K = d(load)/d(displacement) on ux, uy, uz, rx, ry, rz: N/m, N/rad (= N m/m), N m/rad.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ..errors import GearpathError
from ..joints.bearings import BallBearing, BearingStack, Equilibrium, RollerBearing, RollingBearing
from ..joints.bearings.checks import DOFS
from ..numerics.arrays import Real

FACTORS = (0.1, 0.2, 0.3, 0.5, 1.0, 1.5, 2.0, 3.0)  # of the given load: the rows of the table
FINE = tuple(sorted({*FACTORS, 0.14, 0.25, 0.4, 0.7, 0.85, 1.25, 1.75, 2.5}))  # the points of the curves
SAMPLES = 16  # positions of the cage
ROUNDING = 1e-9  # of sqrt(K_ii K_jj): a smaller entry is what the equilibrium's tolerance left of zero
UNITS = {"load": ("N", "N m"), "displacement": ("m", "rad")}


@dataclass(frozen=True)
class Element:
    """A rolling element: row from 1, number in its row from 1, angle from +x towards +y."""

    row: int
    number: int
    position: float  # rad, 0 to 2 pi
    load: float  # N
    contact_angle: float  # rad; of a free element, where it would touch


@dataclass(frozen=True)
class Curve:
    """Stiffness while what loads the bearing grows; NaN where it cannot be carried."""

    over: str  # "load", "displacement", "preload", "torque"
    unit: str  # of `values`; "1" where forces and moments are mixed: then they are the factors
    factors: Real  # (T,), of what was given
    values: Real  # (T,)
    stiffness: Real  # (T, 6, 6)

    def rows(self, factors: Sequence[float] = FACTORS) -> list[int]:
        """Where these factors stand."""
        return [int(k) for k in np.flatnonzero(np.isin(self.factors, factors))]


@dataclass(frozen=True)
class Phases:
    """Stiffness over the positions of the cage, at the same load (or displacement, where that is given)."""

    stiffness: Real  # (n, 6, 6), cages turned on by parts 0, 1/n, 2/n ... of the distance of two elements

    @property
    def average(self) -> Real:
        """(6, 6)."""
        return np.asarray(self.stiffness.mean(axis=0))

    @property
    def diagonal(self) -> tuple[Real, Real]:
        """Smallest and largest value of every diagonal entry, (6,) each."""
        entries = np.diagonal(self.stiffness, axis1=1, axis2=2)
        return entries.min(axis=0), entries.max(axis=0)


@dataclass(frozen=True)
class Case:
    """A bearing with all that is known about its work."""

    name: str
    bearing: RollingBearing
    over: str  # what decides its state: "load", "displacement", "preload", "torque"
    given: Mapping[str, float]  # its values by name, SI
    state: Equilibrium
    source: str = ""  # of the geometry's numbers
    curve: Curve | None = None
    phases: Phases | None = None
    preload: float = 0.0  # N, beside a load or displacement

    @property
    def free(self) -> tuple[str, ...]:
        """Degrees of freedom along which the bearing moved freely under its load; the others were held."""
        return tuple(self.given) if self.over == "load" else ()


def rows_of(bearing: RollingBearing, place: float = 0.0) -> Iterator[tuple[BallBearing | RollerBearing, float]]:
    """Every row of elements with its z (m), in the order of `element_loads`."""
    if isinstance(bearing, BearingStack):
        for each, z in zip(bearing.bearings, bearing.positions):
            yield from rows_of(each, place + z)
    elif isinstance(bearing, (BallBearing, RollerBearing)):
        yield bearing, place


def elements(bearing: RollingBearing, state: Equilibrium) -> list[Element]:
    """The load distribution: Q_j and contact angle of every element at psi_j = phase + 2 pi j / Z."""
    found: list[Element] = []
    for k, (row, _) in enumerate(rows_of(bearing), start=1):
        for j in range(row.elements):
            position = float(np.mod(row.phase + 2.0 * np.pi * j / row.elements, 2.0 * np.pi))
            at = len(found)
            load, angle = float(state.element_loads[at]), float(state.contact_angles[at])
            found.append(Element(k, j + 1, position, load, angle))
    return found


def geometry(row: BallBearing | RollerBearing) -> dict[str, float | int | str]:
    """Geometry of a row as its constructor takes it, SI, with its contact constant Kn, N/m^n."""
    numbers = {item.name: getattr(row, item.name) for item in fields(row)}
    constant, exponent = row.scale
    kept = {name: value for name, value in numbers.items() if isinstance(value, (int, float, str))}
    kind = "ball" if isinstance(row, BallBearing) else "roller"
    return {"type": kind, **kept, "contact_stiffness": constant, "contact_exponent": exponent}


def unit(i: int, j: int) -> str:
    """Unit of K_ij."""
    if (i < 3) == (j < 3):
        return "N/m" if i < 3 else "N m/rad"
    return "N/rad" if i < 3 else "N m/m"


def strength(stiffness: Real) -> Real:
    """|K_ij| / sqrt(K_ii K_jj), 0 to 1, (..., 6, 6); 0 where a diagonal entry is."""
    size = np.sqrt(np.maximum(np.diagonal(stiffness, axis1=-2, axis2=-1), 0.0))
    scale = size[..., :, None] * size[..., None, :]
    return np.asarray(np.divide(np.abs(stiffness), scale, out=np.zeros_like(stiffness), where=scale > 0.0))


def shown(stiffness: Real) -> Real:
    """The matrix with rounding (entries below 1e-9 of the geometric mean of their diagonal entries) set to zero."""
    return np.where(strength(stiffness) > ROUNDING, stiffness, 0.0)


def carried(case: Case) -> Real:
    """The load (6,) without what is rounding: 1e-11 of the largest, 1e-13 of the element loads that cancel."""
    load, lever = case.state.load, case.bearing.lever
    forces = np.abs(load) / np.array([1.0, 1.0, 1.0, lever, lever, lever])
    return np.where(forces > max(1e-11 * forces.max(), 1e-13 * case.state.element_loads.sum()), load, 0.0)


def diagonal(stiffness: Real) -> list[int]:
    """Degrees of freedom that have stiffness somewhere in (T, 6, 6)."""
    entries = np.nan_to_num(np.diagonal(stiffness, axis1=1, axis2=2)).max(axis=0)
    return [k for k in range(6) if entries[k] > 0.0]


def couplings(stiffness: Real, least: float = 1e-3) -> list[tuple[int, int]]:
    """Entries i < j that anywhere in (T, 6, 6) reach `least` of sqrt(K_ii K_jj), the strongest first."""
    most = strength(np.nan_to_num(stiffness)).max(axis=0)
    pairs: list[tuple[int, int]] = [(i, j) for i, j in combinations(range(6), 2) if most[i, j] >= least]
    return sorted(pairs, key=lambda pair: -round(float(most[pair]), 6))


def entry(i: int, j: int) -> str:
    """Name of K_ij: `ux`, `uy rx`."""
    return DOFS[i] if i == j else f"{DOFS[i]} {DOFS[j]}"


def measure(over: str, given: Mapping[str, float]) -> tuple[float, str]:
    """Size and unit of a load or displacement; 1 and "1" where it mixes translations with rotations."""
    values = {name: value for name, value in given.items() if value}
    turns = {name[0] == "r" for name in values}
    if len(turns) != 1:
        return 1.0, "1"
    return float(np.linalg.norm(list(values.values()))), UNITS[over][turns.pop()]


def scaled(given: Mapping[str, float], factor: float) -> dict[str, float]:
    """A load or displacement times a factor."""
    return {name: factor * value for name, value in given.items()}


def curve_over(
    over: str, size: float, unit_: str, at: Callable[[float], Equilibrium], factors: Sequence[float] = FINE
) -> Curve:
    """Stiffness at each factor of what was given, whose size is `size`; NaN where the bearing does not carry it."""
    return Curve(over, unit_, np.array(factors), size * np.array(factors), np.array([_tried(at, f) for f in factors]))


def _tried(at: Callable[[float], Equilibrium], factor: float) -> NDArray[np.float64]:
    try:
        return at(factor).stiffness
    except GearpathError:
        return np.full((6, 6), np.nan)
