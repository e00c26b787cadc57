"""References within a model file: "gear_train.input@0.0", "casing", "gear_train.mesh"."""

import re
from collections.abc import Iterable
from math import inf, isfinite

from ..errors import ModelError
from ..joints import Port
from .foreign_tables import MatricesTable, ModalTable
from .hints import hint
from .joint_tables import BeamJointTable
from .measured_tables import MeasuredTable
from .structure_tables import FrameTable, PlateTable
from .tables import FileTable, RigidBodyTable
from .train_tables import GearTrainTable, ShaftTable
from .wording import show

Ported = MatricesTable | ModalTable | MeasuredTable
PORTED = (MatricesTable, ModalTable, MeasuredTable)
SAME = 1e-9  # rounding of stations, relative to the shaft's length
_NAME = r"[A-Za-z][A-Za-z0-9_]*"
_PORT = re.compile(rf"(?P<component>{_NAME})(?:\.(?P<shaft>{_NAME}))?(?:@(?P<z>[^@\s]+)|\.(?P<disk>{_NAME}))?")
_FORMS = 'write "component.shaft@z", "component.shaft.disk", "component" or "ground"'


def find(kind: str, name: str, known: Iterable[str], key: str) -> None:
    """Refuse the name of something that is not there."""
    names = list(known)
    if name not in names:
        raise ModelError(key, f"there is no {kind} {show(name)}", hint(name, names))


def length(shaft: ShaftTable) -> float:
    """Length of a shaft, m."""
    return sum(section.length for section in shaft.sections) if shaft.sections else shaft.length or 0.0


def find_port(file: FileTable, text: str, key: str) -> Port:
    """The port that `text` names, in a file whose shafts are checked; raises ModelError."""
    if text == "ground":
        return Port("ground")
    found = _PORT.fullmatch(text)
    if found is None:
        raise ModelError(key, f"{show(text)} is not a reference", _FORMS)
    name, shaft, z, disk = found.group("component", "shaft", "z", "disk")
    find("component", name, file.components, key)
    component = file.components[name]
    if isinstance(component, (PlateTable, FrameTable, *PORTED)):
        return _structure_port(name, component, text, key)
    if isinstance(component, RigidBodyTable):
        if text != name:
            raise ModelError(
                key,
                f"{show(text)} names a part of a rigid body",
                f'write "{name}" and give the place with at',
            )
        return Port(name)
    example = shaft or next(iter(component.shafts))
    if shaft is not None:
        find("shaft", f"{name}.{shaft}", [f"{name}.{other}" for other in component.shafts], key)
    if shaft is None or (z is None and disk is None):
        raise ModelError(
            key,
            f"{show(text)} names no place on a shaft",
            f'write "{name}.{example}@0.0" (distance from the shaft\'s first end in m) or the name of a disk',
        )
    table = component.shafts[shaft]
    if disk is not None:
        disks = [f"{name}.{shaft}.{item.name}" for item in table.disks]
        find("disk", text, disks, key)
        return Port(name, shaft, disk=disk)
    return Port(name, shaft, z=_station(text, z, length(table), key))


def _structure_port(name: str, table: PlateTable | FrameTable | Ported, text: str, key: str) -> Port:
    """A footprint or the whole of a plate (with a place given by `at`), a place of a frame, a port from elsewhere."""
    if isinstance(table, PlateTable) and text == name:
        return Port(name)
    if isinstance(table, PORTED):
        known, what, whole = list(table.ports), "port", f"{table.kind} component"
    elif isinstance(table, PlateTable):
        known, what, whole = list(table.footprints), "footprint", "plate"
    else:
        known, what, whole = places_of(table), "place", "frame"
    place = text[len(name) + 1 :]
    if place not in known:
        problem = f"there is no {what} {show(text)}" if place else f"{show(text)} names no {what} on a {whole}"
        raise ModelError(key, problem, hint(text, [f"{name}.{other}" for other in known]))
    return Port(name, place=place)


def places_of(table: FrameTable) -> list[str]:
    """Everything of a frame that something can be attached to."""
    return [*table.nodes, *(f"{name}.{spot}" for name, plate in table.plates.items() for spot in plate.footprints)]


