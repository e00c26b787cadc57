"""A table of a model file: frozen, and strict about its keys."""

from typing import Any

from pydantic import BaseModel, ConfigDict, model_validator
from pydantic.fields import FieldInfo

from .hints import hint
from .leaf import Leaf, is_table, wrong
from .wording import dotted


class Table(BaseModel):
    """Base of all tables: refuses unknown and missing keys by name."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    @model_validator(mode="before")
    @classmethod
    def _known_keys(cls, data: Any) -> Any:
        is_table(data)
        known = cls.model_fields
        for key in data:
            if key not in known:
                given = [name for name in known if name not in data]
                close = hint(key, given)
                remedy = close if close.startswith("did you mean") else hint("", known)
                raise wrong("unknown key", remedy, dotted([key]))
        for key, field in known.items():
            if field.is_required() and key not in data:
                raise wrong("is missing", _remedy(key, field), key)
        return data


def leaf_of(field: FieldInfo) -> Leaf | None:
    """The leaf that checks a field, None where the field is a table or a list of tables."""
    return next((item for item in field.metadata if isinstance(item, Leaf)), None)


def _remedy(key: str, field: FieldInfo) -> str:
    """What to do about a missing key; whatever is required and no leaf is a table."""
    leaf = leaf_of(field)
    return f"give {leaf.wanted()}" if leaf else f"add the table '{key}'"
