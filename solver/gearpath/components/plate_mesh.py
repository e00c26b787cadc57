"""One plate on its grid: matrices with the footprints made rigid, and the motion of any of its points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..errors import InputError
from ..numerics.arrays import Real, Sparse
from .dofs import rigid_motion
from .footprint import check_footprints
from .node_mesh import NodeMesh, Nodes, Place, follow, scatter
from .plate_element import plate_elements
from .plate_grid import grid_lines
from .rigid_body import Vector

if TYPE_CHECKING:
    from .plate import Plate

Lines = tuple[Real, Real]


@dataclass(frozen=True)
class PlateMesh:
    """A meshed plate; its grid nodes run along axis 1 first."""

    plate: Plate
    lines: Lines  # grid lines along the two axes from the centre, m
    nodes: NodeMesh  # free grid nodes and rigid footprints
    followed: Sparse  # T: coordinates of all grid nodes, then footprints = T @ those of `nodes`

    def motion(self, spot: str | Vector) -> Real:
        """Motion (6, n) of a footprint, or of a point by the shape functions of its element.

        A point off the middle surface moves with the normal through it. Raises InputError for points not on the plate.
        """
        if isinstance(spot, str):
            return self.nodes.motion(spot)
        x, y, z = on_plate(self.plate, "point", spot)
        (i, a), (k, b) = (_element(lines, value) for lines, value in zip(self.lines, (x, y)))
        first, width = i + k * len(self.lines[0]), len(self.lines[0])
        weights = np.zeros(self.followed.shape[0] // 6)
        weights[[first, first + 1]] = (1.0 - b) * (1.0 - a), (1.0 - b) * a
        weights[[first + width, first + width + 1]] = b * (1.0 - a), b * a
        foot = (self.followed.T @ np.kron(weights[:, None], np.eye(6))).T
        return np.asarray(rigid_motion(z * plate_axes(self.plate)[2]) @ foot)


def mesh_plate(plate: Plate, points: Sequence[Vector]) -> PlateMesh:
    """Grid a plate through its footprints and the given points, assemble it and make its footprints rigid.

    Raises InputError for footprints and points that are not on the plate, and for rigid footprints that touch.
    """
    centres = {name: on_plate(plate, f"footprint {name!r}", f.centre)[:2] for name, f in plate.footprints.items()}
    check_footprints(plate.footprints, centres, np.array(plate.lengths))
    passed = [on_plate(plate, "port", point)[:2] for point in points]
    lines = _lines(plate, 0, centres, passed), _lines(plate, 1, centres, passed)
    loose = _assemble(plate, lines)
    nodes, followed = follow(loose, _leaders(plate, lines, centres))
    return PlateMesh(plate, lines, nodes, followed)


def _lines(plate: Plate, axis: int, centres: Mapping[str, Real], points: Sequence[Real]) -> Real:
    half = {name: footprint.size[axis] / 2.0 for name, footprint in plate.footprints.items()}
    edges = [(centre[axis] - half[name], centre[axis] + half[name]) for name, centre in centres.items()]
    across = [point[axis] for point in points]
    return grid_lines(plate.lengths[axis], plate.elements[axis], edges, across, plate.footprint_elements)


def _assemble(plate: Plate, lines: Lines) -> NodeMesh:
    """All grid nodes with their elements, then one node without any for each footprint; nothing rigid yet."""
    axes = plate_axes(plate)
    x, y = (values.ravel() for values in np.meshgrid(*lines))
    width = len(lines[0])
    first = (np.arange(width - 1) + width * np.arange(len(lines[1]) - 1)[:, None]).ravel()
    corners = first[:, None] + np.array([0, 1, width + 1, width])
    K, M = plate_elements(np.stack([x, y], axis=1)[corners], plate.material, plate.thickness, plate.shear_coefficient)
    turn = np.kron(np.eye(8), axes)
    positions = [plate.centre + np.outer(x, axes[0]) + np.outer(y, axes[1])]
    positions += [np.array([footprint.centre]) for footprint in plate.footprints.values()]
    count = len(x) + len(plate.footprints)
    M, K = (scatter(turn.T @ matrices @ turn, corners, count) for matrices in (M, K))
    places = {name: Place(len(x) + k, np.array(f.centre)) for k, (name, f) in enumerate(plate.footprints.items())}
    return NodeMesh(np.vstack(positions), M, K, places)


def _leaders(plate: Plate, lines: Lines, centres: Mapping[str, Real]) -> Nodes:
    """Which node each node follows: grid nodes the rigid footprint they lie in, points the grid node they lie on."""
    x, y = (values.ravel() for values in np.meshgrid(*lines))
    near = 1e-3 * min(np.diff(line).min() for line in lines)
    leaders = np.arange(len(x) + len(centres))
    for node, (name, footprint) in enumerate(plate.footprints.items(), len(x)):
        away = abs(np.array([x, y]) - centres[name][:, None]) - np.array(footprint.size)[:, None] / 2.0
        inside = np.flatnonzero(np.all(away < near, axis=0))
        if footprint.is_point:
            leaders[node] = inside[0]
        else:
            leaders[inside] = node
    return np.asarray(leaders[leaders])  # a point within a rigid footprint follows that


def plate_axes(plate: Plate) -> Real:
    """Axis 1, axis 2 and the normal as the rows of a rotation (3, 3); raises InputError unless orthonormal."""
    one, two = (np.array(axis, float) for axis in plate.axes)
    if not np.allclose([one @ one, two @ two, one @ two], [1.0, 1.0, 0.0], atol=1e-9):
        raise InputError(f"plate: axes {plate.axes} are not two perpendicular directions of length one; make them so")
    return np.array([one, two, np.cross(one, two)])


def on_plate(plate: Plate, what: str, point: Vector) -> Real:
    """A point in the plate's own axes from its centre, (3,); raises InputError where it is not on the plate."""
    local = plate_axes(plate) @ (np.array(point, float) - plate.centre)
    limits = np.array([*plate.lengths, plate.thickness]) / 2.0
    if not np.all(abs(local) <= limits + 1e-9 * max(plate.lengths)):
        found, ends = (", ".join(f"{value:g}" for value in values) for values in (local, limits))
        raise InputError(
            f"{what} at {point} m is not on the plate: along axis 1, axis 2 and the normal it is {found} m from "
            f"the centre and the plate ends at +-{ends} m; move the point or the plate"
        )
    return np.asarray(local)


def _element(lines: Real, x: float) -> tuple[int, float]:
    """The element along one axis that x falls in, and where in it, 0 to 1."""
    e = int(np.clip(np.searchsorted(lines, x) - 1, 0, len(lines) - 2))
    return e, float(np.clip((x - lines[e]) / (lines[e + 1] - lines[e]), 0.0, 1.0))
