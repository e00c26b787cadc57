"""Rules of rolling bearings: one way to say what they are, and something that loads them."""

from pathlib import Path

import numpy as np

from ...components.mean_load import mean_load
from ...errors import InputError, ModelError
from ...joints.mounting import Mounting, own_state
from ..build import build_mesh
from ..build_bearings import build_mounting
from ..joint_tables import BearingTable
from ..references import find_driving_shaft
from ..tables import FileTable
from ..train_tables import GearTrainTable
from ..wording import show

_STATES = ("load", "displacement", "preload", "mirrored", "arrangement", "distance")


def check_bearing(file: FileTable, table: BearingTable, key: str, catalogue_file: Path | None) -> None:
    """Refuse a bearing that is given twice or not at all, and one that nothing loads."""
    ways = [name for name in ("stiffness", "geometry", "catalogue") if getattr(table, name) not in (None, "")]
    if not ways:
        raise ModelError(
            f"{key}.stiffness", "is missing", "give the stiffness as a matrix on dofs, or geometry, or catalogue"
        )
    if len(ways) > 1:
        raise ModelError(f"{key}.{ways[1]}", f"is given beside {ways[0]}", "leave one of them out")
    given = [name for name in _STATES if name in table.model_fields_set]
    if ways == ["stiffness"]:
        if given:
            raise ModelError(f"{key}.{given[0]}", "is given beside stiffness", "give geometry or catalogue with it")
        return
    if table.load is not None and table.displacement is not None:
        raise ModelError(f"{key}.displacement", "is given beside load", "give one of them; the other follows from it")
    if bool(table.arrangement) != (table.distance is not None):
        missing = "distance" if table.arrangement else "arrangement"
        raise ModelError(f"{key}.{missing}", "is missing", "give arrangement and distance, or neither")
    if table.damping is not None and not isinstance(table.damping, tuple):
        raise ModelError(f"{key}.damping", "is one number", "give a matrix on dofs, or damping_time")
    for name in ("load", "displacement"):
        _check_length(file, getattr(table, name), f"{key}.{name}")
    mounting = build_mounting(table, file.dofs, key, catalogue_file)
    assert mounting is not None
    _check_loaded(file, mounting, key)


def _check_length(file: FileTable, values: object, key: str) -> None:
    if not isinstance(values, tuple):
        return
    if len(values) != len(file.dofs):
        raise ModelError(
            key, f"{show(list(values))} has {len(values)} numbers, dofs {len(file.dofs)}", "give one for each of dofs"
        )
    if "rz" in file.dofs and values[file.dofs.index("rz")] != 0.0:
        raise ModelError(key, "has a number for rz", "give 0: a bearing turns freely about its axis")


def _check_loaded(file: FileTable, mounting: Mounting, key: str) -> None:
    if mounting.follows_operation and file.operation is not None:
        return
    name = "load" if mounting.load is not None else "displacement"
    try:
        state = own_state(mounting)
    except InputError as error:
        problem, _, remedy = str(error).removeprefix("load: ").partition("; ")
        raise ModelError(f"{key}.{name}", problem, remedy or "correct it") from None
    loads = mounting.bearing.contacts(np.zeros(6)).load if state is None else state.element_loads
    if not loads.any():
        where = f"{key}.{name}" if state is not None else key
        raise ModelError(
            where,
            "no rolling element carries load, so that the bearing has no stiffness",
            "give load, displacement or preload, or a table operation with the torque of the gears",
        )


def check_operation(file: FileTable) -> None:
    """Refuse an operation whose torque finds no way through the gears."""
    if file.operation is None:
        return
    name, shaft = find_driving_shaft(file, file.operation.shaft)
    train = file.components[name]
    assert isinstance(train, GearTrainTable)
    meshes = {key: build_mesh(train, table) for key, table in train.meshes.items()}
    try:
        mean_load(meshes, file.operation.torque, shaft)
    except InputError as error:
        problem, _, remedy = str(error).removeprefix("operation.torque: ").partition("; ")
        raise ModelError("operation.torque", problem, remedy) from None
