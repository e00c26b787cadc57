"""A bearing by itself, at a load, a displacement or its preload."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ..errors import InputError
from ..joints.bearings import Equilibrium, RollingBearing, back_to_back, face_to_face, tandem
from ..joints.bearings.checks import DOFS, finite
from ..joints.bearings.equilibrium import settle, state_at
from ..joints.bearings.rolling import Contacts
from ..joints.mounting import preloaded
from .bearings import SAMPLES, Case, Phases, curve_over, measure, scaled

ARRANGEMENTS = {"back_to_back": back_to_back, "face_to_face": face_to_face, "tandem": tandem}
_SIZE = 1e-12  # m, rad: below, a displacement counts as none


@dataclass(frozen=True)
class Duty:
    """What a bearing has to do: load (N, N m) or displacement (m, rad), preload in N, speed in rev/min."""

    load: Mapping[str, float]
    displacement: Mapping[str, float]
    preload: float = 0.0
    speed: float | None = None

    def __post_init__(self) -> None:
        if self.load and self.displacement:
            raise InputError("bearing: load and displacement are both given, and each decides the other; leave one out")
        for what, values in (("load", self.load), ("displacement", self.displacement)):
            for name, value in values.items():
                _refuse_name(what, name)
                finite(**{f"{what} {name}": value})
        finite(preload=self.preload)
        if self.preload < 0.0:
            raise InputError(f"preload: {self.preload:g} N is negative; it presses the bearing together, give its size")
        if self.speed is not None:
            finite(speed=self.speed)

    @property
    def over(self) -> str:
        """What decides the state."""
        return "load" if self.load else "displacement" if self.displacement else "preload"


def arranged(
    bearing: RollingBearing, mirrored: bool = False, arrangement: str = "", distance: float | None = None
) -> RollingBearing:
    """The bearing turned round and in a pair; raises InputError for an unknown arrangement or one without distance."""
    if mirrored:
        bearing = bearing.mirrored()
    if not arrangement:
        if distance is not None:
            raise InputError("distance: belongs to a pair; give arrangement too (" + ", ".join(ARRANGEMENTS) + ")")
        return bearing
    if arrangement not in ARRANGEMENTS:
        raise InputError(f"arrangement: {arrangement!r} is none of {', '.join(ARRANGEMENTS)}")
    if distance is None:
        raise InputError("arrangement: a pair needs the distance of its rows; give distance (m)")
    return ARRANGEMENTS[arrangement](bearing, distance)


def study(name: str, bearing: RollingBearing, duty: Duty, *, phases: bool = False, source: str = "") -> Case:
    """State, stiffness curve and, on demand, the spread over the cage's positions; raises InputError.

    A load that cannot be carried is refused, and so is a bearing that nothing loads. What is not named in a load is
    held at no displacement.
    """

    def at(factor: float, part: float = 0.0) -> Equilibrium:
        cage = bearing._shifted(part) if part else bearing
        if duty.over == "preload":
            return state_at(preloaded(cage, factor * duty.preload), np.zeros(6))
        loaded = preloaded(cage, duty.preload)
        if duty.load:
            return settle(loaded, scaled(duty.load, factor))
        return state_at(loaded, np.array([factor * duty.displacement.get(dof, 0.0) for dof in DOFS]))

    state = at(1.0)
    if not state.loaded:
        raise InputError(
            f"{name}: no rolling element carries load; give a load, a displacement or a preload that presses the rings "
            "together"
        )
    whole = preloaded(bearing, duty.preload)
    notes = tuple(whole.limits(Contacts(state.element_loads, state.contact_angles), duty.speed))
    given = {"load": duty.load, "displacement": duty.displacement, "preload": {"uz": duty.preload}}[duty.over]
    size, unit = (duty.preload, "N") if duty.over == "preload" else measure(duty.over, given)
    grows = any(abs(value) > _SIZE for value in given.values())
    return Case(
        name,
        whole,
        duty.over,
        given,
        replace(state, notes=notes),
        source,
        curve_over(duty.over, size, unit, at) if grows else None,
        Phases(np.array([at(1.0, k / SAMPLES).stiffness for k in range(SAMPLES)])) if phases else None,
        0.0 if duty.over == "preload" else duty.preload,
    )


def _refuse_name(what: str, name: str) -> None:
    if name == "rz":
        raise InputError(f"{what}: a bearing turns freely about its axis; leave rz out")
    if name not in DOFS:
        raise InputError(f"{what}: there is no degree of freedom {name!r}; use {', '.join(DOFS[:5])}")
