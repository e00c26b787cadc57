"""The paper's source: shafts with disks and the gear meshes between them, assembled as one free-free structure."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from ..numerics.arrays import Real
from .dofs import DOFS
from .material import Material
from .section import Section
from .shaft_mesh import ShaftMesh, mesh_shaft
from .structure import MeshMotion, Structure

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
class Mesh:
    """A gear mesh along the line of action y: stiffness (N/m), base radii of its two gears (m)."""

    between: tuple[tuple[str, str], tuple[str, str]]  # (shaft, disk) of the first and the second gear
    stiffness: float
    base_radii: tuple[float, float]


@dataclass(frozen=True)
class ShaftPoint:
    """A point on the axis of a shaft, z from its first end (m)."""

    shaft: str
    z: float


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
        shaft and only p = sum(r theta) of each mesh is kept as a coordinate, with the mass 1/(r1^2/J1 + r2^2/J2).
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
        rigid = self._rigid_modes(grids, starts, size, spins, deflections)
        return Structure(M, K, rigid, self.modal_damping, ports, self._mesh_motions(M, grids, starts, spins))

    def _shaft_dofs(self, dofs: Sequence[str]) -> tuple[str, ...]:
        """Degrees of freedom of every shaft node: whole bending planes, and the plane of the line of action."""
        planes = [("ux", "ry"), ("uy", "rx"), ("uz",), ("rz",)]
        wanted = set(dofs) | ({"uy"} if self.meshes else set())
        kept = {dof for plane in planes if wanted & set(plane) for dof in plane}
        return tuple(dof for dof in DOFS if dof in kept)

    def _gears(self, mesh: Mesh) -> tuple[tuple[ShaftPoint, float, float], ...]:
        """Both gears of a mesh: where, sign along the line of action, lever of theta_z in the mesh deformation."""
        points = [ShaftPoint(shaft, self.shafts[shaft].disk(disk).z) for shaft, disk in mesh.between]
        x1, x2 = (self.shafts[point.shaft].origin[0] for point in points)
        turn = 1.0 if x1 <= x2 else -1.0  # the contact lies between the axes
        return tuple((point, sign, turn * radius) for point, sign, radius in zip(points, (1.0, -1.0), mesh.base_radii))

    def _deflections(self, row: Callable[[ShaftPoint], Real], size: int, spins: int) -> list[Real]:
        """Mesh deformation b of each mesh: b @ q = y1 - y2 + p, p = r1 theta1 + r2 theta2."""
        out = []
        for k, mesh in enumerate(self.meshes.values()):
            b = np.zeros(size)
            for point, sign, lever in self._gears(mesh):
                motion = row(point)
                b += sign * motion[1] + lever * motion[5]
            if spins:
                b[size - spins + k] = 1.0
            out.append(b)
        return out

    def _spin_mass(self) -> Real:
        """Mass of the spin coordinates p = T theta of freely spinning disks: (T J^-1 T^T)^-1.

        For one mesh m_e = 1/(r1^2/J1 + r2^2/J2).
        """
        disks = {(s, disk.name): disk.polar_inertia for s, shaft in self.shafts.items() for disk in shaft.disks}
        T = np.zeros((len(self.meshes), len(disks)))
        for k, mesh in enumerate(self.meshes.values()):
            for gear, (_, _, lever) in zip(mesh.between, self._gears(mesh)):
                T[k, list(disks).index(gear)] += lever
        mobility = (T / np.array(list(disks.values()))) @ T.T
        return np.asarray(scipy.linalg.inv((mobility + mobility.T) / 2.0))

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
                    for point, _, lever in self._gears(mesh):
                        levers[k, s] += lever if point.shaft == name else 0.0
        compliance = np.linalg.solve(spin.T @ M @ spin, levers.T)
        d = spin @ compliance @ np.linalg.inv(levers @ compliance)
        return {name: MeshMotion(d[:, k], float(d[:, k] @ M @ d[:, k])) for k, name in enumerate(self.meshes)}