def _station(text: str, z: str, end: float, key: str) -> float:
    try:
        value = float(z)
    except ValueError:
        value = inf
    if not isfinite(value):
        raise ModelError(key, f"{show(text)} has no number after @", "give the distance in m, such as @0.125")
    if not -SAME * end <= value <= (1.0 + SAME) * end:
        raise ModelError(key, f"{show(text)} lies off the shaft", f"give a station from 0 to {end:.9g} m")
    return min(max(value, 0.0), end)


def find_gear(train: GearTrainTable, text: str, key: str) -> tuple[str, str]:
    """(shaft, disk) of the gear "shaft.disk" of a mesh."""
    gears = [f"{name}.{disk.name}" for name, shaft in train.shafts.items() for disk in shaft.disks]
    find("gear", text, gears, key)
    shaft, disk = text.split(".")
    return shaft, disk


def mesh_names(file: FileTable) -> list[str]:
    """References "component.mesh" of all meshes."""
    return [
        f"{name}.{mesh}"
        for name, component in file.components.items()
        if isinstance(component, GearTrainTable)
        for mesh in component.meshes
    ]


def find_mesh(file: FileTable, text: str, key: str) -> tuple[str, str]:
    """(component, mesh) of the reference "component.mesh"."""
    find("mesh", text, mesh_names(file), key)
    component, mesh = text.split(".")
    return component, mesh


def station_of(file: FileTable, port: Port) -> float | None:
    """Distance of a port from its shaft's first end, m; None off a gear train."""
    if port.disk is None:
        return port.z
    train = file.components[port.component]
    assert isinstance(train, GearTrainTable)
    assert port.shaft is not None
    return next(disk.z for disk in train.shafts[port.shaft].disks if disk.name == port.disk)


def place_of(file: FileTable, port: Port) -> tuple[float, float, float] | None:
    """Global place of a shaft station, a footprint or a node, m; None where the joint gives it."""
    train = None if port.is_ground else file.components[port.component]
    if isinstance(train, (PlateTable, FrameTable, *PORTED)):
        return _structure_place(train, port.place)
    z = station_of(file, port)
    if not isinstance(train, GearTrainTable) or port.shaft is None or z is None:
        return None
    x0, y0, z0 = train.shafts[port.shaft].origin
    return (x0, y0, z0 + z)


def _structure_place(table: PlateTable | FrameTable | Ported, place: str | None) -> tuple[float, float, float] | None:
    if place is None:
        return None
    if isinstance(table, PORTED):
        return table.ports[place].at
    if isinstance(table, PlateTable):
        return table.footprints[place].centre
    if place in table.nodes:
        return table.nodes[place]
    plate, footprint = place.split(".")
    return table.plates[plate].footprints[footprint].centre


def beam_offset(file: FileTable, table: BeamJointTable) -> tuple[float, float, float]:
    """From the source's end of a beam joint to the receiver's: given, or the way between their places."""
    if table.offset is not None:
        return table.offset
    start, end = (place_of(file, find_port(file, text, "between")) for text in table.between)
    end = table.at if end is None else end
    assert start is not None
    assert end is not None
    return (end[0] - start[0], end[1] - start[1], end[2] - start[2])


def find_driving_shaft(file: FileTable, text: str) -> tuple[str, str | None]:
    """(gear train, shaft) where the torque of the operation enters; no shaft where `text` names none."""
    trains = [name for name, table in file.components.items() if isinstance(table, GearTrainTable) and table.meshes]
    if text:
        shafts = [f"{name}.{shaft}" for name in trains for shaft in _trained(file, name).shafts]
        find("shaft", text, shafts, "operation.shaft")
        component, shaft = text.split(".")
        return component, shaft
    if len(trains) != 1:
        problem = "there is no gear mesh that could carry a torque" if not trains else "is missing"
        remedy = "leave the table operation out" if not trains else f"name a shaft of {' or '.join(map(show, trains))}"
        raise ModelError("operation.shaft" if trains else "operation", problem, remedy)
    return trains[0], None


def _trained(file: FileTable, name: str) -> GearTrainTable:
    table = file.components[name]
    assert isinstance(table, GearTrainTable)
    return table
