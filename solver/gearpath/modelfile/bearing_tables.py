"""Tables of rolling bearings: their geometry, and the operation of the machine that loads them."""

from dataclasses import dataclass
from math import pi
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from ..components.dofs import DOFS
from .hints import hint
from .leaf import Leaf, is_table, wrong
from .numbers import Count, Quantity
from .table import Table
from .wording import show
from .words import Text

_MM = "did you mean m, not mm?"
_LENGTH = {"unit": "m", "above": 0.0, "plausible": (0.0, 10.0), "slip": _MM}
_STEEL = (2.06e11, 0.3)
TYPES = ("ball", "roller")
Loads = dict[str, float] | tuple[float, ...]


def _angle(description: str, most: float) -> Quantity:
    return Quantity(description, "rad", plausible=(-most, most), slip="did you mean rad, not degrees?")


def _clearance() -> Quantity:
    text = "radial clearance, half the diametral one, negative where it is interference"
    return Quantity(text, "m", plausible=(-1e-2, 1e-2), slip="did you mean m, not um?")


class BallTable(Table):
    """A ball bearing."""

    type: Annotated[Literal["ball"], Field(description="Ball bearing")]
    balls: Annotated[int, Count("number of balls", at_most=1000)]
    ball_diameter: Annotated[float, Quantity("ball diameter", **_LENGTH)]
    pitch_diameter: Annotated[float, Quantity("diameter of the circle of ball centres", **_LENGTH)]
    inner_conformity: Annotated[float, Quantity("inner groove radius / ball diameter", above=0.5, below=1.0)]
    outer_conformity: Annotated[float, Quantity("outer groove radius / ball diameter", above=0.5, below=1.0)]
    contact_angle: Annotated[float, _angle("free contact angle, positive where +uz loads the bearing", pi / 2.0)]
    radial_clearance: Annotated[float, _clearance()] = 0.0
    youngs_modulus: Annotated[float, Quantity("Young's modulus", "Pa", above=0.0)] = _STEEL[0]
    poisson_ratio: Annotated[float, Quantity("Poisson's ratio", at_least=0.0, below=0.5)] = _STEEL[1]
    phase: Annotated[float, _angle("place of the first ball, from +x to +y", 1e3)] = 0.0


class RollerTable(Table):
    """A cylindrical or tapered roller bearing."""

    type: Annotated[Literal["roller"], Field(description="Roller bearing")]
    rollers: Annotated[int, Count("number of rollers", at_most=1000)]
    roller_length: Annotated[float, Quantity("effective length of a roller", **_LENGTH)]
    pitch_radius: Annotated[float, Quantity("radius of the circle of roller centres", **_LENGTH)]
    contact_angle: Annotated[
        float, _angle("contact angle, 0 where cylindrical, positive where +uz loads the bearing", pi / 2.0)
    ]
    slices: Annotated[int, Count("number of slices of a roller, 1 where it is lumped", at_most=1000)] = 31
    radial_clearance: Annotated[float, _clearance()] = 0.0
    phase: Annotated[float, _angle("place of the first roller, from +x to +y", 1e3)] = 0.0
    contact_stiffness: Annotated[
        float | None, Quantity("contact constant of a whole roller (left out: ISO/TS 16281)", "N/m^(10/9)", above=0.0)
    ] = None


def _known_type(value: Any) -> Any:
    is_table(value)
    if "type" not in value:
        raise wrong("is missing", 'give the type of bearing, "ball" or "roller"', "type")
    if value["type"] not in TYPES:
        raise wrong(f"{show(value['type'])} is not a type of bearing", hint(value["type"], TYPES), "type")
    return value


GeometryTable = Annotated[BallTable | RollerTable, Field(discriminator="type"), BeforeValidator(_known_type)]


@dataclass(frozen=True)
class ByDof(Leaf):
    """Numbers by degree of freedom: a table of names, or a list on the model's `dofs`."""

    units: str

    def check(self, value: object) -> Loads:
        """The table or the list; whether a list is as long as `dofs` is checked with the whole model."""
        number = Quantity(self.description, self.units)
        if isinstance(value, list) and value:
            return tuple(number.check(item) for item in value)
        if not isinstance(value, dict) or not value:
            raise wrong(f"{show(value)} is not a table of degrees of freedom", f"give {self.wanted()}")
        for name in value:
            if name not in DOFS[:5]:
                free = "a bearing turns freely about its axis" if name == "rz" else hint(name, DOFS[:5])
                raise wrong(f"{show(name)} is not a degree of freedom of a bearing", free)
        return {name: number.check(item) for name, item in value.items()}

    def wanted(self) -> str:
        """Both forms."""
        return f"the {self.description} in {self.units}, such as {{ ux = ..., uz = ... }}, or a list on dofs"

    def explanation(self) -> str:
        """Both forms with their units."""
        return f"{super().explanation()}, in {self.units}: a table by degree of freedom, or a list on dofs"

    def schema(self) -> dict[str, Any]:
        """An object of numbers, or an array."""
        names = {name: {"type": "number"} for name in DOFS[:5]}
        table = {"type": "object", "properties": names, "additionalProperties": False, "minProperties": 1}
        array = {"type": "array", "items": {"type": "number"}, "minItems": 1, "maxItems": len(DOFS)}
        return {"oneOf": [table, array], "x-unit": self.units}


class OperationTable(Table):
    """A steady torque through the gears, which loads the bearings that are given by their geometry."""

    torque: Annotated[
        float,
        Quantity(
            "torque on the driving shaft, in the sense that presses the teeth together (driving_torque turns it round)",
            "N m",
            at_least=0.0,
        ),
    ]
    speed: Annotated[
        float | None,
        Quantity("speed of the driving shaft, for a warning where centrifugal forces matter", "rev/min", at_least=0.0),
    ] = None
    shaft: Annotated[
        str, Text("shaft where the torque enters (left out: the first gear's of the first mesh)", "gear_train.input")
    ] = ""
