"""Ports: what each component is asked for, its structure with them, and their motion on all coordinates."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.sparse import issparse

from ..components import (
    Frame,
    GearTrain,
    Matrices,
    Measured,
    ModalModel,
    Modes,
    Plate,
    RigidBody,
    ShaftPoint,
    Structure,
    modes,
)
from ..joints import Joint, Port
from ..numerics.arrays import Real
from .basis import basis_of
from .system import Actuator, Component, PointExcitation, Sensor, System, Vector

Spot = ShaftPoint | str | Vector  # a station, a named place, a point


@lru_cache(maxsize=32)
def solve_component(
    component: Component,
    dofs: tuple[str, ...],
    ports: tuple[tuple[str, Spot], ...],
    probes: tuple[tuple[str, Spot], ...],
    band: float,
    vectors: int | None,
) -> tuple[Structure, Modes]:
    """A component's structure and modes; remembered, because bearings and mounts are exchanged without touching it.

    Dense structures keep all their modes. Sparse ones (plates, frames) are reduced: exact up to `band` (Hz), or with
    the given number of interior `vectors`.
    """
    structure = component.structure(dofs, dict(ports), dict(probes))  # type: ignore[arg-type]
    if isinstance(component, ModalModel):
        basis = component.modes()
    elif isinstance(component, Measured):  # its channels stay its coordinates
        basis = Modes(np.zeros(component.channels), np.eye(component.channels))
    else:
        basis = basis_of(structure, band, vectors) if issparse(structure.mass) else modes(structure)
    for array in (structure.mass, structure.stiffness, structure.rigid_modes, basis.eigenvalues, basis.shapes):
        if isinstance(array, np.ndarray):
            array.flags.writeable = False  # shared between all networks that hold this component
    return structure, basis


class Ports:
    """Builds each component's structure with the ports that the system asks for, and hands out their rows."""

    def __init__(self, system: System) -> None:
        self.system = system
        ports: dict[str, dict[str, Spot]] = {name: {} for name in system.components}
        probes: dict[str, dict[str, Spot]] = {name: {} for name in system.components}
        self.keys: dict[tuple[Port, Vector | None], str] = {}

        def ask(port: Port, at: Vector | None, group: dict[str, dict[str, Spot]]) -> None:
            if port.is_ground:
                return
            key = self.keys.setdefault((port, at), f"{len(self.keys)}")
            if (spot := _spot(system, port, at)) is not None:
                group[port.component][key] = spot

        for joint in system.joints.values():
            for port in joint.between:
                ask(port, port_place(system, joint, port), ports)
        others: list[Actuator | Sensor] = [*system.actuators.values(), *system.sensors.values()]
        for item in others:
            ask(item.port, item.at, probes)
        if isinstance(system.excitation, PointExcitation):
            ask(system.excitation.port, system.excitation.at, probes)
        solved = {
            name: solve_component(
                component,
                system.dofs,
                tuple(ports[name].items()),
                tuple((key, spot) for key, spot in probes[name].items() if key not in ports[name]),
                system.band,
                system.vectors.get(name),
            )
            for name, component in system.components.items()
        }
        self.structures = {name: structure for name, (structure, _) in solved.items()}
        self.bases = {name: basis for name, (_, basis) in solved.items()}
        ends = np.cumsum([structure.size for structure in self.structures.values()])
        self.size = int(ends[-1])
        self.blocks = {
            name: slice(int(end) - self.structures[name].size, int(end)) for name, end in zip(self.structures, ends)
        }

    def embed(self, component: str, rows: Real) -> Real:
        """Rows on one component's coordinates as rows on all coordinates."""
        out = np.zeros((*rows.shape[:-1], self.size))
        out[..., self.blocks[component]] = rows
        return out

    def motion(self, port: Port, at: Vector | None) -> Real:
        """Motion of a port, (6, n); zero on the ground."""
        if port.is_ground:
            return np.zeros((6, self.size))
        body = isinstance(self.system.components[port.component], RigidBody)
        key = "cg" if body and at is None else self.keys[port, at]
        return self.embed(port.component, self.structures[port.component].ports[key])


def shaft_point(train: GearTrain, port: Port) -> ShaftPoint:
    """The point on the shaft that a port names by station or by disk."""
    assert port.shaft is not None
    z = train.shafts[port.shaft].disk(port.disk).z if port.disk is not None else port.z
    assert z is not None
    return ShaftPoint(port.shaft, z)


def _spot(system: System, port: Port, at: Vector | None) -> Spot | None:
    """Where on its component a port is; None for the centre of gravity of a rigid body."""
    component = system.components[port.component]
    if isinstance(component, GearTrain):
        return shaft_point(component, port)
    return at if port.place is None else port.place


def _own_place(system: System, port: Port) -> Vector | None:
    """Global position of a shaft station, a footprint or a node; None where the joint gives it."""
    component = None if port.is_ground else system.components[port.component]
    if isinstance(component, GearTrain):
        point = shaft_point(component, port)
        return component.shafts[point.shaft].position(point.z)
    if isinstance(component, (Plate, Frame, Matrices, ModalModel, Measured)) and port.place is not None:
        return component.position(port.place)
    return None


def joint_place(system: System, joint: Joint) -> Vector | None:
    """Where a joint meets its receiver: its `at`, else the place of one of its ends."""
    if joint.at is not None:
        return joint.at
    receiver = _own_place(system, joint.between[1])
    return _moved(_own_place(system, joint.between[0]), joint.offset, 1.0) if receiver is None else receiver


def port_place(system: System, joint: Joint, port: Port) -> Vector | None:
    """Where a joint meets one of its ports; the source's end of a beam joint lies `offset` before the receiver's."""
    place = joint_place(system, joint)
    return _moved(place, joint.offset, -1.0) if port is joint.between[0] else place


def _moved(place: Vector | None, offset: Vector | None, factor: float) -> Vector | None:
    if place is None or offset is None:
        return place
    x, y, z = (a + factor * b for a, b in zip(place, offset))
    return (x, y, z)
