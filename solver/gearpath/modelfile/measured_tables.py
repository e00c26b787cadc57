"""Tables of measured components: the file of their FRFs, its units, and what its channels are."""

from dataclasses import dataclass
from typing import Annotated, Any, Literal, get_args

from pydantic import Field

from ..joints.joint import Vector
from .hints import hint
from .leaf import Leaf, wrong
from .numbers import Count, Quantity, Row
from .table import Table
from .train_tables import Named
from .wording import show
from .words import Choice, Text

Measurands = Literal["accelerance", "mobility", "receptance"]
FORCES = {"N": 1.0, "kN": 1e3, "lbf": 4.4482216152605}
MOTIONS = {
    "accelerance": {"m/s^2": 1.0, "mm/s^2": 1e-3, "g": 9.80665, "in/s^2": 0.0254},
    "mobility": {"m/s": 1.0, "mm/s": 1e-3, "in/s": 0.0254},
    "receptance": {"m": 1.0, "mm": 1e-3, "um": 1e-6, "in": 0.0254},
}
_PLACE = Row("place", Quantity("coordinate", "m", plausible=(-1e3, 1e3), slip="did you mean m, not mm?"), 3)


@dataclass(frozen=True)
class Unit(Leaf):
    """The name of a unit, or a number of SI units that it is."""

    words: tuple[str, ...]

    def check(self, value: object) -> str | float:
        """The name or the factor."""
        if isinstance(value, str):
            if value not in self.words:
                raise wrong(f"{show(value)} is not a known {self.description}", hint(value, self.words))
            return value
        return Quantity(f"{self.description} in SI units", above=0.0).check(value)

    def schema(self) -> dict[str, Any]:
        """A name or a positive number."""
        return {"anyOf": [{"type": "string", "enum": list(self.words)}, {"type": "number", "exclusiveMinimum": 0}]}


@dataclass(frozen=True)
class Channel(Leaf):
    """A channel of a file of FRFs: its number from 0 on, or its name."""

    def check(self, value: object) -> int | str:
        """The number or the name."""
        if isinstance(value, str) and value.strip():
            return value
        if isinstance(value, bool) or not isinstance(value, int) or value < 0:
            raise wrong(f"{show(value)} is not a channel", 'give its number from 0 on, or its name, such as "12:uy"')
        return value

    def schema(self) -> dict[str, Any]:
        """A whole number or a name."""
        return {"anyOf": [{"type": "integer", "minimum": 0}, {"type": "string", "minLength": 1}]}


def _channel(dof: str) -> Any:
    return Channel(f"channel that moves along {dof}" if dof[0] == "u" else f"channel that turns about {dof[1]}")


class MeasuredPortTable(Table):
    """A place of a measured component: what was measured there, in the axes of the model."""

    at: Annotated[Vector | None, _PLACE.named("place of the port")] = None
    ux: Annotated[int | str | None, _channel("ux")] = None
    uy: Annotated[int | str | None, _channel("uy")] = None
    uz: Annotated[int | str | None, _channel("uz")] = None
    rx: Annotated[int | str | None, _channel("rx")] = None
    ry: Annotated[int | str | None, _channel("ry")] = None
    rz: Annotated[int | str | None, _channel("rz")] = None

    @property
    def channels(self) -> dict[str, int | str]:
        """Channel by degree of freedom, in the order of the frame."""
        return {dof: value for dof in _DOFS if (value := getattr(self, dof)) is not None}


_DOFS = ("ux", "uy", "uz", "rx", "ry", "rz")


class MeasuredTable(Table):
    """A structure known by its measured frequency responses."""

    kind: Annotated[Literal["measured"], Field(description="Measured structure")]
    file: Annotated[str, Text("file of FRFs beside the model file (.unv, .uff, .npz or .csv)", "casing.unv")]
    quantity: Annotated[
        Measurands | Literal[""],
        Choice("quantity that was measured (left out: what the file says)", get_args(Measurands)),
    ] = ""
    unit_force: Annotated[
        str | float | None, Unit("unit of the forces (left out: what the file says, or N)", tuple(FORCES))
    ] = None
    unit_motion: Annotated[
        str | float | None,
        Unit(
            "unit of the motions (left out: what the file says, or SI)",
            tuple(word for words in MOTIONS.values() for word in words),
        ),
    ] = None
    ports: Annotated[Named[MeasuredPortTable], Field(description="Ports by name")]
    tolerance: Annotated[
        float, Quantity("error of the fit for time, of each FRF's largest gain", above=0.0, below=1.0)
    ] = 1e-3
    modes: Annotated[
        int | None, Count("largest number of modes of that fit (left out: as many as are worth it)", 1, 1000)
    ] = None
