"""Design parameters of a system: numbers that the components have to be solved again for.

Bundled into the python FMU; imports floors 1 to 4 only.
"""

from collections.abc import Mapping

import numpy as np

from ..components import GearTrain, RigidBody, Shaft
from ..errors import InputError
from ..network.operation import at_operating_point
from ..network.system import System
from .python_bearings import bearing_parameters, operation_parameters
from .python_parts import DesignParameter, body_parameters, joint_position, mesh_position, shaft_parameters

ROUNDED = 1e-3  # printed inertias are rounded: a flat body may miss the triangle inequality by this part
_SAME = 1e-9  # a place beyond a shaft's end by this part of its length is the end


def design_parameters(system: System) -> tuple[DesignParameter, ...]:
    """All design parameters, in the order in which `redesign` applies them."""
    found: list[DesignParameter] = []
    for name, component in system.components.items():
        if isinstance(component, RigidBody):
            found += body_parameters(name, component)
        elif isinstance(component, GearTrain):
            for shaft in component.shafts:
                found += shaft_parameters(name, shaft, component.shafts[shaft])
            found += [mesh_position(name, mesh) for mesh in component.meshes]
    for name, joint in system.joints.items():
        if joint.at is not None:
            found += [joint_position(name, axis) for axis in range(3)]
        if joint.mounting is not None:
            found += bearing_parameters(name, joint.mounting)
    if system.operation is not None:
        found += operation_parameters(system.operation)
    return tuple(found)


def redesign(system: System, values: Mapping[str, float]) -> System:
    """The system with the given design parameters set, the others untouched.

    The order of `values` does not matter. A length stretches its shaft with everything on it; a mesh with
    a position stands there afterwards. Bearings given by their geometry have the stiffness of the operating point that
    all this makes. Raises InputError where the parts do not fit together.
    """
    changed = system
    for parameter in design_parameters(system):
        if parameter.name in values:
            parameter.check(values[parameter.name])
            changed = parameter.edit(changed, float(values[parameter.name]))
    for name, component in changed.components.items():
        if isinstance(component, RigidBody):
            _check_body(name, component)
        elif isinstance(component, GearTrain):
            for shaft_name, shaft in component.shafts.items():
                _check_shaft(f"{name}.{shaft_name}", shaft)
    return at_operating_point(changed)


def _check_body(name: str, body: RigidBody) -> None:
    low, middle, high = np.linalg.eigvalsh(body.inertia_matrix()[3:, 3:])
    if not low > 0.0 or high > (1.0 + ROUNDED) * (low + middle):
        raise InputError(
            f"no body has the principal moments of inertia {low:.4g}, {middle:.4g} and {high:.4g} kg m^2; "
            f"set {name}.inertia_xx and the others about the centre of gravity"
        )


def _check_shaft(name: str, shaft: Shaft) -> None:
    for section in shaft.sections:
        if section.outer <= section.inner:
            raise InputError(
                f"the outer diameter {section.outer:g} m of {name} must exceed the inner, {section.inner:g} m"
            )
    for disk in shaft.disks:
        if not -_SAME * shaft.length <= disk.z <= (1.0 + _SAME) * shaft.length:
            raise InputError(
                f"the disk {disk.name} lies off the shaft {name}, {disk.z:g} m from its first end; "
                f"give it a place from 0 to {shaft.length:g} m"
            )
