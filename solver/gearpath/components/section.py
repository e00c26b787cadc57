"""Cross-section of a round shaft, solid or hollow."""

from dataclasses import dataclass
from math import pi


@dataclass(frozen=True)
class Section:
    """A stretch of shaft of constant cross-section: length and diameters in m."""

    length: float
    outer: float
    inner: float = 0.0

    @property
    def area(self) -> float:
        """A = pi (D^2 - d^2) / 4, m^2."""
        return pi * (self.outer**2 - self.inner**2) / 4.0

    @property
    def area_moment(self) -> float:
        """I = pi (D^4 - d^4) / 64 about a diameter, m^4; the polar moment is 2 I."""
        return pi * (self.outer**4 - self.inner**4) / 64.0

    def cowper_coefficient(self, poisson_ratio: float) -> float:
        """Shear coefficient of the section (Cowper 1966), m = inner / outer.

        6 (1 + nu) (1 + m^2)^2 / ((7 + 6 nu) (1 + m^2)^2 + (20 + 12 nu) m^2): for nu = 0.3 it is 0.886 for a solid
        shaft and 0.533 for m = 0.9.
        """
        m2 = (self.inner / self.outer) ** 2
        wide, nu = (1.0 + m2) ** 2, poisson_ratio
        return 6.0 * (1.0 + nu) * wide / ((7.0 + 6.0 * nu) * wide + (20.0 + 12.0 * nu) * m2)
