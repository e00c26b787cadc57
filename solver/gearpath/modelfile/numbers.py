"""Numbers of a model file: quantities in SI units, counts, places."""

import math
import operator
from dataclasses import dataclass, replace
from typing import Any

from .leaf import Leaf, wrong
from .wording import show


@dataclass(frozen=True)
class Quantity(Leaf):
    """A finite number in its SI unit ("" where it has none); outside `plausible` a unit slip is certain."""

    unit: str = ""
    above: float | None = None
    at_least: float | None = None
    below: float | None = None
    at_most: float | None = None
    plausible: tuple[float, float] = (-math.inf, math.inf)
    slip: str = ""  # the remedy outside `plausible`

    def check(self, value: object) -> float:
        """The number as a float."""
        number = self._number(value)
        text = f"{show(value)} {self.unit}".rstrip()
        for limit, broken, words in (
            (self.above, operator.le, "is not above"),
            (self.at_least, operator.lt, "is below"),
            (self.below, operator.ge, "is not below"),
            (self.at_most, operator.gt, "is above"),
        ):
            if limit is not None and broken(number, limit):
                raise wrong(f"{text} {words} {limit:g}", f"give {self.wanted()}")
        if not self.plausible[0] <= number <= self.plausible[1]:
            raise wrong(f"{text} cannot be right", self.slip)
        return number

    def _number(self, value: object) -> float:
        if isinstance(value, str):
            raise wrong(f"{show(value)} is text, not a number", f"give {self.wanted()}, without quotes or unit")
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise wrong(f"{show(value)} is not a number", f"give {self.wanted()}")
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if not math.isfinite(number):
            raise wrong(f"{show(value)} is not a finite number", f"give {self.wanted()}")
        return number

    def wanted(self) -> str:
        """The quantity, its unit and its limits."""
        unit = f" in {self.unit}" if self.unit else " as a plain number"
        limits = [
            f"{words} {limit:g}"
            for limit, words in (
                (self.above, "above"),
                (self.at_least, "at least"),
                (self.below, "below"),
                (self.at_most, "at most"),
            )
            if limit is not None
        ]
        return f"the {self.description}{unit}" + (", " + " and ".join(limits) if limits else "")

    def explanation(self) -> str:
        """Description and unit."""
        return super().explanation() + (f", in {self.unit}" if self.unit else "")

    def schema(self) -> dict[str, Any]:
        """A number with its limits; `x-unit` holds the unit."""
        limits = {
            "exclusiveMinimum": self.above,
            "minimum": self.plausible[0] if self.at_least is None else self.at_least,
            "exclusiveMaximum": self.below,
            "maximum": self.plausible[1] if self.at_most is None else self.at_most,
        }
        unit = {"x-unit": self.unit} if self.unit else {}
        return {
            "type": "number",
            **{k: v for k, v in limits.items() if v is not None and math.isfinite(v)},
            **unit,
        }


@dataclass(frozen=True)
class Count(Leaf):
    """A whole number within limits."""

    at_least: int = 1
    at_most: int = 1_000_000

    def check(self, value: object) -> int:
        """The integer."""
        if isinstance(value, bool) or not isinstance(value, int):
            raise wrong(f"{show(value)} is not a whole number", f"give {self.wanted()}")
        if not self.at_least <= value <= self.at_most:
            raise wrong(f"{show(value)} is out of range", f"give {self.wanted()}")
        return value

    def wanted(self) -> str:
        """The count and its limits."""
        return f"the {self.description}, a whole number from {self.at_least} to {self.at_most}"

    def schema(self) -> dict[str, Any]:
        """An integer with its limits."""
        return {"type": "integer", "minimum": self.at_least, "maximum": self.at_most}


@dataclass(frozen=True)
class Row(Leaf):
    """A fixed number of entries of one kind, such as a place [x, y, z]."""

    entry: Quantity
    length: int

    def named(self, description: str) -> "Row":
        """The same list under another description."""
        return replace(self, description=description)

    def check(self, value: object) -> tuple[float, ...]:
        """The entries as a tuple."""
        if not isinstance(value, list) or len(value) != self.length:
            raise wrong(f"{show(value)} is not a list of {self.length} numbers", f"give {self.wanted()}")
        return tuple(self.entry.check(item) for item in value)

    def wanted(self) -> str:
        """The list and the unit of its entries."""
        unit = f" in {self.entry.unit}" if self.entry.unit else ""
        return f"the {self.description} as a list of {self.length} numbers{unit}"

    def explanation(self) -> str:
        """Description and unit."""
        return super().explanation() + (f", in {self.entry.unit}" if self.entry.unit else "")

    def schema(self) -> dict[str, Any]:
        """An array of numbers."""
        return {
            "type": "array",
            "items": self.entry.schema(),
            "minItems": self.length,
            "maxItems": self.length,
        }
