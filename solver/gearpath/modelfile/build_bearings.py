"""From the tables of rolling bearings to `Mounting`s."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

from ..errors import InputError, ModelError
from ..joints import Mounting
from ..joints.bearings import (
    BallBearing,
    RollerBearing,
    RollingBearing,
    catalogue_bearing,
    designations,
)
from .bearing_tables import BallTable, Loads
from .hints import hint
from .joint_tables import BearingTable
from .tables import FileTable
from .wording import show

T = TypeVar("T")


def catalogue_of(file: FileTable, folder: Path) -> Path | None:
    """The path of the model's own catalogue of bearings, relative to the folder of the model file."""
    path = folder / file.catalogue_file
    if file.catalogue_file and not path.is_file():
        remedy = "give the path of a bearing catalogue (TOML), from the folder of the model file"
        raise ModelError("catalogue_file", f"{file.catalogue_file}: there is no such file", remedy)
    return path if file.catalogue_file else None


def build_mounting(
    table: BearingTable, dofs: tuple[str, ...], key: str, catalogue_file: Path | None
) -> Mounting | None:
    """The mounted bearing of a table, None where it is given by its matrices; raises ModelError."""
    row = _row(table, key, catalogue_file)
    if row is None:
        return None
    if table.mirrored:
        row = row.mirrored()
    mounting = Mounting(
        row,
        table.arrangement,
        table.distance or 0.0,
        table.preload,
        _by_name(table.load, dofs),
        _by_name(table.displacement, dofs),
        table.damping_time or 0.0 if table.damping is None else None,
    )
    alone = replace(mounting, preload=0.0)
    _named(lambda: alone.bearing, f"{key}.arrangement")
    _named(lambda: mounting.bearing, f"{key}.preload")
    return mounting


def _row(table: BearingTable, key: str, catalogue_file: Path | None) -> RollingBearing | None:
    if table.geometry is not None:
        numbers = table.geometry.model_dump(exclude={"type"})
        kind = BallBearing if isinstance(table.geometry, BallTable) else RollerBearing
        return _named(lambda: kind(**numbers), f"{key}.geometry")
    if not table.catalogue:
        return None
    file = catalogue_file
    if file is not None and table.catalogue not in _named(lambda: designations(file), "catalogue_file"):
        file = None
    known = [*designations(), *(designations(catalogue_file) if catalogue_file else ())]
    if file is None and table.catalogue not in known:
        problem = f"there is no bearing {show(table.catalogue)}"
        raise ModelError(f"{key}.catalogue", problem, hint(table.catalogue, known))
    return _named(lambda: catalogue_bearing(table.catalogue, file), f"{key}.catalogue")


def _by_name(values: Loads | None, dofs: tuple[str, ...]) -> Mapping[str, float] | None:
    if isinstance(values, tuple):
        return {dof: value for dof, value in zip(dofs, values) if dof != "rz"}
    return values


def _named(make: Callable[[], T], key: str) -> T:
    """What a bearing refuses, as an error of the file."""
    try:
        return make()
    except InputError as error:
        problem, _, remedy = str(error).partition("; ")
        argument, _, text = problem.partition(": ")
        if argument.isidentifier():  # a key of the geometry, else an argument that the file has no name for
            key, problem = f"{key}.{argument}" if key.endswith(".geometry") else key, text
        raise ModelError(key, problem, remedy or "correct it") from None
