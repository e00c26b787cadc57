"""A flat rectangular plate, Mindlin in bending, with rigid footprints; free at all edges."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..errors import InputError
from ..numerics.arrays import Real
from .dofs import DOFS
from .footprint import Footprint
from .material import Material
from .plate_mesh import PlateMesh, mesh_plate
from .rigid_body import Vector
from .structure import Structure


@dataclass(frozen=True)
class Plate:
    """A plate of constant thickness about its middle surface; all lengths in m.

    centre: of the middle surface. axes: the two directions in the plate, orthonormal; the normal is their cross
    product. lengths: along these axes, and elements: along each, away from the footprints. footprint_elements: across
    each side of a rigid footprint.
    """

    material: Material
    centre: Vector
    lengths: tuple[float, float]
    thickness: float
    elements: tuple[int, int]
    axes: tuple[Vector, Vector] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    footprints: Mapping[str, Footprint] = field(default_factory=dict)
    footprint_elements: int = 4
    shear_coefficient: float = 5.0 / 6.0
    modal_damping: float = 0.0  # damping ratio of every elastic free-free mode
    loss_factor: float = 0.0

    def __hash__(self) -> int:
        plain = (self.material, self.centre, self.lengths, self.thickness, self.elements, self.axes)
        return hash((*plain, *self.footprints.items(), self.modal_damping, self.loss_factor))

    def position(self, footprint: str) -> Vector:
        """Centre of a footprint, m."""
        return self.footprints[footprint].centre

    def mesh(self, points: Sequence[Vector] = ()) -> PlateMesh:
        """Divide it into elements, with grid lines through the points."""
        return mesh_plate(self, points)

    def structure(
        self,
        dofs: Sequence[str],
        ports: Mapping[str, str | Vector],
        probes: Mapping[str, str | Vector] | None = None,
    ) -> Structure:
        """Assemble the free plate: sparse matrices, six rigid modes, and a row of ports for each of ports and probes.

        A port is the name of a footprint or a point (m, global axes) within the thickness of the plate. Ports draw grid
        lines through their points; probes (sensors, forces) leave the grid alone and are read from the shape functions
        of the element they fall in. All six degrees of freedom are kept; ports are zero where `dofs` leaves them out.

        Raises InputError where a footprint is unknown or a point not on the plate.
        """
        asked = {**ports, **(probes or {})}
        for name, spot in asked.items():
            if isinstance(spot, str) and spot not in self.footprints:
                known = ", ".join(self.footprints) or "none"
                raise InputError(f"port {name!r}: the plate has no footprint {spot!r} (it has: {known})")
        meshed = self.mesh([spot for spot in ports.values() if not isinstance(spot, str)])
        active = np.array([dof in dofs for dof in DOFS])[:, None]
        rows: dict[str, Real] = {name: active * meshed.motion(spot) for name, spot in asked.items()}
        mesh = meshed.nodes
        return Structure(
            mesh.mass,
            mesh.stiffness,
            mesh.rigid_modes(np.array(self.centre)),
            self.modal_damping,
            rows,
            loss_factor=self.loss_factor,
        )
