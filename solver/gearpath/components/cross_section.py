"""Cross-sections of beams: what an element asks of one, and round, rectangular and other bars."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, tanh
from typing import Protocol

from .section import Section

_TERMS = 40  # of the torsion series of a rectangle; the remainder is below 1e-10


class CrossSection(Protocol):
    """What bending in one plane asks of a section."""

    @property
    def area(self) -> float:
        """Area, m^2."""

    @property
    def area_moment(self) -> float:
        """Area moment, m^4."""


@dataclass(frozen=True)
class PlaneSection:
    """A section as bending in one plane sees it: area (m^2), area moment (m^4)."""

    area: float
    area_moment: float


@dataclass(frozen=True)
class BarSection:
    """A bar by its constants: area A (m^2), area moments and torsion constant (m^4).

    area_moments: the first resists deflection along axis 1, the second along axis 2; the polar inertia is rho times
    their sum. torsion_constant: the J of torque = G J times the twist per length.
    """

    area: float
    area_moments: tuple[float, float]
    torsion_constant: float

    @classmethod
    def round(cls, outer: float, inner: float = 0.0) -> BarSection:
        """A solid or hollow round bar; diameters, m."""
        section = Section(0.0, outer, inner)
        return cls(section.area, (section.area_moment,) * 2, 2.0 * section.area_moment)

    @classmethod
    def rectangle(cls, width_1: float, width_2: float) -> BarSection:
        """A solid rectangular bar; widths along axes 1 and 2, m.

        J = a b^3 (1/3 - 64 b / (pi^5 a) sum_odd tanh(n pi a / (2 b)) / n^5), a >= b (Saint-Venant; Timoshenko and
        Goodier, Theory of Elasticity, art. 109).
        """
        a, b = max(width_1, width_2), min(width_1, width_2)
        series = sum(tanh(n * pi * a / (2.0 * b)) / n**5 for n in range(1, 2 * _TERMS, 2))
        torsion = a * b**3 * (1.0 / 3.0 - 64.0 * b / (pi**5 * a) * series)
        moments = (width_2 * width_1**3 / 12.0, width_1 * width_2**3 / 12.0)
        return cls(width_1 * width_2, moments, torsion)

    def planes(self) -> tuple[PlaneSection, PlaneSection]:
        """The section as deflection along axis 1 and along axis 2 sees it."""
        first, second = self.area_moments
        return PlaneSection(self.area, first), PlaneSection(self.area, second)
