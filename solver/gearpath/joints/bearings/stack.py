"""Several rows of rolling elements that move together: pairs back to back, face to face, in tandem, and preload."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...errors import InputError
from ...numerics.arrays import Real
from .checks import count as whole
from .checks import finite, numbers, positive
from .rolling import Contacts, RollingBearing


@dataclass(frozen=True)
class BearingStack(RollingBearing):
    """Bearings at positions z (m) along one shaft in one housing, whose inner rings move together.

    The stack's displacement is that of its origin z = 0; a row at z moves by ux + z ry and uy - z rx there. `offsets`
    (m) are how far each inner ring is pushed along z beforehand: preload. The rows' own `rz` stays free.
    """

    bearings: tuple[RollingBearing, ...]
    positions: tuple[float, ...]
    offsets: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "bearings", tuple(self.bearings))
        if not self.bearings or not all(isinstance(bearing, RollingBearing) for bearing in self.bearings):
            raise InputError("bearings: a stack needs a list of at least one ball or roller bearing")
        object.__setattr__(self, "positions", numbers("positions", self.positions))
        object.__setattr__(self, "offsets", numbers("offsets", self.offsets) or (0.0,) * len(self.bearings))
        for name in ("positions", "offsets"):
            if len(getattr(self, name)) != len(self.bearings):
                raise InputError(f"{name}: give one number (m) for each of the {len(self.bearings)} bearings")

    @property
    def elements(self) -> int:
        """Rolling elements in all."""
        return sum(bearing.elements for bearing in self.bearings)

    @property
    def contact_count(self) -> int:
        """Contacts in all."""
        return sum(bearing.contact_count for bearing in self.bearings)

    @property
    def lever(self) -> float:
        """The largest radius or distance, m."""
        return max(max(bearing.lever for bearing in self.bearings), max(abs(z) for z in self.positions))

    @property
    def scale(self) -> tuple[float, float]:
        """Kn and n of the first bearing."""
        return self.bearings[0].scale

    @cached_property
    def _moves(self) -> tuple[Real, ...]:
        """T (5, 5) of each row: its displacement is T q."""
        moves = []
        for z in self.positions:
            move = np.eye(5)
            move[0, 4], move[1, 3] = z, -z
            moves.append(move)
        return tuple(moves)

    def _local(self, q: Real) -> list[Real]:
        local = [q @ move.T for move in self._moves]
        for displacement, offset in zip(local, self.offsets):
            displacement[:, 2] += offset
        return local

    def _potential(self, q: Real) -> tuple[Real, Real]:
        rows = [b._potential(x) for b, x in zip(self.bearings, self._local(q))]
        loads = (load @ T for (_, load), T in zip(rows, self._moves))
        return np.asarray(sum(energy for energy, _ in rows)), np.asarray(sum(loads))

    def _stiffness(self, q: Real) -> Real:
        return np.asarray(sum(T.T @ b._stiffness(x) @ T for b, x, T in zip(self.bearings, self._local(q), self._moves)))

    def _contacts(self, q: Real) -> Contacts:
        found = [b._contacts(x) for b, x in zip(self.bearings, self._local(q))]
        return Contacts(*(np.concatenate([getattr(c, name) for c in found], axis=1) for name in ("load", "angle")))

    def limits(self, found: Contacts, speed: float | None) -> Sequence[str]:
        """Those of each row, and rows that carry nothing."""
        notes, begin = [], 0
        for bearing, place in zip(self.bearings, self.positions):
            part = slice(begin, begin + bearing.elements)
            begin = part.stop
            row = f"row at z = {place:g} m: "
            if found.load[part].any():
                notes += [row + note for note in bearing.limits(Contacts(found.load[part], found.angle[part]), speed)]
            else:
                notes.append(row + "carries no load and has no stiffness; more preload keeps it in contact")
        return notes

    def mirrored(self) -> BearingStack:
        """The stack turned end for end."""
        turned = tuple(bearing.mirrored() for bearing in reversed(self.bearings))
        places = tuple(-z for z in reversed(self.positions))
        return BearingStack(turned, places, tuple(-offset for offset in reversed(self.offsets)))

    def turned(self, phase: float) -> BearingStack:
        """All cages turned on by `phase`, rad."""
        return BearingStack(tuple(b.turned(phase) for b in self.bearings), self.positions, self.offsets)

    def _shifted(self, part: float) -> BearingStack:
        """Every row by the same part of its own distance of two elements."""
        return BearingStack(tuple(b._shifted(part) for b in self.bearings), self.positions, self.offsets)


def back_to_back(bearing: RollingBearing, distance: float, preload: float = 0.0) -> BearingStack:
    """Two of a kind whose lines of contact spread apart (O): the left one with a > 0, the right one with a < 0.

    `preload` (m) is how far the inner rings are pressed towards each other, half of it by each.
    """
    return _pair(bearing, distance, preload, 1.0)


def face_to_face(bearing: RollingBearing, distance: float, preload: float = 0.0) -> BearingStack:
    """Two of a kind whose lines of contact meet between them (X); `preload` as in back_to_back, by the outer rings."""
    return _pair(bearing, distance, preload, -1.0)


def tandem(bearing: RollingBearing, distance: float, count: int = 2) -> BearingStack:
    """`count` of a kind in one direction, `distance` apart, about their middle."""
    whole(1, count=count)
    positive(distance=distance)
    places = tuple((i - 0.5 * (count - 1)) * distance for i in range(count))
    return BearingStack((bearing,) * count, places)


def _pair(bearing: RollingBearing, distance: float, preload: float, side: float) -> BearingStack:
    angle = getattr(bearing, "contact_angle", 0.0)
    if angle == 0.0:
        raise InputError("bearing: a pair needs two of a kind with a contact angle; give contact_angle in rad")
    positive(distance=distance)
    finite(preload=preload)
    left, right = (bearing, bearing.mirrored()) if angle * side > 0 else (bearing.mirrored(), bearing)
    return BearingStack((left, right), (-0.5 * distance, 0.5 * distance), (0.5 * side * preload, -0.5 * side * preload))
