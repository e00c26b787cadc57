"""Joints, inputs and outputs of the network as rows and columns on all coordinates."""

from __future__ import annotations

import numpy as np

from ..components import DOFS
from ..components.dofs import force_unit, motion_unit, rigid_motion
from ..joints import Joint
from ..numerics.arrays import Real
from .ports import Ports, port_place
from .records import JointRows, Load, Output
from .system import MeshExcitation, System

POINT_LOAD = "excitation.force"  # the input that a point excitation adds
_ORDERS = {"displacement": 0, "velocity": 1, "acceleration": 2}


def joint_motion(ports: Ports, joint: Joint) -> tuple[Real, Real]:
    """Motion of the source's end, carried to the receiver's, and of the receiver's, (6, n) each."""
    # a joint holds the shaft at a disk's station, not the disk that spins freely about it
    active = np.array([dof in ports.system.dofs for dof in DOFS])[:, None]
    source, receiver = (active * ports.motion(port, port_place(ports.system, joint, port)) for port in joint.between)
    if joint.offset is not None:
        source = rigid_motion(np.array(joint.offset)) @ source
    return source, receiver


def joint_rows(ports: Ports, name: str, joint: Joint) -> JointRows:
    picked = [DOFS.index(dof) for dof in joint.dofs]
    source, receiver = (motion[picked] for motion in joint_motion(ports, joint))
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
        joint.loss_factor,
    )


def load_columns(ports: Ports, system: System) -> tuple[str, tuple[Load, ...]]:
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


def output_rows(ports: Ports, system: System, joints: tuple[JointRows, ...]) -> tuple[Output, ...]:
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
