"""Tables of joints: bearings and mounts with matrices, bolted joints as short beams, and rigid ones."""

from typing import Annotated, Literal

from pydantic import Field

from ..joints.joint import Matrix, Vector
from .bearing_tables import ByDof, GeometryTable, Loads
from .forms import Dofs, Impedance
from .numbers import Quantity, Row
from .table import Table
from .words import Choice, Flag, Pair, Text

_PLACE = Row("place", Quantity("coordinate", "m", plausible=(-1e3, 1e3), slip="did you mean m, not mm?"), 3)
_LOSS = Quantity("loss factor eta of (1 + i eta) K", at_least=0.0, at_most=2.0)
_STIFFNESS = Impedance("stiffness", "N/m")
ARRANGEMENTS = ("back_to_back", "face_to_face", "tandem")
_ENDS = Pair("two ends, source and receiver", ("gear_train.input@0.0", "casing"))


def _diameter(description: str, **limits: float) -> Quantity:
    slip = "did you mean m, not mm?"
    return Quantity(description, "m", plausible=(0.0, 1.0), slip=slip, **limits)


class MatrixJointTable(Table):
    """A joint without mass, with stiffness and damping."""

    kind: Annotated[str, Field(description="Kind of joint")]
    between: Annotated[tuple[str, str], _ENDS]
    at: Annotated[Vector | None, _PLACE.named("place of the joint where neither of its ends gives it")] = None
    stiffness: Annotated[float | Matrix | None, _STIFFNESS] = None
    damping: Annotated[float | Matrix | None, Impedance("damping", "N s/m")] = None
    damping_time: Annotated[
        float | None,
        Quantity(
            "time T of the damping C = T K",
            "s",
            at_least=0.0,
            plausible=(0.0, 1.0),
            slip="did you mean s, not us?",
        ),
    ] = None
    loss_factor: Annotated[float, _LOSS] = 0.0


class MountTable(MatrixJointTable):
    """A mount."""

    kind: Annotated[Literal["mount"], Field(description="Mount")]
    stiffness: Annotated[float | Matrix, _STIFFNESS]


class BearingTable(MatrixJointTable):
    """A bearing, by its matrices, or a rolling bearing by its geometry; the first of `between` is its inner ring."""

    kind: Annotated[Literal["bearing"], Field(description="Bearing")]
    geometry: Annotated[
        GeometryTable | None, Field(description="Geometry of a rolling bearing, instead of its stiffness")
    ] = None
    catalogue: Annotated[str, Text("designation of a rolling bearing, instead of its geometry", "7210B-like")] = ""
    load: Annotated[Loads | None, ByDof("load on the inner ring, the rest being held", "N or N m")] = None
    displacement: Annotated[
        Loads | None, ByDof("displacement of the inner ring relative to the outer one, the rest being 0", "m or rad")
    ] = None
    preload: Annotated[
        float, Quantity("axial force with which a row is pressed together before it is loaded", "N", at_least=0.0)
    ] = 0.0
    mirrored: Annotated[bool, Flag("whether the bearing faces the other way, its contact angle negative")] = False
    arrangement: Annotated[str, Choice("way to arrange two rows", ARRANGEMENTS)] = ""
    distance: Annotated[float | None, Quantity("distance of two rows", "m", above=0.0)] = None


class BeamJointTable(Table):
    """A bolted joint: a short massless round beam between two places that lie apart (Eq. 18 to 21)."""

    kind: Annotated[Literal["beam_joint"], Field(description="Bolted joint")]
    between: Annotated[tuple[str, str], _ENDS]
    at: Annotated[Vector | None, _PLACE.named("place of the receiver's end where neither end gives it")] = None
    offset: Annotated[
        Vector | None, _PLACE.named("way from the source's end to the receiver's, where their places do not give it")
    ] = None
    material: Annotated[str, Text("name of the material", "steel")]
    diameter: Annotated[float, _diameter("diameter", above=0.0)]
    inner_diameter: Annotated[float, _diameter("inner diameter", at_least=0.0)] = 0.0
    shear_coefficient: Annotated[
        float | None, Quantity("shear coefficient (left out: Cowper's)", above=0.0, at_most=1.0)
    ] = None
    loss_factor: Annotated[float, _LOSS] = 0.0


class RigidJointTable(Table):
    """A rigid joint: both ends move alike, and their components as one; to the ground: the end does not move."""

    kind: Annotated[Literal["rigid"], Field(description="Rigid joint")]
    between: Annotated[tuple[str, str], _ENDS]
    at: Annotated[Vector | None, _PLACE.named("place of the joint where neither of its ends gives it")] = None
    dofs: Annotated[tuple[str, ...] | None, Dofs("degrees of freedom that are held (left out: all of dofs)")] = None


JointTable = BearingTable | MountTable | BeamJointTable | RigidJointTable
JOINTS = ("bearing", "mount", "beam_joint", "rigid")
