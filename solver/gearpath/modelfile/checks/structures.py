"""Rules of plates and frames: materials, places, forms; what only the mesh can tell is asked of the mesh."""

from collections.abc import Callable
from functools import lru_cache, partial

from ...components import Frame, Plate
from ...errors import InputError, ModelError
from ..build_structures import build_frame, build_plate
from ..foreign_tables import MatricesTable
from ..references import find, places_of
from ..structure_tables import BeamTable, FrameTable, PlateShape, PlateTable
from ..tables import FileTable
from ..wording import show

_MOST_ELEMENTS = 40_000


@lru_cache(maxsize=64)
def _meshes(part: Plate | Frame) -> None:
    """Mesh it once: a model is changed and checked again many times in a study."""
    part.mesh()


def check_plate(file: FileTable, table: PlateTable, key: str) -> None:
    """A plate on its own."""
    check_damping(table, key)
    _check_shape(file, table, key)
    as_model_error(lambda: _meshes(build_plate(file.materials, table)), key)


def check_frame(file: FileTable, table: FrameTable, key: str) -> None:
    """A frame, its plates and its beams."""
    check_damping(table, key)
    if not table.beams and not table.plates:
        raise ModelError(f"{key}.beams", "there is neither a beam nor a plate", "give at least one of them")
    for name, plate in table.plates.items():
        _check_shape(file, plate, f"{key}.plates.{name}")
        as_model_error(partial(_meshes, build_plate(file.materials, plate)), f"{key}.plates.{name}")
    for name in table.nodes:
        if name in table.plates:
            raise ModelError(f"{key}.nodes.{name}", f"{show(name)} is also the name of a plate", "choose another name")
    places = places_of(table)
    for name, beam in table.beams.items():
        _check_beam(file, beam, places, f"{key}.beams.{name}")
    as_model_error(lambda: _meshes(build_frame(file.materials, table)), key)


def check_damping(table: PlateTable | FrameTable | MatricesTable, key: str) -> None:
    """Refuse two kinds of damping of one component."""
    if table.modal_damping and table.loss_factor:
        raise ModelError(
            f"{key}.loss_factor",
            f"{table.loss_factor:g} is given beside modal_damping, {table.modal_damping:g}",
            "give either modal_damping or loss_factor",
        )


def _check_shape(file: FileTable, table: PlateShape, key: str) -> None:
    find("material", table.material, file.materials, f"{key}.material")
    if isinstance(table.elements, tuple) and len(table.elements) != 2:
        raise ModelError(
            f"{key}.elements",
            f"{show(list(table.elements))} is not a pair",
            "give one number for both axes, or two",
        )
    counts = table.elements if isinstance(table.elements, tuple) else (table.elements,) * 2
    if counts[0] * counts[1] > _MOST_ELEMENTS:
        raise ModelError(
            f"{key}.elements",
            f"{counts[0]} x {counts[1]} elements are more than {_MOST_ELEMENTS}",
            "give fewer: about 16 for every half wave of the highest frequency are enough",
        )
    if table.thickness > min(table.lengths) / 2.0:
        raise ModelError(
            f"{key}.thickness",
            f"{table.thickness:g} m is no thickness of a plate of {table.lengths[0]:g} x {table.lengths[1]:g} m",
            "did you mean m, not mm?",
        )


def _check_beam(file: FileTable, table: BeamTable, places: list[str], key: str) -> None:
    find("material", table.material, file.materials, f"{key}.material")
    for place in table.between:
        find("place", place, places, f"{key}.between")
    if table.inner_diameter >= table.diameter:
        raise ModelError(
            f"{key}.inner_diameter",
            f"{table.inner_diameter:g} m is not below the diameter, {table.diameter:g} m",
            "give an inner diameter below the outer one, 0 for a solid bar",
        )


def as_model_error(build: Callable[[], object], key: str) -> None:
    """What the mesh refuses, as an error of the file; its sentences are "problem; remedy"."""
    try:
        build()
    except InputError as error:
        problem, _, remedy = str(error).partition("; ")
        raise ModelError(key, problem, remedy or "correct it") from None
