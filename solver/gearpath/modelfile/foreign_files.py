"""What components of files have in common: their units, and refusals that name the key."""

from collections.abc import Callable
from typing import TypeVar

from ..errors import InputError, ModelError

T = TypeVar("T")
LENGTH = {"SI": 1.0, "mm-t-s": 1e-3}  # m
ENERGY = {"SI": 1.0, "mm-t-s": 1e-3}  # J: N mm, and t mm^2 / s^2


def guarded(key: str, work: Callable[[], T]) -> T:
    """The result of `work`, whose refusals name the key."""
    try:
        return work()
    except InputError as error:
        if isinstance(error, ModelError):
            raise
        problem, _, remedy = str(error).partition("; ")
        raise ModelError(key, problem, remedy) from None


def found_in(found: dict[str, T], dof: str, key: str) -> T:
    """What a node has for a degree of freedom."""
    if dof not in found:
        raise ModelError(key, f"the node has no {dof} in the file", f"name what it has: {', '.join(found)}")
    return found[dof]
