"""One shaft as a chain of beam elements with disks, on the active degrees of freedom of its nodes."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..errors import InputError
from ..numerics.arrays import Real
from .beam import beam_element, beam_shapes
from .dofs import DOFS, rigid_motion
from .section import Section
from .shaft import Shaft
from .tapered_beam import tapered_element, tapered_shapes

_SAME = 1e-9  # stations closer than this part of the shaft length are one


@dataclass(frozen=True)
class ShaftMesh:
    """Finite element matrices of a shaft; coordinates run node by node over `dofs`."""

    shaft: Shaft
    nodes: Real  # z of the nodes, m
    dofs: tuple[str, ...]
    mass: Real
    stiffness: Real

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return len(self.nodes) * len(self.dofs)

    def motion(self, z: float) -> Real:
        """Motion ux uy uz rx ry rz at z from the coordinates, (6, size), by the element's shape functions."""
        e = int(np.clip(np.searchsorted(self.nodes, z) - 1, 0, len(self.nodes) - 2))
        length = float(self.nodes[e + 1] - self.nodes[e])
        xi = (z - self.nodes[e]) / length
        picked = _picked(self.dofs)
        out = np.zeros((6, self.size))
        nearest = round(xi)
        if abs(xi - nearest) * length < _SAME * self.shaft.length:
            first = (e + nearest) * len(self.dofs)
            out[picked, first + np.arange(len(picked))] = 1.0
            return out
        section = section_between(self.shaft, float(self.nodes[e]), float(self.nodes[e + 1]))
        N = _shapes(self.shaft, section, xi, length)
        first = e * len(self.dofs)
        out[:, first : first + 2 * len(picked)] = N[:, np.concatenate([picked, picked + 6])]
        return out

    def rigid(self) -> Real:
        """Rigid motions in the active degrees of freedom about the shaft's middle, (size, len(dofs))."""
        picked, middle = _picked(self.dofs), self.shaft.length / 2.0
        blocks = [rigid_motion(np.array([0.0, 0.0, z - middle]))[np.ix_(picked, picked)] for z in self.nodes]
        return np.vstack(blocks)


def _picked(dofs: Sequence[str]) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    return np.array([DOFS.index(dof) for dof in dofs])


def section_between(shaft: Shaft, start: float, end: float) -> Section:
    """What the section that covers start to end has there: itself, or the part of a tapered one."""
    at = 0.0
    for section in shaft.sections:
        if at + section.length >= (start + end) / 2.0:
            break
        at += section.length
    if not section.tapered:
        return section
    return section.part((start - at) / section.length, (end - at) / section.length)


def _shapes(shaft: Shaft, section: Section, xi: float, length: float) -> Real:
    if section.tapered:
        return tapered_shapes(shaft.beam, xi, section, shaft.material, length, shaft.shear_coefficient)
    return beam_shapes(shaft.beam, xi, section, shaft.material, length, shaft.shear_coefficient_of(section))[0]


def _elements(shaft: Shaft, start: float, end: float, count: int) -> list[tuple[Real, Real]]:
    """Stiffness and mass of the elements of a span; those of a constant section are all alike."""
    length, section = (end - start) / count, section_between(shaft, start, end)
    if not section.tapered:
        kappa = shaft.shear_coefficient_of(section)
        return [beam_element(shaft.beam, section, shaft.material, length, kappa)] * count
    parts = [section.part(k / count, (k + 1) / count) for k in range(count)]
    return [tapered_element(shaft.beam, part, shaft.material, length, shaft.shear_coefficient) for part in parts]


def shaft_stations(shaft: Shaft, bearings: Sequence[float]) -> Real:
    """Distinct stations in order: both ends, changes of section, disks, bearings (m)."""
    steps = np.cumsum([0.0] + [section.length for section in shaft.sections])
    z = np.sort([*steps, *(disk.z for disk in shaft.disks), *bearings])
    return np.asarray(z[np.concatenate([[True], np.diff(z) > _SAME * shaft.length])])


def mesh_shaft(shaft: Shaft, bearings: Sequence[float], dofs: tuple[str, ...]) -> ShaftMesh:
    """Divide a shaft into elements between its stations and assemble it.

    Raises InputError where the number of spans and of entries in `elements` differ.
    """
    stations = shaft_stations(shaft, bearings)
    wanted = len(stations) - 1
    counts = shaft.elements * wanted if len(shaft.elements) == 1 else shaft.elements
    if len(counts) != wanted:
        raise InputError(
            f"elements has {len(counts)} entries for {wanted} spans between the stations "
            f"{', '.join(f'{z:g}' for z in stations)} m; give {wanted} numbers, or one for all spans"
        )
    nodes = np.concatenate([[0.0], *(np.linspace(a, b, n + 1)[1:] for (a, b), n in zip(pairwise(stations), counts))])
    picked, width = _picked(dofs), len(dofs)
    chosen = np.ix_(*[np.concatenate([picked, picked + 6])] * 2)
    M, K = (np.zeros((len(nodes) * width, len(nodes) * width)) for _ in range(2))
    spans = pairwise(float(z) for z in stations)
    elements = [item for (start, end), n in zip(spans, counts) for item in _elements(shaft, start, end, n)]
    for e, element in enumerate(elements):
        block = slice(e * width, (e + 2) * width)
        K[block, block] += element[0][chosen]
        M[block, block] += element[1][chosen]
    for disk in shaft.disks:
        node = int(np.argmin(abs(nodes - disk.z)))
        at = node * width + np.arange(width)
        M[at, at] += disk.inertia()[picked]
    return ShaftMesh(shaft, nodes, dofs, M, K)
