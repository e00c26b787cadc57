"""Rules of the frequencies, the excitation, the actuators and the sensors."""

from ...errors import ModelError
from ...joints import Port
from ...joints.joint import Vector
from ..build_structures import build_plate
from ..foreign_tables import MatricesTable, ModalTable
from ..hints import hint
from ..measured_tables import MeasuredTable
from ..references import find, find_mesh, find_port
from ..structure_tables import FrameTable, PlateTable
from ..supplied import supplied_dofs
from ..tables import ActuatorTable, ExcitationTable, FileTable
from ..train_tables import GearTrainTable
from ..wording import show
from .structures import as_model_error

_OF_MESH, _OF_POINT = ("displacement",), ("dof", "force", "at")


def check_frequency(file: FileTable) -> None:
    """Refuse an inverted range."""
    if file.frequency.stop <= file.frequency.start:
        raise ModelError(
            "frequency.stop",
            f"{file.frequency.stop:g} Hz is not above start, {file.frequency.start:g} Hz",
            "give a stop above start",
        )


def check_excitation(file: FileTable) -> None:
    """Exactly one of mesh and point, with the keys that belong to it."""
    table = file.excitation
    given = table.model_fields_set
    if ("mesh" in given) == ("point" in given):
        problem = f"{show(table.point)} is given beside mesh" if "mesh" in given else "is missing"
        remedy = 'give either mesh = "component.mesh" or point, dof and force'
        raise ModelError("excitation.point" if "mesh" in given else "excitation.mesh", problem, remedy)
    chosen, other, foreign = ("mesh", "point", _OF_POINT) if "mesh" in given else ("point", "mesh", _OF_MESH)
    for key in foreign:
        if key in given:
            value = getattr(table, key)
            value = list(value) if isinstance(value, tuple) else value
            raise ModelError(
                f"excitation.{key}", f"{show(value)} belongs to {other}, not to {chosen}", f"leave {key} out"
            )
    if chosen == "mesh":
        find_mesh(file, table.mesh, "excitation.mesh")
    else:
        _check_point(file, table)


def _check_point(file: FileTable, table: ExcitationTable) -> None:
    if table.point == "ground":
        raise ModelError("excitation.point", '"ground" does not move', "name a component")
    port = find_port(file, table.point, "excitation.point")
    if not table.dof:
        raise ModelError("excitation.dof", "is missing", f"give one of dofs: {', '.join(file.dofs)}")
    _check_active(file, table.dof, "excitation.dof", port)
    component = file.components[port.component]
    if isinstance(component, PlateTable) and port.place is None:
        if table.at is None:
            raise ModelError("excitation.at", "is missing", "give the driven place on the plate, or name a footprint")
        check_on_plate(file, component, table.at, "excitation.at")
    if table.at is not None and (port.shaft is not None or port.place is not None):
        raise ModelError(
            "excitation.at",
            f"{show(list(table.at))} is given beside {show(table.point)}, which has a place",
            "leave at out",
        )


def _check_active(file: FileTable, dof: str, key: str, port: Port | None = None) -> None:
    """Refuse an inactive degree of freedom; a gear that meshes turns even where shafts do not twist."""
    if dof == "rz" and port is not None and port.disk is not None:
        train = file.components[port.component]
        meshes = train.meshes.values() if isinstance(train, GearTrainTable) else ()
        if any(f"{port.shaft}.{port.disk}" in mesh.between for mesh in meshes):
            return
    if dof not in file.dofs:
        raise ModelError(key, f"{show(dof)} is not among the active dofs", hint("", file.dofs))
    supplied = file.dofs if port is None else supplied_dofs(file, port)
    if dof not in supplied:
        raise ModelError(key, f"{show(dof)} is not among the channels of the port", hint("", supplied))


def check_actuators(file: FileTable) -> None:
    """Check every actuator."""
    for name, table in file.actuators.items():
        _check_item(file, table, f"actuators.{name}")


def check_sensors(file: FileTable) -> None:
    """Check every sensor."""
    for name, table in file.sensors.items():
        key = f"sensors.{name}"
        train = _check_item(file, table, key)
        if table.dof == "rz" and _is_turned(file):
            raise ModelError(
                f"{key}.dof",
                '"rz" reads the spin that deforms the meshes, but a torque also makes all gears roll together',
                "add rz to dofs, or leave out the torque or this sensor",
            )
        if table.quantity == "acceleration" and train is not None and train.meshes:
            raise ModelError(
                f"{key}.quantity",
                f'"acceleration" on {show(table.component)} needs the derivative of the transmission error',
                'use "velocity", or put the sensor on the casing',
            )


def _is_turned(file: FileTable) -> bool:
    """Whether a torque acts on a gear whose shaft does not twist."""
    driven = [table.dof for table in file.actuators.values()] + [file.excitation.dof]
    return "rz" not in file.dofs and "rz" in driven


def _check_item(file: FileTable, table: ActuatorTable, key: str) -> GearTrainTable | None:
    """Check component, point and degree of freedom; returns the gear train that it sits on."""
    find("component", table.component, file.components, f"{key}.component")
    component = file.components[table.component]
    train = component if isinstance(component, GearTrainTable) else None
    if isinstance(component, (MatricesTable, ModalTable, MeasuredTable)):
        if not isinstance(table.point, str):
            raise ModelError(f"{key}.point", "is not the name of a port", hint("", component.ports))
        port = find_port(file, f"{table.component}.{table.point}", f"{key}.point")
        _check_active(file, table.dof, f"{key}.dof", port)
        return None
    if isinstance(component, (PlateTable, FrameTable)):
        _check_structure_point(file, component, table, key)
        _check_active(file, table.dof, f"{key}.dof")
        return None
    if train is None and isinstance(table.point, str):
        raise ModelError(
            f"{key}.point",
            f"{show(table.point)} is not a place on a rigid body",
            "give [x, y, z] in m, or leave it out for the centre of gravity",
        )
    if train is not None:
        if not isinstance(table.point, str):
            problem = "is missing" if table.point is None else f"{show(list(table.point))} is not on a shaft"
            raise ModelError(f"{key}.point", problem, 'give "shaft@z" (m from its first end) or "shaft.disk"')
        port = find_port(file, f"{table.component}.{table.point}", f"{key}.point")
        _check_active(file, table.dof, f"{key}.dof", port)
        return train
    _check_active(file, table.dof, f"{key}.dof")
    return None


def _check_structure_point(file: FileTable, component: PlateTable | FrameTable, table: ActuatorTable, key: str) -> None:
    """A footprint, node or point of a plate."""
    if isinstance(table.point, str):
        find_port(file, f"{table.component}.{table.point}", f"{key}.point")
    elif isinstance(component, FrameTable) or table.point is None:
        problem = "is missing" if table.point is None else f"{show(list(table.point))} is not a place of a frame"
        forms = "a node or plate.footprint" if isinstance(component, FrameTable) else "a footprint or [x, y, z]"
        raise ModelError(f"{key}.point", problem, f"give {forms}")
    else:
        check_on_plate(file, component, table.point, f"{key}.point")


def check_on_plate(file: FileTable, table: PlateTable, point: Vector, key: str) -> None:
    """Refuse a point off the plate."""
    plate = build_plate(file.materials, table)
    as_model_error(lambda: plate.structure(("uz",), {}, {"point": point}), key)
