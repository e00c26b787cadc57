"""What a model description says, read without trust: what is missing or no number is None, never an exception."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import prod
from typing import Any

from .archive import Archive

FLOATS = frozenset({"Real", "Float32", "Float64"})
FILE = "modelDescription.xml"


@dataclass(frozen=True)
class Dimension:
    """Size of one dimension of an array: a number, or the variable that holds it."""

    start: int | None
    reference: int | None


@dataclass(frozen=True)
class Variable:
    """One variable, with the defaults of the standard filled in."""

    index: int  # from 1, as FMI 2 counts
    name: str
    type: str  # "Real", "Float64", ...
    reference: int | None
    causality: str
    variability: str
    initial: str | None  # given, or the default of its causality and variability
    initial_given: bool
    attributes: Mapping[str, str]  # own and those of its declared type
    own: Mapping[str, str]  # own only
    start: tuple[str, ...] | None
    dimensions: tuple[Dimension, ...]
    aliases: tuple[tuple[str, str | None], ...]  # (name, displayUnit)
    clocks: tuple[int, ...] | None
    line: int

    @property
    def place(self) -> str:
        """Where it stands, for messages."""
        return f'{FILE}, variable "{self.name}" (line {self.line})'

    @property
    def unit(self) -> str | None:
        return self.attributes.get("unit")

    @property
    def derivative(self) -> int | None:
        """What it is the derivative of: an index in FMI 2, a value reference in FMI 3."""
        return whole(self.own.get("derivative"))

    def flagged(self, attribute: str) -> bool:
        """Whether an attribute is given at all."""
        return attribute in self.own

    def number(self, attribute: str) -> float | None:
        """A numeric attribute."""
        return real(self.attributes.get(attribute))


@dataclass(frozen=True)
class Unknown:
    """One entry of the ModelStructure."""

    list: str  # "Output", "Derivative", "InitialUnknown", "EventIndicator", "ClockedState"
    key: int | None  # index in FMI 2, value reference in FMI 3
    dependencies: tuple[int, ...] | None
    kinds: tuple[str, ...] | None
    line: int

    @property
    def place(self) -> str:
        return f"{FILE}, {self.list} {self.key} (line {self.line})"


@dataclass(frozen=True)
class Fmu:
    """An FMU as the checks see it."""

    archive: Archive
    version: int  # 2 or 3
    root: Any  # of the model description
    variables: tuple[Variable, ...]
    unknowns: tuple[Unknown, ...]
    documents: Mapping[str, Any] = field(default_factory=dict)  # the other XML files

    @cached_property
    def by_name(self) -> dict[str, Variable]:
        """Variables by name, aliases included."""
        names = {alias: v for v in self.variables for alias, _ in v.aliases}
        return names | {v.name: v for v in self.variables}

    @cached_property
    def by_key(self) -> dict[int, Variable]:
        """Variables as the ModelStructure and `derivative` point to them."""
        if self.version == 2:
            return {v.index: v for v in self.variables}
        return {v.reference: v for v in reversed(self.variables) if v.reference is not None}

    def key(self, variable: Variable) -> int | None:
        """What the ModelStructure calls it."""
        return variable.index if self.version == 2 else variable.reference

    def listed(self, kind: str) -> list[Unknown]:
        """Entries of one list of the ModelStructure, in order."""
        return [u for u in self.unknowns if u.list == kind]

    @cached_property
    def states(self) -> list[Variable | None]:
        """The continuous states, in the order of their derivatives; None where an entry leads nowhere."""
        derivatives = [self.by_key.get(u.key) if u.key is not None else None for u in self.listed("Derivative")]
        keys = [d.derivative if d else None for d in derivatives]
        return [self.by_key.get(key) if key is not None else None for key in keys]

    @property
    def interfaces(self) -> dict[str, Any]:
        """Elements of the interface types that the FMU offers."""
        kinds = ("ModelExchange", "CoSimulation", "ScheduledExecution")
        return {kind: element for kind in kinds if (element := self.root.find(kind)) is not None}

    @property
    def identifiers(self) -> list[str]:
        """Model identifiers without repetition."""
        return list(dict.fromkeys(e.get("modelIdentifier", "") for e in self.interfaces.values()))

    @property
    def token(self) -> str:
        """The guid of FMI 2, the instantiationToken of FMI 3."""
        return str(self.root.get("guid" if self.version == 2 else "instantiationToken", ""))

    def shape(self, variable: Variable) -> tuple[int, ...] | None:
        """Sizes of the dimensions, none for a scalar; None where one leads nowhere."""
        sizes: list[int] = []
        for dimension in variable.dimensions:
            size = dimension.start
            if dimension.reference is not None:
                holder = self.by_key.get(dimension.reference)
                size = whole(holder.start[0]) if holder and holder.start else None
            if size is None:
                return None
            sizes.append(size)
        return tuple(sizes)

    def size(self, variable: Variable) -> int | None:
        """Number of elements, the product of the dimensions; None where one leads nowhere."""
        shape = self.shape(variable)
        return None if shape is None else prod(shape)


def real(text: str | None) -> float | None:
    """A number as XML writes it."""
    if text is None:
        return None
    try:
        return float(text.strip())
    except ValueError:
        return None


def whole(text: str | None) -> int | None:
    """A whole number as XML writes it."""
    if text is None:
        return None
    try:
        return int(text.strip())
    except ValueError:
        return None


def true(text: str | None) -> bool:
    """A boolean as XML writes it."""
    return text is not None and text.strip() in ("true", "1")
