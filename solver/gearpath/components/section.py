"""Cross-section of a round shaft, solid or hollow, constant or tapered."""

from dataclasses import dataclass
from math import pi


@dataclass(frozen=True)
class Section:
    """A stretch of shaft: length and diameters in m, which vary linearly to `outer_end` and `inner_end`.

    Where those are None the diameter is constant. Properties are those of the cross-section in the middle.
    """

    length: float
    outer: float
    inner: float = 0.0
    outer_end: float | None = None
    inner_end: float | None = None

    @property
    def tapered(self) -> bool:
        """Whether a diameter changes along the section."""
        return self.outer_end not in (None, self.outer) or self.inner_end not in (None, self.inner)

    def diameters(self, xi: float) -> tuple[float, float]:
        """Outer and inner diameter at xi = z/l in [0, 1], m."""
        outer = self.outer if self.outer_end is None else self.outer_end
        inner = self.inner if self.inner_end is None else self.inner_end
        return (1.0 - xi) * self.outer + xi * outer, (1.0 - xi) * self.inner + xi * inner

    def at(self, xi: float) -> "Section":
        """A constant section with the diameters at xi."""
        return Section(self.length, *self.diameters(xi))

    def part(self, start: float, end: float) -> "Section":
        """What lies between two places of the section, as parts of its length."""
        (outer, inner), (outer_end, inner_end) = self.diameters(start), self.diameters(end)
        return Section((end - start) * self.length, outer, inner, outer_end, inner_end)

    @property
    def area(self) -> float:
        """A = pi (D^2 - d^2) / 4, m^2."""
        outer, inner = self._middle
        return pi * (outer**2 - inner**2) / 4.0

    @property
    def area_moment(self) -> float:
        """I = pi (D^4 - d^4) / 64 about a diameter, m^4; the polar moment is 2 I."""
        outer, inner = self._middle
        return pi * (outer**4 - inner**4) / 64.0

    def cowper_coefficient(self, poisson_ratio: float) -> float:
        """Shear coefficient of the section (Cowper 1966), m = inner / outer.

        6 (1 + nu) (1 + m^2)^2 / ((7 + 6 nu) (1 + m^2)^2 + (20 + 12 nu) m^2): for nu = 0.3 it is 0.886 for a solid
        shaft and 0.533 for m = 0.9.
        """
        outer, inner = self._middle
        m2 = (inner / outer) ** 2
        wide, nu = (1.0 + m2) ** 2, poisson_ratio
        return 6.0 * (1.0 + nu) * wide / ((7.0 + 6.0 * nu) * wide + (20.0 + 12.0 * nu) * m2)

    @property
    def _middle(self) -> tuple[float, float]:
        return self.diameters(0.5) if self.tapered else (self.outer, self.inner)
