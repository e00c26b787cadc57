"""Stiffness and mass of the casing with a node of six coordinates at every seat and foot, written as casing.npz."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy.linalg
import scipy.sparse
import skfem
from casing_mesh import FEET, FOOT_SIZE, SEATS, casing_mesh
from skfem.models.poisson import mass as products

YOUNG, POISSON, DENSITY = 1.1e11, 0.26, 7200.0  # grey cast iron: Pa, 1, kg/m^3
NODES = {name: 900_001 + k for k, name in enumerate((*SEATS, *FEET))}  # numbers in the file
PLACES = {name: (bore.x, 0.0, z) for name, (bore, z) in SEATS.items()} | FEET
Sparse = scipy.sparse.csc_array


@dataclass(frozen=True)
class Casing:
    """K, M (n, n) of the coordinates q; u = T q (3 N,) moves the nodes of the mesh: x y z of one after another."""

    size: float  # m, of the elements
    mesh: skfem.MeshHex
    positions: np.ndarray  # (N, 3), m, corners of the mesh first
    stiffness: Sparse
    mass: Sparse
    T: Sparse
    numbers: np.ndarray  # (n,) of the node of each coordinate
    directions: np.ndarray  # (n,) 1 to 6

    def rows(self, name: str) -> np.ndarray:
        """The six coordinates of a seat or foot."""
        return np.flatnonzero(self.numbers == NODES[name])

    def rigid(self) -> np.ndarray:
        """Rigid motions (n, 6) about the origin: three displacements, three rotations."""
        places = np.vstack([self.positions, [PLACES[name] for name in NODES]])
        known = np.append(np.arange(1, len(self.positions) + 1), list(NODES.values()))
        motions = rigid_motions(places).reshape(len(places), 3, 6)
        row = np.searchsorted(known, self.numbers)
        turning = np.hstack([np.zeros((3, 3)), np.eye(3)])[(self.directions - 1) % 3]
        return np.where((self.directions > 3)[:, None], turning, motions[row, (self.directions - 1) % 3])

    def write(self, path: Path) -> None:
        """As `kind = "matrices"` reads it: one triangle of each matrix, and where its nodes are."""
        arrays = {}
        for name, matrix in (("stiffness", self.stiffness), ("mass", self.mass)):
            half = scipy.sparse.coo_array(scipy.sparse.triu(matrix))
            arrays |= {f"{name}_row": half.row, f"{name}_column": half.col, f"{name}_value": half.data}
        nodes = np.append(np.arange(1, len(self.positions) + 1), list(NODES.values()))
        positions = np.vstack([self.positions, [PLACES[name] for name in NODES]])
        path.parent.mkdir(parents=True, exist_ok=True)
        own = {"dof_nodes": self.numbers, "dof_directions": self.directions}
        np.savez(path, **arrays, **own, nodes=nodes, positions=positions)


def casing(size: float, rigid_seats: bool = True) -> Casing:
    """Mesh, assemble, couple. The outer rings keep the bores round, or (`rigid_seats` false) press on them evenly."""
    mesh = casing_mesh(size)
    basis = skfem.Basis(mesh, skfem.ElementHexS2(), intorder=4)
    K, M = solid(basis)
    positions = basis.doflocs.T
    T, numbers, directions = coupling(basis, positions, rigid_seats)
    return Casing(size, mesh, positions, reduced(K, T), reduced(M, T), T, numbers, directions)


def solid(basis: skfem.CellBasis) -> tuple[Sparse, Sparse]:
    """K and M (3 N, 3 N) of isotropic elasticity from scalar matrices D_ij = integral of d_i a d_j b.

    K_ij = lambda D_ij + mu D_ji + delta_ij mu (D_11 + D_22 + D_33)
    """
    lame, shear = YOUNG * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON)), 0.5 * YOUNG / (1.0 + POISSON)
    D = {}
    for i in range(3):
        for j in range(i, 3):
            form = skfem.BilinearForm(lambda b, a, _, i=i, j=j: a.grad[i] * b.grad[j])
            D[i, j] = scipy.sparse.csc_array(form.assemble(basis))
            D[j, i] = D[i, j].T
    laplace = D[0, 0] + D[1, 1] + D[2, 2]
    blocks = [[lame * D[i, j] + shear * D[j, i] + (i == j) * shear * laplace for j in range(3)] for i in range(3)]
    N = laplace.shape[0]
    order = np.arange(3 * N).reshape(3, N).T.ravel()  # x y z of one node after another
    K = scipy.sparse.csc_array(scipy.sparse.block_array(blocks))[order][:, order]
    return K, scipy.sparse.csc_array(scipy.sparse.kron(DENSITY * products.assemble(basis), np.eye(3)))


def reduced(matrix: Sparse, T: Sparse) -> Sparse:
    """T^T A T, symmetric to the last digit."""
    product = T.T @ matrix @ T
    return scipy.sparse.csc_array(0.5 * (product + product.T))


def rigid_motions(offsets: np.ndarray) -> np.ndarray:
    """Displacements (3 N, 6) of points at offsets (N, 3) from the reference: u + theta x r."""
    x, y, z = offsets.T
    o, one = np.zeros_like(x), np.ones_like(x)
    rows = [[one, o, o, o, z, -y], [o, one, o, -z, o, x], [o, o, one, y, -x, o]]
    return np.array(rows).transpose(2, 0, 1).reshape(-1, 6)


def coupling(basis: skfem.CellBasis, positions: np.ndarray, rigid_seats: bool) -> tuple[Sparse, np.ndarray, np.ndarray]:
    """T of u = T q, and node and direction of every coordinate of q: those of the mesh that are left, then six a port.

    Rigid (RBE2): all nodes of the surface follow, u_s = R q_p. Distributing (RBE3): q_p is the rigid motion next to
    that of the surface, q_p = G u_s with G = (R^T A R)^-1 R^T A and A the integral of a b over it; the forces of q_p
    become linear traction. Six coordinates of the surface, chosen by pivoting, are then eliminated,
    u_d = G_d^-1 (q_p - G_k u_k).
    """
    n = 3 * len(positions)
    left, parts = np.ones(n, bool), []
    for name in NODES:
        A = surface(basis, name)
        nodes = np.flatnonzero(A.diagonal())
        own = (3 * nodes[:, None] + np.arange(3)).ravel()
        R = rigid_motions(positions[nodes] - PLACES[name])
        if name in SEATS and rigid_seats:
            parts.append((own, own[:0], R, np.zeros((len(own), 0))))
            left[own] = False
            continue
        weighted = np.kron(A[nodes][:, nodes].toarray(), np.eye(3)) @ R
        G = np.linalg.solve(R.T @ weighted, weighted.T)
        radius = np.sqrt(np.trace(R[:, 3:].T @ R[:, 3:]) / len(own))
        pivots = scipy.linalg.qr(G * np.repeat([1.0, radius], 3)[:, None], mode="r", pivoting=True)[1]
        gone, kept = np.sort(pivots[:6]), np.sort(pivots[6:])
        inverse = np.linalg.inv(G[:, gone])
        parts.append((own[gone], own[kept], inverse, -inverse @ G[:, kept]))
        left[own[gone]] = False
    return assembled(left, parts)


def assembled(left: np.ndarray, parts: list[tuple[np.ndarray, ...]]) -> tuple[Sparse, np.ndarray, np.ndarray]:
    """T from the coordinates that are left and the blocks of each port: gone, kept, of q_p, of the kept ones."""
    mesh = np.flatnonzero(left)
    column = np.cumsum(left) - 1
    row, place, value = [mesh], [column[mesh]], [np.ones(len(mesh))]
    for k, (gone, kept, of_port, of_kept) in enumerate(parts):
        columns = np.append(len(mesh) + 6 * k + np.arange(6), column[kept])
        row.append(np.repeat(gone, len(columns)))
        place.append(np.tile(columns, len(gone)))
        value.append(np.hstack([of_port, of_kept]).ravel())
    shape = (len(left), len(mesh) + 6 * len(parts))
    entries = (np.concatenate(value), (np.concatenate(row), np.concatenate(place)))
    numbers = np.append(mesh // 3 + 1, np.repeat(list(NODES.values()), 6))
    directions = np.append(mesh % 3 + 1, np.tile(np.arange(1, 7), len(parts)))
    return scipy.sparse.csc_array(scipy.sparse.coo_array(entries, shape=shape)), numbers, directions


def surface(basis: skfem.CellBasis, name: str) -> Sparse:
    """Integral of a b over the bore of a seat or the pad of a foot, (N, N)."""
    mesh, (x, y, z) = basis.mesh, PLACES[name]
    corners = mesh.p[:, mesh.facets]  # (3, 4, facets)
    if name in SEATS:
        bore = SEATS[name][0]
        on_it = abs(np.hypot(corners[0] - x, corners[1]) - bore.radius).max(axis=0) < 1e-6
        facets = np.flatnonzero(on_it & ((corners[2].mean(axis=0) > 0.0) == (z > 0.0)))
    else:
        beside = abs(corners[[0, 2]] - np.array([x, z])[:, None, None]).max(axis=(0, 1)) < FOOT_SIZE / 2 + 1e-6
        facets = np.flatnonzero(beside & (abs(corners[1] - y).max(axis=0) < 1e-6))
    return scipy.sparse.csc_array(products.assemble(skfem.FacetBasis(mesh, basis.elem, facets=facets, intorder=4)))
