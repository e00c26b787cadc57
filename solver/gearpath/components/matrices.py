"""A structure known by its mass and stiffness matrices, such as a casing from a finite element code."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import scipy.sparse

from ..numerics.arrays import Real, Sparse
from .modal_model import named_rows
from .rigid_body import Vector
from .structure import Structure


@dataclass(frozen=True, eq=False)
class Matrices:
    """M x'' + (1 + i eta) K x = T^T f in N coordinates, SI. A degree of freedom of a port is one of q = T x.

    Dense matrices keep all their modes, sparse ones are reduced to what the frequencies need. Equal to any other of the
    same content.
    """

    mass: Real | Sparse  # (N, N), symmetric positive definite
    stiffness: Real | Sparse  # (N, N), symmetric positive semidefinite
    rigid_modes: Real  # (N, r), a basis of the null space of the stiffness
    ports: Mapping[str, Mapping[str, int]]  # port -> degree of freedom -> which of q
    places: Mapping[str, Vector] = field(default_factory=dict)  # m, of ports whose place is known
    modal_damping: float = 0.0
    loss_factor: float = 0.0
    motion: Real | None = None  # T (n, N); None for the unit matrix

    def position(self, port: str) -> Vector | None:
        """Place of a port, m; None where it is not known."""
        return self.places.get(port)

    def structure(
        self, dofs: Sequence[str], ports: Mapping[str, str | Vector], probes: Mapping[str, str | Vector] | None = None
    ) -> Structure:
        """The matrices with the rows of each of ports and probes, which name ports. Raises InputError for others."""
        size = int(self.mass.shape[0])

        def row(place: int) -> Real:
            return np.eye(1, size, place)[0] if self.motion is None else np.asarray(self.motion[place])

        shapes = {
            name: {dof: row(place) for dof, place in places.items() if dof in dofs}
            for name, places in self.ports.items()
        }
        rows = {key: named_rows(shapes, port, dofs, size) for key, port in {**ports, **(probes or {})}.items()}
        return Structure(
            self.mass, self.stiffness, self.rigid_modes, self.modal_damping, rows, loss_factor=self.loss_factor
        )

    @cached_property
    def _digest(self) -> bytes:
        plain = (
            sorted((name, sorted(dofs.items())) for name, dofs in self.ports.items()),
            sorted(self.places.items()),
            self.modal_damping,
            self.loss_factor,
        )
        content = hashlib.sha256(repr(plain).encode())
        for matrix in (self.mass, self.stiffness, *(() if self.motion is None else (self.motion,))):
            columns = scipy.sparse.csc_array(matrix)
            for part in (columns.data, columns.indices, columns.indptr):
                content.update(np.ascontiguousarray(part).tobytes())
        return content.digest()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Matrices) and self._digest == other._digest

    def __hash__(self) -> int:
        return hash(self._digest)
