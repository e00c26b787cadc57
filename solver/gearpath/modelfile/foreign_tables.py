"""Tables of components that come from elsewhere: matrices of finite element codes, and modal models."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from ..components.dofs import DOFS
from ..joints.joint import Vector
from .leaf import Leaf, wrong
from .numbers import Count, Quantity, Row
from .table import Table
from .train_tables import Named
from .wording import show
from .words import Choice, Flag, Text

UNITS = ("SI", "mm-t-s")
_PLACE = Row("place", Quantity("coordinate", "m", plausible=(-1e3, 1e3), slip="did you mean m, not mm?"), 3)
_DAMPING = Quantity("damping ratio of every elastic mode", at_least=0.0, below=1.0)
_LOSS = Quantity("loss factor eta of (1 + i eta) K", at_least=0.0, at_most=2.0)


@dataclass(frozen=True)
class Numbers(Leaf):
    """A list of numbers, or one number."""

    least: float = -float("inf")
    below: float = float("inf")

    def check(self, value: object) -> tuple[float, ...]:
        """The numbers as a tuple."""
        given: list[Any] = list(value) if isinstance(value, (list, tuple)) else [value]
        for number in given:
            if (
                isinstance(number, bool)
                or not isinstance(number, (int, float))
                or not self.least <= number < self.below
            ):
                raise wrong(f"{show(number)} is no {self.description}", f"give {self.wanted()}")
        return tuple(float(number) for number in given)

    def schema(self) -> dict[str, Any]:
        """A number or a list of numbers."""
        return {"anyOf": [{"type": "number"}, {"type": "array", "items": {"type": "number"}}]}


@dataclass(frozen=True)
class Places(Leaf):
    """Indices of coordinates, from 0 on."""

    def check(self, value: object) -> tuple[int, ...]:
        """The indices as a tuple."""
        given: list[Any] = list(value) if isinstance(value, (list, tuple)) else [value]
        for index in given:
            if isinstance(index, bool) or not isinstance(index, int) or index < 0:
                raise wrong(f"{show(index)} is no coordinate", "give its number, from 0 on")
        return tuple(int(index) for index in given)

    def schema(self) -> dict[str, Any]:
        """A list of whole numbers."""
        return {"type": "array", "items": {"type": "integer", "minimum": 0}}


def _coordinate(dof: str) -> Any:
    return Count(f"coordinate that is its {dof}", at_least=0)


class MatrixPortTable(Table):
    """A place of the structure: which of its coordinates move it, by number, by degree of freedom, or by node."""

    coordinates: Annotated[tuple[int, ...] | None, Places("coordinates in the order of the degrees of freedom")] = None
    node: Annotated[int | None, Count("number of the node in the file", at_least=0)] = None
    rotations: Annotated[bool, Flag("whether the node's rotations belong to the port too")] = False
    at: Annotated[Vector | None, _PLACE.named("place of the port")] = None
    ux: Annotated[int | None, _coordinate("ux")] = None
    uy: Annotated[int | None, _coordinate("uy")] = None
    uz: Annotated[int | None, _coordinate("uz")] = None
    rx: Annotated[int | None, _coordinate("rx")] = None
    ry: Annotated[int | None, _coordinate("ry")] = None
    rz: Annotated[int | None, _coordinate("rz")] = None

    @property
    def named(self) -> dict[str, int]:
        """Coordinates that are given by degree of freedom."""
        return {dof: value for dof in DOFS if (value := getattr(self, dof)) is not None}

    def supplied(self, dofs: tuple[str, ...]) -> tuple[str, ...]:
        """The degrees of freedom that it has, in a model of the active ones `dofs`."""
        if self.node is not None:
            return DOFS if self.rotations else DOFS[:3]
        if self.coordinates is None:
            return tuple(self.named)
        return {3: DOFS[:3], 6: DOFS, len(dofs): dofs}.get(len(self.coordinates), ())


def _listed(value: Any) -> Any:
    """A bare list stands for the coordinates of a port."""
    return {"coordinates": value} if isinstance(value, (list, tuple)) else value


def _ports(value: Any) -> Any:
    return {name: _listed(item) for name, item in value.items()} if isinstance(value, Mapping) else value


class MatricesTable(Table):
    """A structure known by its mass and stiffness matrices."""

    kind: Annotated[Literal["matrices"], Field(description="Matrices of a finite element code")]
    file: Annotated[
        str, Text("file of the matrices beside the model file (.npz, .op4, .sti, .mtx of the stiffness)", "casing.npz")
    ]
    mass_file: Annotated[str, Text("file of the mass matrix, where it has one of its own (.mtx)", "mass.mtx")] = ""
    damping_file: Annotated[str, Text("file of a viscous damping matrix (.mtx)", "damping.mtx")] = ""
    units: Annotated[str, Choice("system of units of the file", UNITS)] = "SI"
    rigid_motions: Annotated[
        int | None, Count("number of motions that nothing resists (left out: as the stiffness tells)", 0, 48)
    ] = None
    modal_damping: Annotated[float, _DAMPING] = 0.0
    loss_factor: Annotated[float, _LOSS] = 0.0
    vectors: Annotated[
        int | None, Count("number of interior vectors kept (left out: as many as the frequencies need)", 1, 5000)
    ] = None
    ports: Annotated[Named[MatrixPortTable], BeforeValidator(_ports), Field(description="Ports by name")]


class ModalPortTable(Table):
    """A place of the structure: its mass-normalised shapes, a number of each mode, or its node in the file."""

    node: Annotated[int | None, Count("number of the node in the file", at_least=0)] = None
    rotations: Annotated[bool, Flag("whether the node's rotations belong to the port too")] = False
    at: Annotated[Vector | None, _PLACE.named("place of the port")] = None
    ux: Annotated[tuple[float, ...] | None, Numbers("shape along ux")] = None
    uy: Annotated[tuple[float, ...] | None, Numbers("shape along uy")] = None
    uz: Annotated[tuple[float, ...] | None, Numbers("shape along uz")] = None
    rx: Annotated[tuple[float, ...] | None, Numbers("shape about rx")] = None
    ry: Annotated[tuple[float, ...] | None, Numbers("shape about ry")] = None
    rz: Annotated[tuple[float, ...] | None, Numbers("shape about rz")] = None

    @property
    def named(self) -> dict[str, tuple[float, ...]]:
        """Shapes that are given by degree of freedom."""
        return {dof: value for dof in DOFS if (value := getattr(self, dof)) is not None}

    def supplied(self, dofs: tuple[str, ...]) -> tuple[str, ...]:  # noqa: ARG002 - as of the other ports
        """The degrees of freedom that it has."""
        if self.node is not None:
            return DOFS if self.rotations else DOFS[:3]
        return tuple(self.named)


class ModalTable(Table):
    """A structure known by its modes, measured or computed."""

    kind: Annotated[Literal["modal"], Field(description="Modal model")]
    file: Annotated[str, Text("file of the modes beside the model file (.npz, .unv, .uff)", "casing.unv")] = ""
    units: Annotated[str, Choice("system of units of the file", UNITS)] = "SI"
    frequencies: Annotated[tuple[float, ...] | None, Numbers("frequency in Hz, 0 of rigid motions", least=0.0)] = None
    damping: Annotated[
        tuple[float, ...] | None, Numbers("damping ratio, one for all modes or one a mode", least=0.0, below=1.0)
    ] = None
    modal_masses: Annotated[tuple[float, ...] | None, Numbers("modal mass in kg (left out: 1)", least=1e-300)] = None
    loss_factor: Annotated[float, _LOSS] = 0.0
    ports: Annotated[Named[ModalPortTable], Field(description="Ports by name")]
