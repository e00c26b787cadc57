"""A frame: beams and plates joined at named places into one free structure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..numerics.arrays import Real
from .dofs import DOFS
from .frame_beam import FrameBeam
from .frame_mesh import frame_place, mesh_frame
from .node_mesh import NodeMesh
from .plate import Plate
from .rigid_body import RigidBody, Vector
from .structure import Structure


@dataclass(frozen=True)
class Frame:
    """Beams and plates of one free structure.

    A place is a node of the frame or a footprint of one of its plates, "plate.footprint"; beams join places rigidly.
    links: pairs of places held together by rigid massless arms. bodies: rigid bodies fixed to places. The damping is
    that of the frame; its plates give none of their own.
    """

    nodes: Mapping[str, Vector]  # m
    beams: Mapping[str, FrameBeam]
    plates: Mapping[str, Plate] = field(default_factory=dict)
    links: tuple[tuple[str, str], ...] = ()
    bodies: Mapping[str, RigidBody] = field(default_factory=dict)  # by place
    modal_damping: float = 0.0  # damping ratio of every elastic free-free mode
    loss_factor: float = 0.0

    def __hash__(self) -> int:
        parts = (self.nodes, self.beams, self.plates, self.bodies)
        named = tuple(item for part in parts for item in part.items())
        return hash((named, self.links, self.modal_damping, self.loss_factor))

    def position(self, place: str) -> Vector:
        """Position of a node or of a plate's footprint, m."""
        if place in self.nodes:
            return self.nodes[place]
        plate, footprint = place.split(".")
        return self.plates[plate].position(footprint)

    def mesh(self) -> NodeMesh:
        """Assemble it; raises InputError for unknown places and for parts that hang together with nothing."""
        return mesh_frame(self)

    def structure(
        self, dofs: Sequence[str], ports: Mapping[str, str], probes: Mapping[str, str] | None = None
    ) -> Structure:
        """The free frame: sparse matrices, six rigid modes, and rows for each of ports and probes, which name places.

        All six degrees of freedom are kept; ports are zero where `dofs` leaves them out. Raises InputError for an
        unknown place and for parts that hang together with nothing.
        """
        mesh = self.mesh()
        active = np.array([dof in dofs for dof in DOFS])[:, None]
        rows: dict[str, Real] = {
            name: active * mesh.motion(frame_place(self, f"port {name!r}", place))
            for name, place in {**ports, **(probes or {})}.items()
        }
        centre = mesh.positions.mean(axis=0)
        return Structure(
            mesh.mass,
            mesh.stiffness,
            mesh.rigid_modes(centre),
            self.modal_damping,
            rows,
            loss_factor=self.loss_factor,
        )
