"""From the system to rows: every port, load and output as a row on the components' coordinates."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import scipy.linalg

from ..components import DOFS, GearTrain, Modes, ShaftPoint, Structure, modes
from ..components.dofs import force_unit, motion_unit
from ..joints import Joint, Port
from ..numerics.arrays import Real
from .modal import ModalNetwork
from .records import JointRows, Load, Output
from .system import Actuator, Component, MeshExcitation, PointExcitation, Sensor, System, Vector

POINT_LOAD = "excitation.force"  # the input that a point excitation adds
_ORDERS = {"displacement": 0, "velocity": 1, "acceleration": 2}


@dataclass(frozen=True)
class Network:
    """The network in physical coordinates: the structures, and rows on all their coordinates together."""

    system: System
    structures: Mapping[str, Structure]
    bases: Mapping[str, Modes]  # all free-free modes of each structure
    blocks: Mapping[str, slice]  # component -> its coordinates
    joints: tuple[JointRows, ...]
    loads: tuple[Load, ...]
    outputs: tuple[Output, ...]
    excitation: str

    @property
    def paths(self) -> tuple[str, ...]:
        """The joints that count as power flow paths: all bearings."""
        return tuple(joint.name for joint in self.joints if joint.kind == "bearing")

    def modal(self) -> ModalNetwork:
        """The same network in all free-free modes of its components (no truncation)."""
        return to_modes(self, self.bases)


def assemble(system: System) -> Network:
    """Assemble the components and express every port, load and output on their coordinates."""
    ports = _Ports(system)
    joints = tuple(_joint_rows(ports, name, joint) for name, joint in system.joints.items())
    excitation, loads = _loads(ports, system)
    outputs = _outputs(ports, system, joints)
    return Network(system, ports.structures, ports.bases, ports.blocks, joints, loads, outputs, excitation)


def to_modes(network: Network, basis: Mapping[str, Modes]) -> ModalNetwork:
    """Project the network on a basis of mass-normalised modes of each component (Eq. 11)."""
    shapes = scipy.linalg.block_diag(*(basis[name].shapes for name in network.structures))
    ends = np.cumsum([len(basis[name].eigenvalues) for name in network.structures])
    slices = {
        name: slice(int(end) - len(basis[name].eigenvalues), int(end)) for name, end in zip(network.structures, ends)
    }
    mass = scipy.linalg.block_diag(*(s.mass for s in network.structures.values()))
    project = mass @ shapes

    def load(item: Load) -> Load:
        motion = item.mesh_displacement
        d = None if motion is None else motion @ project
        return replace(item, column=item.column @ shapes, mesh_displacement=d)

    return ModalNetwork(
        name=network.system.name,
        components=slices,
        modal_damping={
            name: structure.modal_damping
            for name, structure in network.structures.items()
            if len(basis[name].eigenvalues) > structure.rigid_modes.shape[1]
        },
        eigenvalues=np.concatenate([basis[name].eigenvalues for name in network.structures]),
        joints=tuple(
            replace(joint, source=joint.source @ shapes, receiver=joint.receiver @ shapes) for joint in network.joints
        ),
        loads=tuple(load(item) for item in network.loads),
        outputs=tuple(
            replace(output, row=None if output.row is None else output.row @ shapes) for output in network.outputs
        ),
        excitation=network.excitation,
        paths=network.paths,
    )


@lru_cache(maxsize=32)
def _solved(
    component: Component,
    dofs: tuple[str, ...],
    stations: tuple[tuple[str, ShaftPoint], ...],
    probes: tuple[tuple[str, ShaftPoint], ...],
    points: tuple[tuple[str, Vector], ...],
) -> tuple[Structure, Modes]:
    """A component's structure and modes; remembered, because bearings and mounts are exchanged without touching it."""
    if isinstance(component, GearTrain):
        structure = component.structure(dofs, dict(stations), dict(probes))
    else:
        structure = component.structure(dofs, dict(points))
    basis = modes(structure)
    for array in (structure.mass, structure.stiffness, structure.rigid_modes, basis.eigenvalues, basis.shapes):
        array.flags.writeable = False  # shared between all networks that hold this component
    return structure, basis


