"""Sparse finite element matrices on nodes with six coordinates each, and nodes that follow others rigidly."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import block_diag, coo_array, csc_array

from ..numerics.arrays import Real, Sparse
from .dofs import rigid_motion

Nodes = NDArray[np.intp]


@dataclass(frozen=True)
class Place:
    """A named point that moves rigidly with a node."""

    node: int
    position: Real  # m


@dataclass(frozen=True)
class NodeMesh:
    """Matrices on ux uy uz rx ry rz (global axes) of n nodes, node by node."""

    positions: Real  # (n, 3), m
    mass: Sparse  # (6n, 6n)
    stiffness: Sparse
    places: Mapping[str, Place] = field(default_factory=dict)

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return 6 * len(self.positions)

    def rigid_modes(self, reference: Real) -> Real:
        """The six rigid motions about a reference point, (6n, 6)."""
        return rigid_motions(self.positions - reference).reshape(-1, 6)

    def motion(self, place: str) -> Real:
        """Motion of a place from the coordinates, (6, 6n)."""
        spot = self.places[place]
        rows = np.zeros((6, self.size))
        columns = slice(6 * spot.node, 6 * spot.node + 6)
        rows[:, columns] = rigid_motion(spot.position - self.positions[spot.node])
        return rows


def rigid_motions(offsets: Real) -> Real:
    """`rigid_motion` of many offsets (n, 3) at once: (n, 6, 6)."""
    out = np.tile(np.eye(6), (len(offsets), 1, 1))
    x, y, z = offsets.T
    out[:, 0, 4], out[:, 0, 5], out[:, 1, 5] = z, -y, x
    out[:, 1, 3], out[:, 2, 3], out[:, 2, 4] = -z, y, -x
    return out


def scatter(matrices: Real, nodes: Nodes, count: int) -> Sparse:
    """Sum matrices (e, 6k, 6k) of elements with the given nodes (e, k) into a sparse one of `count` nodes."""
    columns = (6 * nodes[:, :, None] + np.arange(6)).reshape(len(nodes), 6 * nodes.shape[1])
    rows, cols = np.broadcast_arrays(columns[:, :, None], columns[:, None, :])
    entries = (matrices.ravel(), (rows.ravel(), cols.ravel()))
    return csc_array(coo_array(entries, shape=(6 * count, 6 * count)))


def follow(mesh: NodeMesh, leaders: Nodes) -> tuple[NodeMesh, Sparse]:
    """Let each node follow its leader rigidly: q = T q', K' = T^T K T, M' = T^T M T; (mesh of the leaders, T).

    leaders holds one node a node; a node that is its own leader is free.
    """
    kept, place_of = np.unique(leaders, return_inverse=True)
    blocks = rigid_motions(mesh.positions - mesh.positions[leaders])
    rows = np.broadcast_to(np.arange(mesh.size).reshape(-1, 6, 1), blocks.shape)
    cols = np.broadcast_to((6 * place_of[:, None] + np.arange(6))[:, None, :], blocks.shape)
    filled = blocks != 0.0
    shape = (mesh.size, 6 * len(kept))
    T = csc_array(coo_array((blocks[filled], (rows[filled], cols[filled])), shape=shape))
    places = {name: Place(int(place_of[spot.node]), spot.position) for name, spot in mesh.places.items()}
    led = NodeMesh(mesh.positions[kept], _congruent(mesh.mass, T), _congruent(mesh.stiffness, T), places)
    return led, T


def side_by_side(meshes: Sequence[NodeMesh]) -> tuple[NodeMesh, Nodes]:
    """All meshes as one, unconnected, and the first node of each; their places keep their names."""
    ends = np.cumsum([len(mesh.positions) for mesh in meshes])
    starts = np.concatenate([[0], ends[:-1]])
    places = {
        name: Place(int(start) + spot.node, spot.position)
        for mesh, start in zip(meshes, starts)
        for name, spot in mesh.places.items()
    }
    M, K = (
        csc_array(block_diag(matrices))
        for matrices in ([mesh.mass for mesh in meshes], [mesh.stiffness for mesh in meshes])
    )
    return NodeMesh(np.vstack([mesh.positions for mesh in meshes]), M, K, places), starts


def _congruent(matrix: Sparse, T: Sparse) -> Sparse:
    product = csc_array(T.T @ matrix @ T)
    return csc_array((product + product.T) / 2.0)
