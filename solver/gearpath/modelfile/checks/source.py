"""Rules of the gear mesh source: a mesh to act on, and tones that differ."""

from collections.abc import Sequence
from typing import TypeVar

from ...errors import ModelError
from ..references import find_mesh, mesh_names
from ..source_tables import SourceTable
from ..tables import FileTable
from ..wording import show

T = TypeVar("T")


def check_source(file: FileTable) -> None:
    """Check the table where there is one."""
    table = file.source
    if table is None:
        return
    _check_mesh(file, table)
    if not (table.harmonics or table.sidebands):
        raise ModelError(
            "source.harmonics",
            "there is neither a harmonic nor a sideband",
            "give at least one, { order = 1, amplitude = 0.0 }, or leave the table source out",
        )
    for i, tone in enumerate(table.sidebands):
        if tone.order == 0.0:
            raise ModelError(f"source.sidebands.{i}.order", "0 is the harmonic itself", "give it among harmonics")
    _check_distinct("source.harmonics", [tone.order for tone in table.harmonics])
    _check_distinct("source.sidebands", [(tone.harmonic, tone.order) for tone in table.sidebands])


def _check_mesh(file: FileTable, table: SourceTable) -> None:
    meshes = mesh_names(file)
    if not meshes:
        raise ModelError("source", "there is no gear mesh that it could act on", "add a mesh, or leave the table out")
    if "mesh" in table.model_fields_set:
        find_mesh(file, table.mesh, "source.mesh")
    elif len(meshes) > 1:
        raise ModelError("source.mesh", "is missing", f"give one of the meshes, {' or '.join(map(show, meshes))}")


def _check_distinct(key: str, tones: Sequence[T]) -> None:
    for i, tone in enumerate(tones):
        if tone in tones[:i]:
            shown = show(list(tone) if isinstance(tone, tuple) else tone)
            raise ModelError(f"{key}.{i}", f"{shown} is given twice", "give each tone once, with the sum of both")
