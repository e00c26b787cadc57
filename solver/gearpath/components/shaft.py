"""A shaft as it is described: material, sections, disks, and how finely to divide it."""

from dataclasses import dataclass

import numpy as np

from ..numerics.arrays import Real
from .material import Material
from .section import Section

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Disk:
    """A rigid gear body on a shaft: z from the shaft's first end (m), mass (kg), inertias (kg m^2)."""

    name: str
    z: float
    mass: float
    diametral_inertia: float
    polar_inertia: float

    def inertia(self) -> Real:
        """Diagonal of the mass matrix on ux uy uz rx ry rz."""
        return np.array([self.mass] * 3 + [self.diametral_inertia] * 2 + [self.polar_inertia])


@dataclass(frozen=True)
class Shaft:
    """A straight shaft along +z from `origin` (m), of round sections, with disks."""

    material: Material
    origin: Vector
    sections: tuple[Section, ...]
    shear_coefficient: float | None  # None: Cowper's of each section
    elements: tuple[int, ...]  # elements of each span between stations; one number holds for every span
    disks: tuple[Disk, ...] = ()
    beam: str = "timoshenko"  # a key of beam.BEAMS

    @property
    def length(self) -> float:
        """Total length, m."""
        return sum(section.length for section in self.sections)

    def shear_coefficient_of(self, section: Section) -> float:
        """The shear coefficient of one of the sections: the shaft's own, or Cowper's."""
        given = self.shear_coefficient
        return section.cowper_coefficient(self.material.poisson_ratio) if given is None else given

    def position(self, z: float) -> Vector:
        """Global position of the station z."""
        x0, y0, z0 = self.origin
        return (x0, y0, z0 + z)

    def disk(self, name: str) -> Disk:
        """The disk of that name."""
        return next(disk for disk in self.disks if disk.name == name)


@dataclass(frozen=True)
class ShaftPoint:
    """A point on the axis of a shaft, z from its first end (m)."""

    shaft: str
    z: float
