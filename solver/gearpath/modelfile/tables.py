"""The tables of a model file; the dataclasses of the floors below hold what is built from them.

Rules between several keys are in `checks`, the resolution of references in `references`.
"""

from collections.abc import Callable, Sequence
from typing import Annotated, Any, Literal, get_args

import numpy as np
from pydantic import BeforeValidator, Field

from ..components.dofs import DOFS
from ..joints.joint import Vector
from ..numerics.arrays import Real
from .bearing_tables import OperationTable
from .foreign_tables import MatricesTable, ModalTable
from .forms import Dofs, Spot
from .hints import hint
from .joint_tables import JOINTS, JointTable
from .leaf import is_table, wrong
from .measured_tables import MeasuredTable
from .numbers import Count, Quantity, Row
from .source_tables import SourceTable
from .structure_tables import FrameTable, PlateTable
from .table import Table
from .train_tables import GearTrainTable, MaterialTable, Named
from .wording import show
from .words import Choice, Text

PLACE = Row("place", Quantity("coordinate", "m", plausible=(-1e3, 1e3), slip="did you mean m, not mm?"), 3)
Quantities = Literal["displacement", "velocity", "acceleration"]


class FrequencyTable(Table):
    """Frequencies of sweeps, evenly spaced."""

    start: Annotated[float, Quantity("first frequency", "Hz", above=0.0)] = 20.0
    stop: Annotated[float, Quantity("last frequency", "Hz", above=0.0)] = 5000.0
    points: Annotated[int, Count("number of frequencies", at_least=2)] = 2000

    def frequencies(self) -> Real:
        """All frequencies, Hz."""
        return np.linspace(self.start, self.stop, self.points)


def _inertia(description: str, **limits: float) -> Quantity:
    return Quantity(f"{description} about the centre of gravity", "kg m^2", **limits)  # type: ignore[arg-type]


class InertiaTable(Table):
    """Inertia tensor about the centre of gravity; the off-diagonal entries are the tensor's own elements."""

    xx: Annotated[float, _inertia("moment of inertia xx", above=0.0)]
    yy: Annotated[float, _inertia("moment of inertia yy", above=0.0)]
    zz: Annotated[float, _inertia("moment of inertia zz", above=0.0)]
    xy: Annotated[float, _inertia("tensor element xy")] = 0.0
    xz: Annotated[float, _inertia("tensor element xz")] = 0.0
    yz: Annotated[float, _inertia("tensor element yz")] = 0.0


class RigidBodyTable(Table):
    """A rigid casing."""

    kind: Annotated[Literal["rigid_body"], Field(description="Rigid body")]
    mass: Annotated[float, Quantity("mass", "kg", above=0.0)]
    inertia: Annotated[InertiaTable, Field(description="Inertia about the centre of gravity")]
    centre_of_gravity: Annotated[Vector, PLACE.named("centre of gravity")] = (0.0, 0.0, 0.0)


ComponentTable = GearTrainTable | RigidBodyTable | PlateTable | FrameTable | MatricesTable | ModalTable | MeasuredTable
COMPONENTS = ("gear_train", "rigid_body", "plate", "frame", "matrices", "modal", "measured")


def _known_kind(what: str, kinds: Sequence[str]) -> Callable[[Any], Any]:
    """Refuses a table whose kind is missing or not available."""

    def check(value: Any) -> Any:
        is_table(value)
        if "kind" not in value:
            known = f"{', '.join(map(show, kinds[:-1]))} or {show(kinds[-1])}"
            raise wrong("is missing", f"give the kind of {what}, {known}", "kind")
        kind = value["kind"]
        if not isinstance(kind, str) or kind not in kinds:
            raise wrong(f"{show(kind)} is not a kind of {what}", hint(kind, kinds), "kind")
        return value

    return check


AnyComponent = Annotated[
    ComponentTable, Field(discriminator="kind"), BeforeValidator(_known_kind("component", COMPONENTS))
]
AnyJoint = Annotated[JointTable, Field(discriminator="kind"), BeforeValidator(_known_kind("joint", JOINTS))]


class ExcitationTable(Table):
    """What drives the machine: the transmission error of a mesh, or a force at a point."""

    mesh: Annotated[str, Text("mesh", "gear_train.mesh")] = ""
    displacement: Annotated[
        float,
        Quantity(
            "amplitude of the transmission error",
            "m",
            above=0.0,
            plausible=(0.0, 0.01),
            slip="did you mean m, not um?",
        ),
    ] = 1.0e-6
    point: Annotated[str, Text("driven point", "gear_train.input.pinion")] = ""
    dof: Annotated[str, Choice("degree of freedom", DOFS)] = ""
    force: Annotated[float, Quantity("amplitude of the force or moment", "N or N m", above=0.0)] = 1.0
    at: Annotated[Vector | None, PLACE.named("driven place on a rigid body")] = None


class ActuatorTable(Table):
    """An additional force or moment input."""

    component: Annotated[str, Text("component")]
    point: Annotated[str | Vector | None, Spot("point", PLACE)] = None
    dof: Annotated[str, Choice("degree of freedom", DOFS)]


class SensorTable(ActuatorTable):
    """An additional motion output."""

    quantity: Annotated[Quantities, Choice("quantity", get_args(Quantities))] = "velocity"


class FileTable(Table):
    """A model file of Gearpath, in SI units."""

    name: Annotated[str, Text("name of the model", "gearbox")]
    dofs: Annotated[tuple[str, ...], Dofs("active degrees of freedom")] = DOFS
    frequency: Annotated[FrequencyTable, Field(description="Frequencies of sweeps")] = FrequencyTable()
    materials: Annotated[Named[MaterialTable], Field(description="Materials by name", default_factory=dict)]
    components: Annotated[Named[AnyComponent], Field(description="Components by name")]
    joints: Annotated[Named[AnyJoint], Field(description="Bearings, mounts and bolted joints by name")]
    excitation: Annotated[ExcitationTable, Field(description="What drives the machine")]
    actuators: Annotated[Named[ActuatorTable], Field(description="Additional inputs by name", default_factory=dict)]
    sensors: Annotated[Named[SensorTable], Field(description="Additional outputs by name", default_factory=dict)]
    operation: Annotated[OperationTable | None, Field(description="Steady torque that loads the rolling bearings")] = (
        None
    )
    catalogue_file: Annotated[
        str, Text("file of further rolling bearings, beside the model file", "my_bearings.toml")
    ] = ""
    source: Annotated[SourceTable | None, Field(description="A gear mesh source inside native FMUs")] = None
