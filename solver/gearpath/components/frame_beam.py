"""A straight beam of a frame, in any direction: its elements in global axes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from ..numerics.arrays import Real
from .beam import PLANES, beam_element
from .cross_section import BarSection
from .material import Material
from .node_mesh import NodeMesh, scatter
from .rigid_body import Vector

_TWIST = [5, 11]


@dataclass(frozen=True)
class FrameBeam:
    """A uniform beam between two places of a frame, in equal elements.

    between: names of frame nodes or "plate.footprint". orientation: any direction (global axes) not along the beam;
    axis 1 of the section is its part across the beam, axis 2 completes the right-handed set (1, 2, along). Left out:
    the global axis most nearly across the beam; round sections need none. beam: a key of beam.BEAMS.
    """

    between: tuple[str, str]
    material: Material
    section: BarSection
    shear_coefficient: float
    elements: int
    orientation: Vector | None = None
    beam: str = "timoshenko"

    def mesh(self, name: str, start: Real, end: Real) -> NodeMesh:
        """Nodes from start to end (m), elements + 1 of them, and the matrices in global axes."""
        axes = self._axes(name, end - start)
        length = float(np.linalg.norm(end - start)) / self.elements
        turn = np.kron(np.eye(4), axes)
        nodes = np.arange(self.elements)[:, None] + np.arange(2)
        K, M = (
            scatter(np.tile(turn.T @ matrix @ turn, (self.elements, 1, 1)), nodes, self.elements + 1)
            for matrix in self._element(length)
        )
        return NodeMesh(np.linspace(start, end, self.elements + 1), M, K)

    def _axes(self, name: str, along: Real) -> Real:
        """Axes 1 and 2 of the section and the direction of the beam, as rows; raises InputError where undefined."""
        length = float(np.linalg.norm(along))
        if length == 0.0:
            raise InputError(
                f"beam {name!r}: both ends lie at the same point; move {self.between[0]!r} or the other end"
            )
        along = along / length
        wish = np.eye(3)[np.argmin(abs(along))] if self.orientation is None else np.array(self.orientation, float)
        across = wish - along * (along @ wish)
        if np.linalg.norm(across) <= 1e-6 * np.linalg.norm(wish):
            raise InputError(f"beam {name!r}: orientation {self.orientation} lies along the beam; give one across it")
        across = across / np.linalg.norm(across)
        return np.array([across, np.cross(along, across), along])

    def _element(self, length: float) -> tuple[Real, Real]:
        """Stiffness and mass (12 x 12) in the beam's own axes: each plane with its own moment, and the true torsion."""
        parts = [
            beam_element(self.beam, plane, self.material, length, self.shear_coefficient)
            for plane in self.section.planes()
        ]
        second, twist = np.ix_(PLANES[1][0], PLANES[1][0]), np.ix_(_TWIST, _TWIST)
        K, M = (matrix.copy() for matrix in parts[0])
        for into, matrix in zip((K, M), parts[1]):
            into[second] = matrix[second]
        rigidity = self.material.shear_modulus * self.section.torsion_constant
        inertia = self.material.density * sum(self.section.area_moments)
        K[twist] = rigidity / length * np.array([[1.0, -1.0], [-1.0, 1.0]])
        M[twist] = inertia * length / 6.0 * np.array([[2.0, 1.0], [1.0, 2.0]])
        return K, M
