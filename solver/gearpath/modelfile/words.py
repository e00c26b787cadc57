"""Texts of a model file: titles, names, choices and pairs of references."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from .hints import hint
from .leaf import Leaf, wrong
from .wording import NAME, show


@dataclass(frozen=True)
class Text(Leaf):
    """A line of text that says something."""

    example: str = ""

    def check(self, value: object) -> str:
        """The text."""
        if not isinstance(value, str):
            raise wrong(f"{show(value)} is not text", f"give {self.wanted()}")
        if not value.strip() or not value.isprintable():
            raise wrong(f"{show(value)} is not a line of text", f"give {self.wanted()}")
        return value

    def wanted(self) -> str:
        """The text with an example."""
        example = f', such as "{self.example}"' if self.example else ""
        return f"the {self.description} in quotes{example}"

    def schema(self) -> dict[str, Any]:
        """A string that is not empty."""
        return {"type": "string", "minLength": 1, **({"examples": [self.example]} if self.example else {})}


@dataclass(frozen=True)
class Name(Leaf):
    """A name that is valid in every simulation tool."""

    def check(self, value: object) -> str:
        """The name."""
        if not isinstance(value, str) or not re.fullmatch(NAME, value):
            raise wrong(f"{show(value)} is not a valid name", "begin with a letter and use letters, digits and _ only")
        return value

    def schema(self) -> dict[str, Any]:
        """A string of the pattern of names."""
        return {"type": "string", "pattern": NAME}


@dataclass(frozen=True)
class Choice(Leaf):
    """One of a few words."""

    words: Sequence[str]

    def check(self, value: object) -> str:
        """The word."""
        if not isinstance(value, str) or value not in self.words:
            raise wrong(f"{show(value)} is not a {self.description}", hint(value, self.words))
        return value

    def wanted(self) -> str:
        """All the words."""
        return f"the {self.description}, {' or '.join(show(word) for word in self.words)}"

    def schema(self) -> dict[str, Any]:
        """An enumeration."""
        return {"type": "string", "enum": list(self.words)}


@dataclass(frozen=True)
class Flag(Leaf):
    """True or false."""

    def check(self, value: object) -> bool:
        """The truth value."""
        if not isinstance(value, bool):
            raise wrong(f"{show(value)} is neither true nor false", "write true or false, without quotes")
        return value

    def schema(self) -> dict[str, Any]:
        """A truth value."""
        return {"type": "boolean"}


@dataclass(frozen=True)
class Pair(Leaf):
    """Two references in the order source, receiver."""

    example: tuple[str, str]

    def check(self, value: object) -> tuple[str, str]:
        """Both references, not yet resolved."""
        if not isinstance(value, list) or len(value) != 2 or not all(isinstance(v, str) for v in value):
            raise wrong(f"{show(value)} is not a list of two references", f"give {self.wanted()}")
        return (value[0], value[1])

    def wanted(self) -> str:
        """The pair with an example."""
        return f"the {self.description}, such as {show(list(self.example))}"

    def schema(self) -> dict[str, Any]:
        """An array of two strings."""
        return {
            "type": "array",
            "items": {"type": "string"},
            "minItems": 2,
            "maxItems": 2,
            "examples": [list(self.example)],
        }
