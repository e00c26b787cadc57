"""Choosing loads and outputs by name, with a hint for a misspelt one."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from typing import Protocol, TypeVar

from ..errors import InputError


class Named(Protocol):
    """Anything with a name."""

    @property
    def name(self) -> str:
        """The FMU variable's name."""


T = TypeVar("T", bound=Named)


def chosen(
    kind: str, names: str | Iterable[str] | None, known: tuple[T, ...], nonlinear: Iterable[str] = ()
) -> tuple[T, ...]:
    """The items of those names, in that order; all of them for None. Raises InputError for an unknown name."""
    if names is None:
        return known
    by_name = {item.name: item for item in known}
    found = []
    for name in [names] if isinstance(names, str) else names:
        if name not in by_name:
            raise InputError(_unknown(kind, str(name), list(by_name), set(nonlinear)))
        found.append(by_name[name])
    return tuple(found)


def _unknown(kind: str, name: str, known: list[str], nonlinear: set[str]) -> str:
    if name in nonlinear:
        return f"{kind}s: {name!r} is a power and not linear in the inputs; use gearpath.power_flow for powers"
    close = difflib.get_close_matches(name, known, n=1)
    remedy = f"did you mean {close[0]!r}?" if close else f"known {kind}s: {', '.join(known)}"
    return f"{kind}s: there is no {kind} {name!r}; {remedy}"
