"""A value of a model file: each kind knows its check, its unit and its JSON schema.

A leaf is the metadata of an annotated field, `mass: Annotated[float, Quantity("mass", "kg", above=0.0)]`.
Its `check` either returns the checked value or raises what `wrong` makes.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import PydanticCustomError, core_schema

from .wording import show

WRONG = "gearpath"  # the pydantic error type of everything that this package refuses itself


def wrong(problem: str, remedy: str, *key: str) -> PydanticCustomError:
    """The refusal of a value, or of the entry `key` of a table."""
    context = {"problem": problem, "remedy": remedy, "key": list(key)}
    return PydanticCustomError(WRONG, "{problem}; {remedy}", context)


@dataclass(frozen=True)
class Leaf:
    """A value of the file; `description` is a noun phrase without article."""

    description: str

    def check(self, value: object) -> object:
        """The checked value; raises `wrong`."""
        raise NotImplementedError

    def schema(self) -> dict[str, Any]:
        """JSON schema without the description."""
        raise NotImplementedError

    def wanted(self) -> str:
        """What to give, for remedies: "the mass in kg, above 0"."""
        return f"the {self.description}"

    def explanation(self) -> str:
        """Description for editors."""
        return self.description[0].upper() + self.description[1:]

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(self.check)

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return {**self.schema(), "description": self.explanation()}


def is_table(value: object) -> object:
    """Refuse what is not a table of named entries."""
    if not isinstance(value, Mapping):
        raise wrong(f"{show(value)} is not a table", "write it as a TOML table of key = value")
    return value


def is_list(value: object) -> object:
    """Refuse what is not a list of tables."""
    if not isinstance(value, list):
        raise wrong(f"{show(value)} is not a list", "write it as a list of tables, [{ ... }, { ... }]")
    return value