class _Ports:
    """Builds each component's structure with the ports that the system asks for, and hands out their rows."""

    def __init__(self, system: System) -> None:
        self.system = system
        stations: dict[str, dict[str, ShaftPoint]] = {name: {} for name in system.components}
        probes: dict[str, dict[str, ShaftPoint]] = {name: {} for name in system.components}
        points: dict[str, dict[str, Vector]] = {name: {} for name in system.components}
        self.keys: dict[tuple[Port, Vector | None], str] = {}

        def ask(port: Port, at: Vector | None, group: dict[str, dict[str, ShaftPoint]]) -> None:
            if port.is_ground:
                return
            key = f"{len(self.keys)}"
            self.keys.setdefault((port, at), key)
            component = system.components[port.component]
            if isinstance(component, GearTrain):
                group[port.component][self.keys[port, at]] = shaft_point(component, port)
            elif at is not None:
                points[port.component][self.keys[port, at]] = at

        for joint in system.joints.values():
            for port in joint.between:
                ask(port, joint_place(system, joint), stations)
        others: list[Actuator | Sensor] = [*system.actuators.values(), *system.sensors.values()]
        for item in others:
            ask(item.port, item.at, probes)
        if isinstance(system.excitation, PointExcitation):
            ask(system.excitation.port, system.excitation.at, probes)
        solved = {
            name: _solved(component, system.dofs, *(tuple(group[name].items()) for group in (stations, probes, points)))
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
        rigid = not isinstance(self.system.components[port.component], GearTrain)
        key = "cg" if rigid and at is None else self.keys[port, at]
        return self.embed(port.component, self.structures[port.component].ports[key])


def shaft_point(train: GearTrain, port: Port) -> ShaftPoint:
    """The point on the shaft that a port names by station or by disk."""
    assert port.shaft is not None
    z = train.shafts[port.shaft].disk(port.disk).z if port.disk is not None else port.z
    assert z is not None
    return ShaftPoint(port.shaft, z)


def joint_place(system: System, joint: Joint) -> Vector | None:
    """Where a joint is: its `at`, else the position of the shaft station at one of its ends."""
    if joint.at is not None:
        return joint.at
    for port in joint.between:
        component = None if port.is_ground else system.components[port.component]
        if isinstance(component, GearTrain):
            point = shaft_point(component, port)
            return component.shafts[point.shaft].position(point.z)
    return None


def _joint_rows(ports: _Ports, name: str, joint: Joint) -> JointRows:
    picked = [DOFS.index(dof) for dof in joint.dofs]
    place = joint_place(ports.system, joint)
    source, receiver = (ports.motion(port, place)[picked] for port in joint.between)
    return JointRows(
        name,
        joint.kind,
        joint.dofs,
        source,
        receiver,
        np.array(joint.stiffness, float),
        np.array(joint.damping, float),
        joint.scalar,
        joint.between[1].is_ground,
    )


def _loads(ports: _Ports, system: System) -> tuple[str, tuple[Load, ...]]:
    """All inputs: each mesh's transmission error and inertial force, actuators, a point excitation."""
    loads: list[Load] = []
    for component, structure in ports.structures.items():
        for mesh, motion in structure.meshes.items():
            column = ports.embed(component, structure.mass @ motion.displacement)
            d = ports.embed(component, motion.displacement)
            loads.append(Load(f"{mesh}.transmission_error", "m", column, d, motion.equivalent_mass))
            loads.append(Load(f"{mesh}.force", "N", column / motion.equivalent_mass))
    for name, actuator in system.actuators.items():
        row = ports.motion(actuator.port, actuator.at)[DOFS.index(actuator.dof)]
        loads.append(Load(f"actuators.{name}", force_unit(actuator.dof), row))
    if isinstance(system.excitation, MeshExcitation):
        return f"{system.excitation.mesh}.transmission_error", tuple(loads)
    item = system.excitation
    row = ports.motion(item.port, item.at)[DOFS.index(item.dof)]
    loads.append(Load(POINT_LOAD, force_unit(item.dof), row))
    return POINT_LOAD, tuple(loads)


def _outputs(ports: _Ports, system: System, joints: tuple[JointRows, ...]) -> tuple[Output, ...]:
    """Joint forces, receiver velocities and powers; casing motion at its centre of gravity; meshes; sensors."""
    out: list[Output] = []
    for joint in joints:
        for k, dof in enumerate(joint.dofs):
            out.append(Output(f"{joint.name}.force_{dof}", force_unit(dof), "force", None, joint.name, k))
        if joint.grounded:
            continue
        for k, dof in enumerate(joint.dofs):
            name = f"{joint.name}.velocity_{dof}"
            out.append(Output(name, motion_unit(dof, 1), "velocity", joint.receiver[k]))
        out.append(Output(f"{joint.name}.power", "W", "power", None, joint.name))
    for name, structure in ports.structures.items():
        for dof, row in zip(DOFS, structure.ports.get("cg", ())):
            for quantity in ("velocity", "acceleration") if row.any() else ():
                unit = motion_unit(dof, _ORDERS[quantity])
                out.append(Output(f"{name}.{quantity}_{dof}", unit, quantity, ports.embed(name, row)))
        for mesh, motion in structure.meshes.items():
            column = ports.embed(name, structure.mass @ motion.displacement / motion.equivalent_mass)
            out.append(Output(f"{mesh}.velocity", "m/s", "velocity", column))
    for name, sensor in system.sensors.items():
        row = ports.motion(sensor.port, sensor.at)[DOFS.index(sensor.dof)]
        unit = motion_unit(sensor.dof, _ORDERS[sensor.quantity])
        out.append(Output(f"sensors.{name}", unit, sensor.quantity, row))
    return tuple(out)
