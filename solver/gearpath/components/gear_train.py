"""The paper's source: shafts with disks and the gear meshes between them, assembled as one free-free structure."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from ..numerics.arrays import Real
from .dofs import DOFS
from .gear_mesh import Mesh
from .shaft import Shaft, ShaftPoint
from .shaft_mesh import ShaftMesh, mesh_shaft
from .structure import MeshMotion, Structure

_SAME = 1e-9  # a point closer to a disk than this part of the shaft length is on it


@dataclass(frozen=True)
class GearTrain:
    """Shafts, disks and meshes; `modal_damping` is the damping ratio of every elastic free-free mode."""

    shafts: Mapping[str, Shaft]
    meshes: Mapping[str, Mesh]
    modal_damping: float = 0.0

    def __hash__(self) -> int:
        return hash((*self.shafts.items(), *self.meshes.items(), self.modal_damping))

    def structure(
        self,
        dofs: Sequence[str],
        stations: Mapping[str, ShaftPoint],
        probes: Mapping[str, ShaftPoint] | None = None,
    ) -> Structure:
        """Assemble the free-free train.

        stations are ports that get a node of their own (bearings); probes are ports read from the shape functions of
        the element they fall in (sensors, forces). Where rz is not among `dofs` each disk spins freely about its
        shaft and only p = sum(r cos(beta_b) theta) of each mesh is kept as a coordinate, along its line of action;
        points on a disk then read its spin as rz.
        """
        shaft_dofs = self._shaft_dofs(dofs)
        grids = {
            name: mesh_shaft(shaft, [p.z for p in stations.values() if p.shaft == name], shaft_dofs)
            for name, shaft in self.shafts.items()
        }
        spins = len(self.meshes) if "rz" not in shaft_dofs else 0
        starts = dict(zip(grids, np.cumsum([0] + [grid.size for grid in grids.values()])))
        size = sum(grid.size for grid in grids.values()) + spins
        M, K = np.zeros((size, size)), np.zeros((size, size))
        for name, grid in grids.items():
            block = slice(starts[name], starts[name] + grid.size)
            M[block, block], K[block, block] = grid.mass, grid.stiffness

        def row(point: ShaftPoint) -> Real:
            out = np.zeros((6, size))
            start, grid = starts[point.shaft], grids[point.shaft]
            out[:, start : start + grid.size] = grid.motion(point.z)
            return out

        deflections = self._deflections(row, size, spins)
        if spins:
            M[-spins:, -spins:] = self._spin_mass()
        for b, mesh in zip(deflections, self.meshes.values()):
            K += mesh.stiffness * np.outer(b, b)
        active = np.array([dof in dofs for dof in DOFS])[:, None]
        ports = {name: active * row(point) for name, point in {**stations, **(probes or {})}.items()}
        for name, point in {**stations, **(probes or {})}.items() if spins else ():
            ports[name][5] = self._spin_of_disk(point, M)
        rigid = self._rigid_modes(grids, starts, size, spins, deflections)
        return Structure(M, K, rigid, self.modal_damping, ports, self._mesh_motions(M, grids, starts, spins))

    def _shaft_dofs(self, dofs: Sequence[str]) -> tuple[str, ...]:
        """Degrees of freedom of every shaft node: whole bending planes, and what the meshes press on."""
        planes = [("ux", "ry"), ("uy", "rx"), ("uz",), ("rz",)]
        wanted = set(dofs)
        for mesh in self.meshes.values():  # gears turn about z without a degree of freedom of the shaft
            pressed = np.any([row[:5] for _, row in self._gears(mesh)], axis=0)
            wanted |= {dof for dof, used in zip(DOFS, pressed) if used}
        kept = {dof for plane in planes if wanted & set(plane) for dof in plane}
        return tuple(dof for dof in DOFS if dof in kept)

    def _gears(self, mesh: Mesh) -> tuple[tuple[ShaftPoint, Real], ...]:
        """Both gears of a mesh: where, and the row of their motion in the mesh deformation, (6,)."""
        points = [ShaftPoint(shaft, self.shafts[shaft].disk(disk).z) for shaft, disk in mesh.between]
        rows = mesh.deformation(*(self.shafts[point.shaft].position(point.z) for point in points))
        return tuple(zip(points, rows))

    def _deflections(self, row: Callable[[ShaftPoint], Real], size: int, spins: int) -> list[Real]:
        """Mesh deformation b of each mesh: b @ q = delta (see `gear_mesh`), free spins p added."""
        out = []
        for k, mesh in enumerate(self.meshes.values()):
            b = np.zeros(size)
            for point, gear in self._gears(mesh):
                b += gear @ row(point)
            if spins:
                b[size - spins + k] = 1.0
            out.append(b)
        return out

    def _spin_mass(self) -> Real:
        """Mass of the spin coordinates p = T theta of freely spinning disks: (T J^-1 T^T)^-1.

        For one mesh m_e = 1/(r1^2/J1 + r2^2/J2) / cos^2(beta_b), the levers being r cos(beta_b).
        """
        T = self._levers()
        mobility = (T / np.array(list(self._disks().values()))) @ T.T
        return np.asarray(scipy.linalg.inv((mobility + mobility.T) / 2.0))

    def _spin_of_disk(self, point: ShaftPoint, M: Real) -> Real:
        """Row of theta_z of the disk at a point, (n,): J^-1 T^T M_p p (`_spin_mass`); zero where there is none.

        It is the spin that moves the meshes; that of all gears rolling together is free and takes no part. A torque
        on the disk presses on p by the same row.
        """
        row = np.zeros(len(M))
        for disk in self.shafts[point.shaft].disks:
            if abs(disk.z - point.z) <= _SAME * self.shafts[point.shaft].length:
                levers = self._levers()[:, list(self._disks()).index((point.shaft, disk.name))]
                count = len(levers)
                row[-count:] = levers / disk.polar_inertia @ M[-count:, -count:]
        return row

    def _disks(self) -> dict[tuple[str, str], float]:
        """Polar inertia of every disk."""
        return {(s, disk.name): disk.polar_inertia for s, shaft in self.shafts.items() for disk in shaft.disks}

    def _levers(self) -> Real:
        """T of the mesh deformations p = T theta, (meshes, disks)."""
        disks = list(self._disks())
        T = np.zeros((len(self.meshes), len(disks)))
        for k, mesh in enumerate(self.meshes.values()):
            for gear, (_, row) in zip(mesh.between, self._gears(mesh)):
                T[k, disks.index(gear)] += row[5]
        return T

    def _rigid_modes(
        self,
        grids: Mapping[str, ShaftMesh],
        starts: Mapping[str, int],
        size: int,
        spins: int,
        deflections: Sequence[Real],
    ) -> Real:
        """Rigid motions of all shafts (and spins) that deform no mesh, (n, r)."""
        columns = []
        for name, grid in grids.items():
            block = np.zeros((size, len(grid.dofs)))
            block[starts[name] : starts[name] + grid.size] = grid.rigid()
            columns.append(block)
        if spins:
            columns.append(np.eye(size)[:, -spins:])
        R = np.hstack(columns)
        if not deflections:
            return R
        scale = np.linalg.norm(R, axis=0)
        R = R / scale
        return np.asarray(R @ scipy.linalg.null_space(np.array(deflections) @ R))

    def _mesh_motions(
        self, M: Real, grids: Mapping[str, ShaftMesh], starts: Mapping[str, int], spins: int
    ) -> dict[str, MeshMotion]:
        """Rigid spin d of each mesh's transmission error: d = R J^-1 T^T (T J^-1 T^T)^-1, R the rigid spins."""
        size, count = len(M), len(self.meshes)
        if not count:
            return {}
        if spins:
            spin, levers = np.eye(size)[:, -spins:], np.eye(count)
        else:
            spin, levers = np.zeros((size, len(grids))), np.zeros((count, len(grids)))
            for s, (name, grid) in enumerate(grids.items()):
                spin[starts[name] : starts[name] + grid.size, s] = grid.rigid()[:, grid.dofs.index("rz")]
                for k, mesh in enumerate(self.meshes.values()):
                    for point, row in self._gears(mesh):
                        levers[k, s] += row[5] if point.shaft == name else 0.0
        compliance = np.linalg.solve(spin.T @ M @ spin, levers.T)
        d = spin @ compliance @ np.linalg.inv(levers @ compliance)
        turned = np.eye(size)[-spins:] if spins else self._turned(size, grids, starts)
        return {
            name: MeshMotion(d[:, k], float(d[:, k] @ M @ d[:, k]), turned[k]) for k, name in enumerate(self.meshes)
        }

    def _turned(self, size: int, grids: Mapping[str, ShaftMesh], starts: Mapping[str, int]) -> Real:
        """Rows of what the gears' own rz deforms each mesh, (meshes, n)."""
        out = np.zeros((len(self.meshes), size))
        for k, mesh in enumerate(self.meshes.values()):
            for point, gear in self._gears(mesh):
                block = slice(starts[point.shaft], starts[point.shaft] + grids[point.shaft].size)
                out[k, block] += gear[5] * grids[point.shaft].motion(point.z)[5]
        return out
