"""The single design parameters: how each is read from a system and changed in it (see `python_design`)."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from ..components import Disk, GearTrain, RigidBody, Shaft
from ..errors import InputError
from ..joints import Port
from ..network.system import PointExcitation, System

T = TypeVar("T")


@dataclass(frozen=True)
class DesignParameter:
    """A number of a system, how to read it, and how to change it."""

    name: str  # the FMU variable, such as "casing.mass"
    unit: str
    description: str
    nominal: float
    positive: bool
    read: Callable[[System], float]
    edit: Callable[[System, float], System]
    whole: bool = False  # a count

    def check(self, value: float) -> None:
        """Raise InputError for a value that no design can have."""
        if not np.isfinite(value):
            raise InputError(f"{self.name} must be set to a finite number, not {value}")
        if self.positive and value <= 0.0:
            raise InputError(f"{self.name} must be positive, not {value:g} {self.unit}")
        if self.whole and value != round(value):
            raise InputError(f"{self.name} must be a whole number, not {value:g}")


def exchanged(items: Mapping[str, T], name: str, item: T) -> dict[str, T]:
    """The same mapping, in the same order, with one item exchanged."""
    return {key: item if key == name else value for key, value in items.items()}


def body_parameters(name: str, body: RigidBody) -> list[DesignParameter]:
    """Mass, inertia and centre of gravity of a rigid body."""

    def body_of(system: System) -> RigidBody:
        found = system.components[name]
        assert isinstance(found, RigidBody)
        return found

    def with_body(system: System, changed: RigidBody) -> System:
        return replace(system, components=exchanged(system.components, name, changed))

    def inertia(key: str) -> DesignParameter:
        what = f"{'Moment' if key[0] == key[1] else 'Tensor element'} {key} of the inertia of {name}"
        return DesignParameter(
            f"{name}.inertia_{key}",
            "kg.m2",
            f"{what}, about the centre of gravity",
            max(body.inertia.values()),
            key[0] == key[1],
            lambda system: body_of(system).inertia[key],
            lambda system, value: with_body(
                system, replace(body_of(system), inertia=exchanged(body_of(system).inertia, key, value))
            ),
        )

    def centre(axis: int) -> DesignParameter:
        def edit(system: System, value: float) -> System:
            old = body_of(system)
            x, y, z = (value if k == axis else c for k, c in enumerate(old.centre_of_gravity))
            return with_body(system, replace(old, centre_of_gravity=(x, y, z)))

        return DesignParameter(
            f"{name}.centre_of_gravity[{axis + 1}]",
            "m",
            f"{'xyz'[axis]} of the centre of gravity of {name}",
            0.1,
            False,
            lambda system: body_of(system).centre_of_gravity[axis],
            edit,
        )

    mass = DesignParameter(
        f"{name}.mass",
        "kg",
        f"Mass of {name}",
        body.mass,
        True,
        lambda system: body_of(system).mass,
        lambda system, value: with_body(system, replace(body_of(system), mass=value)),
    )
    return [mass, *(inertia(key) for key in body.inertia), *(centre(axis) for axis in range(3))]


def _train(system: System, name: str) -> GearTrain:
    found = system.components[name]
    assert isinstance(found, GearTrain)
    return found


def _with_shaft(system: System, name: str, shaft_name: str, shaft: Shaft) -> System:
    train = _train(system, name)
    changed = replace(train, shafts=exchanged(train.shafts, shaft_name, shaft))
    return replace(system, components=exchanged(system.components, name, changed))


def shaft_parameters(name: str, shaft_name: str, shaft: Shaft) -> list[DesignParameter]:
    """Length of a shaft, and its diameter where it is the same all along."""

    def shaft_of(system: System) -> Shaft:
        return _train(system, name).shafts[shaft_name]

    def widen(system: System, value: float) -> System:
        old = shaft_of(system)
        return _with_shaft(system, name, shaft_name, replace(old, sections=(replace(old.sections[0], outer=value),)))

    length = DesignParameter(
        f"{name}.{shaft_name}.length",
        "m",
        f"Length of the shaft {shaft_name}; stretches sections, stations and disks, the first end stays",
        0.1,
        True,
        lambda system: shaft_of(system).length,
        lambda system, value: _stretch(system, name, shaft_name, value / shaft_of(system).length),
    )
    if len(shaft.sections) != 1 or shaft.sections[0].tapered:
        return [length]
    diameter = DesignParameter(
        f"{name}.{shaft_name}.diameter",
        "m",
        f"Outer diameter of the shaft {shaft_name}; the inner one stays",
        0.01,
        True,
        lambda system: shaft_of(system).sections[0].outer,
        widen,
    )
    return [length, diameter]


def _stretch(system: System, name: str, shaft_name: str, factor: float) -> System:
    """Stretch a shaft and everything that is given by its distance from the first end."""
    shaft = _train(system, name).shafts[shaft_name]
    sections = tuple(replace(section, length=factor * section.length) for section in shaft.sections)
    disks = tuple(replace(disk, z=factor * disk.z) for disk in shaft.disks)
    system = _with_shaft(system, name, shaft_name, replace(shaft, sections=sections, disks=disks))

    def moved(port: Port) -> Port:
        if port.component != name or port.shaft != shaft_name or port.z is None:
            return port
        return replace(port, z=factor * port.z)

    return replace(
        system,
        joints={
            key: replace(joint, between=(moved(joint.between[0]), moved(joint.between[1])))
            for key, joint in system.joints.items()
        },
        actuators={key: replace(item, port=moved(item.port)) for key, item in system.actuators.items()},
        sensors={key: replace(item, port=moved(item.port)) for key, item in system.sensors.items()},
        excitation=replace(system.excitation, port=moved(system.excitation.port))
        if isinstance(system.excitation, PointExcitation)
        else system.excitation,
    )


def mesh_position(name: str, mesh_name: str) -> DesignParameter:
    """Where both gears of a mesh stand along the shafts."""

    def read(system: System) -> float:
        train = _train(system, name)
        shaft, disk = train.meshes[mesh_name].between[0]
        return train.shafts[shaft].position(train.shafts[shaft].disk(disk).z)[2]

    def edit(system: System, value: float) -> System:
        for shaft_name, disk_name in _train(system, name).meshes[mesh_name].between:
            shaft = _train(system, name).shafts[shaft_name]
            disks = tuple(_placed(disk, value - shaft.origin[2], disk_name) for disk in shaft.disks)
            system = _with_shaft(system, name, shaft_name, replace(shaft, disks=disks))
        return system

    return DesignParameter(
        f"{mesh_name}.position",
        "m",
        f"z of both gears of {mesh_name}, in the global frame; until set, they follow their shafts' lengths",
        0.1,
        False,
        read,
        edit,
    )


def _placed(disk: Disk, z: float, name: str) -> Disk:
    return replace(disk, z=z) if disk.name == name else disk


def joint_position(name: str, axis: int) -> DesignParameter:
    """One coordinate of a joint that is given by its place."""

    def read(system: System) -> float:
        at = system.joints[name].at
        assert at is not None
        return at[axis]

    def edit(system: System, value: float) -> System:
        at = system.joints[name].at
        assert at is not None
        x, y, z = (value if k == axis else c for k, c in enumerate(at))
        changed = replace(system.joints[name], at=(x, y, z))
        return replace(system, joints=exchanged(system.joints, name, changed))

    return DesignParameter(
        f"{name}.position[{axis + 1}]", "m", f"{'xyz'[axis]} of the place of {name}", 0.1, False, read, edit
    )
