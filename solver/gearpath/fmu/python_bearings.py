"""Design parameters of rolling bearings: geometry, preload, load, and the torque of the gears.

Bundled into the python FMU; imports floors 1 to 4 only.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from ..errors import InputError
from ..joints import Mounting
from ..joints.bearings import BallBearing, RollerBearing
from ..network.system import Operation, System
from .python_parts import DesignParameter, exchanged

# key of the geometry: unit, nominal value, whether it is a size above zero, what it is
_BALL = {
    "balls": ("1", 10.0, True, "Number of balls"),
    "ball_diameter": ("m", 0.01, True, "Ball diameter"),
    "pitch_diameter": ("m", 0.05, True, "Diameter of the circle of ball centres"),
    "inner_conformity": ("1", 0.5, True, "Inner groove radius / ball diameter"),
    "outer_conformity": ("1", 0.5, True, "Outer groove radius / ball diameter"),
    "contact_angle": ("rad", 0.5, False, "Free contact angle, positive where +uz loads the bearing,"),
    "radial_clearance": ("m", 1e-5, False, "Radial clearance, half the diametral one,"),
    "phase": ("rad", 0.5, False, "Place of the first ball, from +x to +y,"),
}
_ROLLER = {
    "rollers": ("1", 10.0, True, "Number of rollers"),
    "roller_length": ("m", 0.01, True, "Effective length of a roller"),
    "pitch_radius": ("m", 0.03, True, "Radius of the circle of roller centres"),
    "contact_angle": ("rad", 0.5, False, "Contact angle, positive where +uz loads the bearing,"),
    "radial_clearance": ("m", 1e-5, False, "Radial clearance, half the diametral one,"),
    "phase": ("rad", 0.5, False, "Place of the first roller, from +x to +y,"),
}
_WHOLE = ("balls", "rollers")


def bearing_parameters(name: str, mounting: Mounting) -> list[DesignParameter]:
    """Those of one joint: geometry of its row, distance and preload, the values of its load or displacement."""
    row = mounting.row
    keys = _BALL if isinstance(row, BallBearing) else _ROLLER if isinstance(row, RollerBearing) else {}
    found = [_of_geometry(name, key, *entry) for key, entry in keys.items()]
    if mounting.arrangement:
        found.append(_of_mounting(name, "distance", "m", "Distance of the rows", 0.02, True))
    found.append(_of_mounting(name, "preload", "N", "Axial force that presses a row together,", 1000.0, False))
    for kind, values in (("load", mounting.load), ("displacement", mounting.displacement)):
        found += [_of_state(name, kind, dof) for dof in values or ()]
    return found


def operation_parameters(operation: Operation) -> list[DesignParameter]:
    """Torque, and speed where it is given."""
    wanted = {"torque": ("N.m", 100.0, "Torque on the driving shaft, which loads the bearings")}
    if operation.speed is not None:
        wanted["speed"] = ("rev/min", 1000.0, "Speed of the driving shaft, for warnings of centrifugal forces")

    def parameter(key: str, unit: str, nominal: float, text: str) -> DesignParameter:
        def edit(system: System, value: float) -> System:
            if value < 0.0:
                raise InputError(f"operation.{key}: {value:g} is below 0; driving_torque turns a torque round")
            changes: dict[str, Any] = {key: value}
            return replace(system, operation=replace(_operation(system), **changes))

        return DesignParameter(
            f"operation.{key}", unit, text, nominal, False, lambda s: float(getattr(_operation(s), key)), edit
        )

    return [parameter(key, *entry) for key, entry in wanted.items()]


def decided_by_design(system: System) -> frozenset[str]:
    """The matrices, such as bearing_1.stiffness, that geometry and load of a bearing decide: no parameters."""
    found = set()
    for name, joint in system.joints.items():
        if joint.mounting is not None:
            found.add(f"{name}.stiffness")
            if joint.mounting.damping_time is not None or joint.loss_factor:
                found.add(f"{name}.damping")
    return frozenset(found)


def _operation(system: System) -> Operation:
    assert system.operation is not None
    return system.operation


def _mounting(system: System, name: str) -> Mounting:
    found = system.joints[name].mounting
    assert found is not None
    return found


def _with(system: System, name: str, **changes: Any) -> System:
    joint = replace(system.joints[name], mounting=replace(_mounting(system, name), **changes))
    return replace(system, joints=exchanged(system.joints, name, joint))


def _of_geometry(name: str, key: str, unit: str, nominal: float, positive: bool, text: str) -> DesignParameter:
    def edit(system: System, value: float) -> System:
        row = _mounting(system, name).row
        changes: dict[str, Any] = {key: round(value) if key in _WHOLE else value}
        if key == "contact_angle" and value and isinstance(row, BallBearing):
            changes["radial_clearance"] = 0.0  # the angle has it already; set besides, it is refused
        return _with(system, name, row=replace(row, **changes))  # type: ignore[type-var]

    return DesignParameter(
        f"{name}.geometry.{key}",
        unit,
        f"{text} of {name}",
        nominal,
        positive,
        lambda system: float(getattr(_mounting(system, name).row, key)),
        edit,
        key in _WHOLE,
    )


def _of_mounting(name: str, key: str, unit: str, text: str, nominal: float, positive: bool) -> DesignParameter:
    def edit(system: System, value: float) -> System:
        if value < 0.0:
            raise InputError(f"{name}.{key}: {value:g} {unit} is below 0; give its size")
        return _with(system, name, **{key: value})

    return DesignParameter(
        f"{name}.{key}",
        unit,
        f"{text} of {name}",
        nominal,
        positive,
        lambda system: float(getattr(_mounting(system, name), key)),
        edit,
    )


def _of_state(name: str, kind: str, dof: str) -> DesignParameter:
    turning = dof.startswith("r")
    units = {"load": ("N", "N.m"), "displacement": ("m", "rad")}

    def values(system: System) -> Mapping[str, float]:
        found = getattr(_mounting(system, name), kind)
        assert found is not None
        return dict(found)

    return DesignParameter(
        f"{name}.{kind}.{dof}",
        units[kind][turning],
        f"{kind.capitalize()} of the inner ring of {name} along {dof}",
        {"load": 1000.0, "displacement": 1e-5}[kind],
        False,
        lambda system: float(values(system)[dof]),
        lambda system, value: _with(system, name, **{kind: exchanged(values(system), dof, value)}),
    )
