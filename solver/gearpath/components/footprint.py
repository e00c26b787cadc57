"""Rigid patches of a plate, to which other components are attached."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from ..errors import InputError
from ..numerics.arrays import Real
from .rigid_body import Vector


@dataclass(frozen=True)
class Footprint:
    """A rigid rectangle of a plate, one place with six degrees of freedom at its `centre` (m, global axes).

    size: its widths along the plate's two axes, m. Both zero: a point, held by the plate's own node there; one zero:
    a rigid line.
    """

    centre: Vector
    size: tuple[float, float] = (0.0, 0.0)

    @property
    def is_point(self) -> bool:
        """Whether it is a single point."""
        return not any(self.size)


def check_footprints(footprints: Mapping[str, Footprint], centres: Mapping[str, Real], lengths: Real) -> None:
    """Refuse footprints that reach beyond the plate or touch each other; centres in the plate's axes, (2,), m.

    Raises InputError with the name of the footprint.
    """
    slack = 1e-9 * float(np.max(lengths))
    boxes = {}
    for name, footprint in footprints.items():
        if min(footprint.size) < 0.0:
            raise InputError(f"footprint {name!r}: size {footprint.size} m is negative; give two widths from 0 up")
        half = np.array(footprint.size) / 2.0
        if np.any(abs(centres[name]) + half > lengths / 2.0 + slack):
            raise InputError(
                f"footprint {name!r} at {footprint.centre} m of size {footprint.size} m reaches beyond the plate of "
                f"{lengths[0]:g} x {lengths[1]:g} m; move it or make it smaller"
            )
        if not footprint.is_point:
            boxes[name] = (centres[name] - half, centres[name] + half)
    for (one, (low, high)), (two, (low2, high2)) in combinations(boxes.items(), 2):
        if np.all(low <= high2 + slack) and np.all(low2 <= high + slack):
            raise InputError(f"the rigid footprints {one!r} and {two!r} overlap or touch; move one or make them one")
