"""A joint: full symmetric stiffness and damping between two ports on its degrees of freedom (Eq. 13 and 14)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .mounting import Mounting

Vector = tuple[float, float, float]
Matrix = tuple[tuple[float, ...], ...]
RIGID = "rigid"  # the kind that holds two ports together exactly; it has no matrices, and () holds all common `dofs`


@dataclass(frozen=True)
class Port:
    """Where something is attached: a component, and on a gear train the shaft with a station or a disk.

    `Port("ground")` is the ground; `Port("casing")` a rigid body or plate, at the place that the joint gives.
    """

    component: str
    shaft: str | None = None
    z: float | None = None  # station from the shaft's first end, m
    disk: str | None = None  # instead of z: the station of this disk
    place: str | None = None  # on a plate its footprint, on a frame its node or "plate.footprint"

    @property
    def is_ground(self) -> bool:
        """Whether the port does not move."""
        return self.component == "ground"


@dataclass(frozen=True)
class Joint:
    """Bearing, mount or bolted joint between two ports; matrices in SI units on `dofs`, which may be singular.

    `at` is the place on the rigid body; None where the other end is a shaft station, which then gives it.
    """

    kind: str  # "bearing" | "mount" | "beam_joint" | "rigid"
    between: tuple[Port, Port]  # source, receiver: the joint's force acts on the receiver
    dofs: tuple[str, ...]
    stiffness: Matrix
    damping: Matrix
    at: Vector | None = None
    scalar: bool = False  # given as one number (a mount's axial stiffness)
    loss_factor: float = 0.0  # eta of (1 + i eta) K
    offset: Vector | None = None  # from the source's port to the receiver's, along which its motion is carried rigidly
    mounting: Mounting | None = None  # of a rolling bearing, which decides the matrices
