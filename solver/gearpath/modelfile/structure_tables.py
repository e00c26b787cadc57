"""Tables of flexible structures: plates with footprints, and frames of beams and plates."""

from typing import Annotated, Literal

from pydantic import Field

from ..components.beam import BEAMS
from ..joints.joint import Vector
from .forms import Elements
from .numbers import Count, Quantity, Row
from .table import Table
from .train_tables import Named
from .words import Choice, Pair, Text

_COORDINATE = Quantity("coordinate", "m", plausible=(-1e3, 1e3), slip="did you mean m, not mm?")
_PLACE = Row("place", _COORDINATE, 3)
_DIRECTION = Row("direction", Quantity("component"), 3)
_DAMPING = Quantity("damping ratio of every elastic mode", at_least=0.0, below=1.0)
_LOSS = Quantity("loss factor eta of (1 + i eta) K", at_least=0.0, at_most=2.0)
_VECTORS = Count("number of interior vectors kept (left out: as many as the frequencies need)", 1, 5000)


def _length(description: str, longest: float = 100.0) -> Quantity:
    slip = "did you mean m, not mm?"
    return Quantity(description, "m", above=0.0, plausible=(0.0, longest), slip=slip)


class FootprintTable(Table):
    """A rigid rectangle of a plate, where something is attached; without a size a point."""

    centre: Annotated[Vector, _PLACE.named("centre of the footprint")]
    size: Annotated[
        tuple[float, float],
        Row("widths along the two axes of the plate", Quantity("width", "m", at_least=0.0), 2),
    ] = (0.0, 0.0)


class PlateShape(Table):
    """What a plate is made of, wherever it stands."""

    material: Annotated[str, Text("name of the material", "steel")]
    centre: Annotated[Vector, _PLACE.named("centre of the middle surface")]
    lengths: Annotated[tuple[float, float], Row("lengths along the two axes", _length("length of a side"), 2)]
    thickness: Annotated[float, _length("thickness", 10.0)]
    axis_1: Annotated[Vector, _DIRECTION.named("first axis, in the plate")] = (1.0, 0.0, 0.0)
    axis_2: Annotated[Vector, _DIRECTION.named("second axis, in the plate, across the first")] = (0.0, 1.0, 0.0)
    elements: Annotated[int | tuple[int, ...], Elements("elements along each of the two axes")]
    shear_coefficient: Annotated[float, Quantity("shear coefficient", above=0.0, at_most=1.0)] = 5.0 / 6.0
    footprints: Annotated[
        Named[FootprintTable], Field(description="Places of attachment by name", default_factory=dict)
    ]


class PlateTable(PlateShape):
    """A flat rectangular plate, flexible in and out of its plane (Mindlin)."""

    kind: Annotated[Literal["plate"], Field(description="Plate")]
    modal_damping: Annotated[float, _DAMPING] = 0.0
    loss_factor: Annotated[float, _LOSS] = 0.0
    vectors: Annotated[int | None, _VECTORS] = None


class BeamTable(Table):
    """A straight round beam between two places of a frame."""

    between: Annotated[tuple[str, str], Pair("two places, nodes or plate.footprint", ("plate.upper", "tip"))]
    material: Annotated[str, Text("name of the material", "steel")]
    diameter: Annotated[float, _length("diameter", 10.0)]
    inner_diameter: Annotated[float, Quantity("inner diameter", "m", at_least=0.0)] = 0.0
    shear_coefficient: Annotated[
        float | None, Quantity("shear coefficient (left out: Cowper's)", above=0.0, at_most=1.0)
    ] = None
    elements: Annotated[int, Count("number of elements", 1, 1000)] = 8
    beam: Annotated[str, Choice("beam theory", tuple(BEAMS))] = "timoshenko"


class FrameTable(Table):
    """Beams and plates joined at nodes into one flexible structure."""

    kind: Annotated[Literal["frame"], Field(description="Frame")]
    modal_damping: Annotated[float, _DAMPING] = 0.0
    loss_factor: Annotated[float, _LOSS] = 0.0
    vectors: Annotated[int | None, _VECTORS] = None
    nodes: Annotated[
        Named[Annotated[Vector, _PLACE.named("place of the node")]],
        Field(description="Nodes by name", default_factory=dict),
    ]
    beams: Annotated[Named[BeamTable], Field(description="Beams by name", default_factory=dict)]
    plates: Annotated[Named[PlateShape], Field(description="Plates by name", default_factory=dict)]
