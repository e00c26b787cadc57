"""A rolling bearing as a joint holds it: its geometry, and what decides the displacement at which it works."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..errors import InputError
from .bearings.checks import DOFS
from .bearings.equilibrium import Equilibrium, settle, state_at
from .bearings.rolling import RollingBearing
from .bearings.stack import BearingStack, back_to_back, face_to_face, tandem

PAIRS = {"back_to_back": back_to_back, "face_to_face": face_to_face, "tandem": tandem}


@dataclass(frozen=True)
class Mounting:
    """A rolling bearing between two ports; the first is its inner ring. SI units.

    `row` is the bearing, or one of two rows in an `arrangement` (a key of PAIRS), `distance` apart and pressed together
    by the force `preload`. At a `load` (N, N m) the named degrees of freedom are free and the others held, at a
    `displacement` (m, rad) the ones not named are zero; with neither, the bearing takes what the operation of the whole
    machine gives it. `damping_time` T (s) gives C = T K; None where the joint's damping does not follow its stiffness.
    """

    row: RollingBearing
    arrangement: str = ""
    distance: float = 0.0
    preload: float = 0.0
    load: Mapping[str, float] | None = None
    displacement: Mapping[str, float] | None = None
    damping_time: float | None = None

    def __hash__(self) -> int:
        return hash((self.row, *(self.load or {}).items(), *(self.displacement or {}).items(), self.damping_time))

    @cached_property
    def bearing(self) -> RollingBearing:
        """The bearing as it is assembled; raises InputError where the rows make no pair or carry no preload."""
        pair = PAIRS[self.arrangement](self.row, self.distance) if self.arrangement else self.row
        return preloaded(pair, self.preload)

    @property
    def follows_operation(self) -> bool:
        """Whether neither load nor displacement is given."""
        return self.load is None and self.displacement is None


def preloaded(bearing: RollingBearing, force: float) -> RollingBearing:
    """The bearing pressed together by an axial force (N) before anything else loads it.

    A single row is pushed to where it carries the force, in the sense of its contact angle (+z where that is 0); a pair
    has each row pushed so towards the other. Raises InputError where the bearing carries no axial force.
    """
    if force == 0.0:
        return bearing
    if not isinstance(bearing, BearingStack):
        return BearingStack((bearing,), (0.0,), (axial_approach(bearing, force),))
    return BearingStack(
        bearing.bearings, bearing.positions, tuple(axial_approach(row, force) for row in bearing.bearings)
    )


def axial_approach(row: RollingBearing, force: float) -> float:
    """How far (m, along z) a row is pushed by an axial force of this size in the sense of its contact angle."""
    sense = -1.0 if getattr(row, "contact_angle", 0.0) < 0.0 else 1.0
    try:
        return float(settle(row, {"uz": sense * force}).displacement[2])
    except InputError:
        raise InputError(
            "preload: the bearing carries no axial force; preload a cylindrical one by a negative radial_clearance"
        ) from None


def own_state(mounting: Mounting) -> Equilibrium | None:
    """The state that load or displacement decides; None where the operation of the machine does."""
    if mounting.load is not None:
        return settle(mounting.bearing, mounting.load)
    if mounting.displacement is not None:
        return state_at(mounting.bearing, np.array([mounting.displacement.get(dof, 0.0) for dof in DOFS]))
    return None
