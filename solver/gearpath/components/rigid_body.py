"""Rigid casing: six coordinates of its centre of gravity, less those that no active port degree of freedom sees."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..numerics.arrays import Real
from .dofs import DOFS, rigid_motion
from .structure import Structure

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class RigidBody:
    """Mass (kg), inertia about the centre of gravity (kg m^2, keys xx yy zz and optionally xy xz yz), position (m)."""

    mass: float
    inertia: Mapping[str, float]
    centre_of_gravity: Vector = (0.0, 0.0, 0.0)
    modal_damping: float = field(default=0.0, init=False, repr=False)  # a rigid body has no elastic modes

    def __hash__(self) -> int:
        return hash((self.mass, *self.inertia.items(), self.centre_of_gravity))

    def inertia_matrix(self) -> Real:
        """Mass matrix of all six coordinates (6 x 6); off-diagonal inertias are the tensor's own elements."""
        M = np.diag([self.mass] * 3 + [0.0] * 3)
        for name, value in self.inertia.items():
            i, k = (3 + "xyz".index(axis) for axis in name)
            M[i, k] = M[k, i] = value
        return M

    def structure(
        self, dofs: Sequence[str], ports: Mapping[str, Vector], probes: Mapping[str, Vector] | None = None
    ) -> Structure:
        """Rows of all points (Eq. 17, all six degrees of freedom) on the coordinates that they reach.

        The port "cg" is always there. A planar port set (uy, rx) keeps uy, rx and rz, as in Eq. 15.
        """
        active = np.array([dof in dofs for dof in DOFS])
        points = {**ports, **(probes or {})}
        offsets = {name: np.subtract(point, self.centre_of_gravity) for name, point in points.items()}
        rows = {name: active[:, None] * rigid_motion(offset) for name, offset in offsets.items()}
        M = self.inertia_matrix()
        reached = np.any([abs(row).any(axis=0) for row in (*rows.values(), np.diag(active))], axis=0)
        for _ in DOFS:  # products of inertia drag further coordinates along
            reached |= (M != 0.0) @ reached
        kept = np.flatnonzero(reached)
        seen = {name: row[:, kept] for name, row in rows.items()}
        seen["cg"] = np.eye(6)[:, kept]
        return Structure(
            mass=M[np.ix_(kept, kept)],
            stiffness=np.zeros((len(kept), len(kept))),
            rigid_modes=np.eye(len(kept)),
            modal_damping=0.0,
            ports=seen,
        )

    def coordinates(self, structure: Structure) -> tuple[str, ...]:
        """Names of the coordinates that `structure` kept, such as ("uy", "rx", "rz")."""
        return tuple(dof for dof, row in zip(DOFS, structure.ports["cg"]) if row.any())
