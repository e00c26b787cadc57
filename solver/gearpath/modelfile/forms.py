"""Values that may take two forms: a joint's number or matrix, elements per span, places, active freedoms."""

import math
from dataclasses import dataclass
from typing import Any

from ..components.dofs import DOFS
from .hints import hint
from .leaf import Leaf, wrong
from .numbers import Quantity
from .wording import show
from .words import Text

Matrix = tuple[tuple[float, ...], ...]
_MOST_ELEMENTS = 1000


@dataclass(frozen=True)
class Impedance(Leaf):
    """Stiffness or damping of a joint: one number along uy, or a square matrix on the model's `dofs`."""

    unit: str

    def check(self, value: object) -> float | Matrix:
        """The number, or the rows of the matrix; symmetry and size are checked with the whole model."""
        if not isinstance(value, list):
            return Quantity(self.description, self.unit, at_least=0.0).check(value)
        rows = []
        for i, row in enumerate(value):
            if not isinstance(row, list) or len(row) != len(value):
                raise wrong(
                    f"row {i + 1} of {len(value)}, {show(row)}, does not make a square matrix",
                    f"give {self.wanted()}",
                )
            rows.append(tuple(self._entry(item, i, k) for k, item in enumerate(row)))
        if not rows:
            raise wrong("the matrix is empty", f"give {self.wanted()}")
        return tuple(rows)

    def _entry(self, value: object, i: int, k: int) -> float:
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        try:
            entry = float(value) if number else math.nan  # type: ignore[arg-type]
        except OverflowError:
            entry = math.inf
        if not math.isfinite(entry):
            kind = "a finite number" if number else "a number"
            raise wrong(f"entry [{i + 1},{k + 1}], {show(value)}, is not {kind}", f"give {self.wanted()}")
        return entry

    def wanted(self) -> str:
        """Both forms."""
        return f"the {self.description} as one number in {self.unit} (along uy) or as a matrix on dofs"

    def explanation(self) -> str:
        """Both forms with their units."""
        rotation = f"{self.unit.replace('N', 'N m').replace('/m', '/rad')}"
        return (
            f"{super().explanation()}: one number along uy in {self.unit}, or a symmetric positive "
            f"semidefinite matrix on dofs (rotations in {rotation})"
        )

    def schema(self) -> dict[str, Any]:
        """A number or an array of rows."""
        row = {"type": "array", "items": {"type": "number"}, "minItems": 1, "maxItems": len(DOFS)}
        matrix = {"type": "array", "items": row, "minItems": 1, "maxItems": len(DOFS)}
        return {"oneOf": [{"type": "number", "minimum": 0.0}, matrix], "x-unit": self.unit}


@dataclass(frozen=True)
class Elements(Leaf):
    """Elements of every span, or of each span between consecutive stations."""

    def check(self, value: object) -> int | tuple[int, ...]:
        """The number or numbers."""
        numbers = value if isinstance(value, list) else [value]
        for number in numbers or [value]:
            if isinstance(number, bool) or not isinstance(number, int):
                raise wrong(f"{show(value)} is not a whole number or a list of them", f"give {self.wanted()}")
            if not 1 <= number <= _MOST_ELEMENTS:
                raise wrong(f"{show(value)} is out of range", f"give {self.wanted()}")
        return tuple(value) if isinstance(value, list) else value  # type: ignore[return-value]

    def wanted(self) -> str:
        """Both forms."""
        return f"the {self.description}, one whole number for all or a list, each from 1 to {_MOST_ELEMENTS}"

    def schema(self) -> dict[str, Any]:
        """An integer or an array of integers."""
        number = {"type": "integer", "minimum": 1, "maximum": _MOST_ELEMENTS}
        return {"oneOf": [number, {"type": "array", "items": number, "minItems": 1}]}


@dataclass(frozen=True)
class Ends(Leaf):
    """A quantity along a section: one number, or its values at both ends."""

    entry: Quantity

    def check(self, value: object) -> float | tuple[float, float]:
        """The number, or both."""
        if not isinstance(value, list):
            return self.entry.check(value)
        if len(value) != 2:
            raise wrong(f"{show(value)} is not a list of 2 numbers", f"give {self.wanted()}")
        return (self.entry.check(value[0]), self.entry.check(value[1]))

    def wanted(self) -> str:
        """Both forms."""
        return f"the {self.description} in {self.entry.unit}, one number or [first end, far end]"

    def explanation(self) -> str:
        """Both forms with their unit."""
        return f"{super().explanation()}, one number or those at both ends, in {self.entry.unit}"

    def schema(self) -> dict[str, Any]:
        """A number or two."""
        number = self.entry.schema()
        return {"oneOf": [number, {"type": "array", "items": number, "minItems": 2, "maxItems": 2}]}


@dataclass(frozen=True)
class Dofs(Leaf):
    """Distinct degrees of freedom; matrices of joints follow their order."""

    def check(self, value: object) -> tuple[str, ...]:
        """The names in the order of the file."""
        if not isinstance(value, list) or not value:
            raise wrong(f"{show(value)} is not a list of degrees of freedom", f"give {self.wanted()}")
        for k, dof in enumerate(value):
            if not isinstance(dof, str) or dof not in DOFS:
                raise wrong(f"{show(dof)} is not a degree of freedom", hint(dof, DOFS))
            if dof in value[:k]:
                raise wrong(f"{show(dof)} is given twice", "name each degree of freedom once")
        return tuple(value)

    def wanted(self) -> str:
        """What to choose from."""
        return f"the {self.description}, of {', '.join(DOFS)}"

    def schema(self) -> dict[str, Any]:
        """An array of distinct names."""
        return {
            "type": "array",
            "items": {"type": "string", "enum": list(DOFS)},
            "minItems": 1,
            "uniqueItems": True,
        }


@dataclass(frozen=True)
class Spot(Leaf):
    """A point of a component: "shaft@z" or "shaft.disk" on a gear train, [x, y, z] on a rigid body."""

    place: Leaf

    def check(self, value: object) -> str | tuple[float, float, float]:
        """The text or the place."""
        if isinstance(value, str):
            return Text(self.description).check(value)
        if isinstance(value, list):
            return self.place.check(value)  # type: ignore[return-value]
        raise wrong(f"{show(value)} is not a point", f"give {self.wanted()}")

    def wanted(self) -> str:
        """Both forms."""
        return f'the {self.description}, "shaft@z" or "shaft.disk" on a gear train, [x, y, z] on a rigid body'

    def explanation(self) -> str:
        """Both forms."""
        return f"P{self.wanted()[5:]} (m; left out: its centre of gravity)"

    def schema(self) -> dict[str, Any]:
        """A string or three numbers."""
        return {"oneOf": [{"type": "string", "minLength": 1}, self.place.schema()]}
