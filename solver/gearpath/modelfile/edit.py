"""Changing a model by dotted paths."""

from collections.abc import Mapping
from typing import Any

from ..errors import ModelError
from .hints import hint
from .wording import dotted, plain, show

_OF_ROLLING_BEARINGS = ("load", "displacement", "preload", "mirrored", "arrangement", "distance")

# Setting one of these keys replaces the others, which say the same in another way.
EXCLUSIVE = {
    "damping": ("damping_time",),
    "damping_time": ("damping",),
    "stiffness": ("geometry", "catalogue", *_OF_ROLLING_BEARINGS),
    "geometry": ("stiffness", "catalogue"),
    "catalogue": ("stiffness", "geometry"),
    "load": ("displacement",),
    "displacement": ("load",),
    "sections": ("length", "diameter"),
    "length": ("sections",),
    "diameter": ("sections",),
    "mesh": ("point", "dof", "force", "at"),
    "point": ("mesh", "displacement"),
}


def edited(data: Mapping[str, Any], full: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """A copy of `data` with the changes made; `full` also holds the keys that were left to their defaults."""
    out = plain(data)
    assert isinstance(out, dict)
    paths = {path: _parts(path, full) for path in changes}
    chosen = {tuple(parts) for parts in paths.values()}
    for path, value in changes.items():
        *parents, last = paths[path]
        place: Any = out
        for part in parents:
            place = place[part] if isinstance(part, int) else place.setdefault(part, {})
        place[last] = plain(value)
        for other in EXCLUSIVE.get(str(last), ()):
            if isinstance(place, dict) and (*parents, other) not in chosen:
                place.pop(other, None)
    return out


def _parts(path: object, full: Mapping[str, Any]) -> list[str | int]:
    """The steps of a dotted path that exists in `full`; a list is entered by index or by the entry's name."""
    if not isinstance(path, str):
        raise ModelError(show(path), "this is not a path", 'write it as text, "joints.bearing_1.stiffness"')
    steps = path.split(".")
    place: Any = full
    parts: list[str | int] = []
    for k, step in enumerate(steps):
        known = _entries(place)
        if step not in known:
            where = f"in {dotted(steps[:k])}" if k else "in the model"
            problem = f"there is no {show(step)} {where}"
            end = f"set all of {dotted(steps[:k])}, which is left out" if place is None else "end the path before it"
            raise ModelError(dotted(steps), problem, hint(step, known) if known else end)
        parts.append(known[step])
        place = place[known[step]]
    return parts


def _entries(place: object) -> dict[str, str | int]:
    """What a path may go on with, and the key or index that it means."""
    if isinstance(place, dict):
        return {key: key for key in place}
    if not isinstance(place, list):
        return {}
    names: dict[str, str | int] = {str(k): k for k in range(len(place))}
    return {item["name"]: k for k, item in enumerate(place) if isinstance(item, dict) and "name" in item} | names
