"""Tables of the materials and of the gear train: shafts, sections, disks, meshes."""

from typing import Annotated, Literal, TypeVar

from pydantic import BeforeValidator, Field

from ..components.beam import BEAMS
from ..components.gear_mesh import TORQUES
from .forms import Elements, Ends
from .leaf import is_list, is_table
from .numbers import Quantity, Row
from .table import Table
from .words import Choice, Name, Pair, Text

T = TypeVar("T")
Named = Annotated[dict[Annotated[str, Name("name")], T], BeforeValidator(is_table)]
Several = Annotated[tuple[T, ...], BeforeValidator(is_list)]
Vector = tuple[float, float, float]
Two = tuple[float, float]
_PLACE = Quantity("coordinate", "m", plausible=(-1e3, 1e3), slip="did you mean m, not mm?")


def _length(description: str, longest: float = 100.0) -> Quantity:
    slip = "did you mean m, not mm?"
    return Quantity(description, "m", above=0.0, plausible=(0.0, longest), slip=slip)


def _angle(description: str, at_least: float | None = None) -> Quantity:
    slip = "did you mean rad, not degrees? (20 degrees are 0.349 rad)"
    return Quantity(description, "rad", at_least=at_least, plausible=(-0.8, 0.8), slip=slip)


class MaterialTable(Table):
    """A linear elastic, isotropic material."""

    youngs_modulus: Annotated[
        float,
        Quantity("Young's modulus", "Pa", above=0.0, plausible=(1e6, 1e13), slip="did you mean Pa, not GPa?"),
    ]
    poisson_ratio: Annotated[float, Quantity("Poisson's ratio", above=-1.0, below=0.5)]
    density: Annotated[
        float,
        Quantity(
            "density",
            "kg/m^3",
            above=0.0,
            plausible=(10.0, 3e4),
            slip="did you mean kg/m^3, not g/cm^3 or t/mm^3?",
        ),
    ]


class SectionTable(Table):
    """A stretch of shaft of round section, in order from the first end; a diameter at each end makes a taper."""

    length: Annotated[float, _length("length of the section")]
    outer: Annotated[float | Two, Ends("outer diameter", _length("outer diameter", 10.0))]
    inner: Annotated[float | Two, Ends("inner diameter", Quantity("inner diameter", "m", at_least=0.0))] = 0.0

    def diameters(self) -> tuple[Two, Two]:
        """Outer and inner diameter, each at both ends, m."""
        outer, inner = (value if isinstance(value, tuple) else (value, value) for value in (self.outer, self.inner))
        return outer, inner


class DiskTable(Table):
    """A rigid gear body on a shaft."""

    name: Annotated[str, Name("name of the disk")]
    z: Annotated[float, Quantity("distance of the disk from the shaft's first end", "m", at_least=0.0)]
    mass: Annotated[float, Quantity("mass", "kg", above=0.0)]
    diametral_inertia: Annotated[float, Quantity("moment of inertia about a diameter", "kg m^2", above=0.0)]
    polar_inertia: Annotated[float, Quantity("moment of inertia about the axis", "kg m^2", above=0.0)]


class ShaftTable(Table):
    """A straight shaft along +z; `length` and `diameter`, or `sections`."""

    material: Annotated[str, Text("name of the material", "steel")]
    origin: Annotated[Vector, Row("place of the first end", _PLACE, 3)]
    length: Annotated[float | None, _length("length")] = None
    diameter: Annotated[float | None, _length("diameter", 10.0)] = None
    sections: Annotated[Several[SectionTable], Field(description="Sections from the first end on")] = ()
    beam: Annotated[str, Choice("beam theory", tuple(BEAMS))] = "timoshenko"
    shear_coefficient: Annotated[
        float | None, Quantity("shear coefficient (left out: Cowper's of each section)", above=0.0, at_most=1.0)
    ] = None
    elements: Annotated[
        int | tuple[int, ...],
        Elements("elements between consecutive stations (ends, section changes, disks, joints)"),
    ] = 8
    disks: Annotated[Several[DiskTable], Field(description="Rigid gear bodies on the shaft")] = ()


class MeshTable(Table):
    """A gear mesh; its line of action is y, or follows from the shafts' places and the pressure angle."""

    between: Annotated[tuple[str, str], Pair("two gears, shaft.disk", ("input.pinion", "output.wheel"))]
    stiffness: Annotated[float, Quantity("mesh stiffness", "N/m", above=0.0)]
    base_radii: Annotated[tuple[float, float], Row("base radii of both gears", _length("base radius", 20.0), 2)]
    pressure_angle: Annotated[
        float | None, _angle("transverse pressure angle (left out: the line of action is y)", 0.0)
    ] = None
    helix_angle: Annotated[
        float, _angle("helix angle on the base cylinder, positive where the first gear is right-hand")
    ] = 0.0
    driving_torque: Annotated[
        str, Choice("sense about z of the torque that presses the first gear on the second", tuple(TORQUES))
    ] = ""
    contact_offset: Annotated[
        float | None,
        Quantity("distance along z from the first gear to where the teeth press", "m", plausible=(-10.0, 10.0)),
    ] = None


class GearTrainTable(Table):
    """Shafts, disks and meshes, solved as one component."""

    kind: Annotated[Literal["gear_train"], Field(description="Gear train")]
    modal_damping: Annotated[float, Quantity("damping ratio of every elastic mode", at_least=0.0, below=1.0)] = 0.0
    shafts: Annotated[Named[ShaftTable], Field(description="Shafts by name")]
    meshes: Annotated[Named[MeshTable], Field(description="Gear meshes by name", default_factory=dict)]
