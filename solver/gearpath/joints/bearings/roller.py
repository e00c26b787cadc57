"""Cylindrical and tapered roller bearings, sliced along the rollers so that misalignment is carried."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from ...errors import InputError
from ...numerics.arrays import Real
from .checks import count, finite, numbers, positive
from .contact import LINE, line_constant
from .limits import DENSITY, centrifugal_note
from .rolling import Contacts, RollingBearing

_ROUNDING = 1e-14  # of the terms whose sum an approach is


@dataclass(frozen=True)
class RollerBearing(RollingBearing):
    """A roller bearing by its geometry (m, rad); the contact angle stays as it is under load.

    `contact_angle` 0 is a cylindrical bearing, otherwise a tapered one, positive if +uz loads it. `slices`: 1 is the
    lumped roller of Lim and Singh (no stiffness against tilt of a cylindrical one), 31 the form of ISO/TS 16281.
    `radial_clearance` is half the diametral clearance; negative is interference. `profile`: how far the roller's
    surface lies back, m, at the places of the slices (from -L/2 to L/2 along +z): a function of them or an array.
    `phase` (rad): where the first roller stands. `contact_stiffness`: Kn of a whole roller, N/m^(10/9); None for steel
    by ISO/TS 16281. Raises InputError for a geometry that cannot be.
    """

    rollers: int
    roller_length: float
    pitch_radius: float
    contact_angle: float
    slices: int = 31
    radial_clearance: float = 0.0
    profile: Callable[[Real], ArrayLike] | tuple[float, ...] | None = None
    phase: float = 0.0
    contact_stiffness: float | None = None

    def __post_init__(self) -> None:
        count(1, rollers=self.rollers, slices=self.slices)
        positive(roller_length=self.roller_length, pitch_radius=self.pitch_radius)
        finite(contact_angle=self.contact_angle, phase=self.phase, radial_clearance=self.radial_clearance)
        if self.contact_stiffness is not None:
            positive(contact_stiffness=self.contact_stiffness)
        if not abs(self.contact_angle) < 0.5 * np.pi:
            raise InputError(
                f"contact_angle: {self.contact_angle!r} rad must lie below a quarter turn; is it in degrees?"
            )
        if abs(self.radial_clearance) > 0.1 * self.pitch_radius:
            raise InputError(
                f"radial_clearance: {self.radial_clearance:g} m cannot belong to a pitch radius of "
                f"{self.pitch_radius:g} m; is it in micrometres?"
            )
        if self.profile is not None and not callable(self.profile):
            object.__setattr__(self, "profile", numbers("profile", self.profile))
        if self._drops.shape != (self.slices,) or not ((self._drops >= 0) & np.isfinite(self._drops)).all():
            raise InputError(f"profile: must give one distance of at least 0 m for each of the {self.slices} slices")

    def mirrored(self) -> RollerBearing:
        """The same bearing facing the other way: contact angle -a, and the profile from the other end."""
        profile = None if self.profile is None else tuple(self._drops[::-1].tolist())
        return replace(self, contact_angle=-self.contact_angle, profile=profile)

    @property
    def elements(self) -> int:
        """Number of rollers Z."""
        return self.rollers

    @property
    def contact_count(self) -> int:
        """One contact pair a slice."""
        return self.rollers * self.slices

    @property
    def lever(self) -> float:
        """The pitch radius, m."""
        return self.pitch_radius

    @cached_property
    def roller_stiffness(self) -> float:
        """Kn of a whole roller, N/m^(10/9)."""
        return line_constant(self.roller_length) if self.contact_stiffness is None else self.contact_stiffness

    @property
    def scale(self) -> tuple[float, float]:
        """Kn and n."""
        return self.roller_stiffness, LINE

    @cached_property
    def _places(self) -> Real:
        """Middles of the slices along the roller, m."""
        middles = (np.arange(self.slices) + 0.5) / self.slices - 0.5
        return np.asarray(self.roller_length * middles)

    @cached_property
    def _drops(self) -> Real:
        """The profile at the slices, m."""
        if self.profile is None:
            return np.zeros(self.slices)
        drops = self.profile(self._places) if callable(self.profile) else self.profile
        return np.asarray(drops, float)

    @cached_property
    def _rows(self) -> Real:
        """g (Z n_s, 5): what a displacement adds to the approach of each slice."""
        psi = self.phase + self._pitch * np.arange(self.rollers)
        cosine, sine = np.cos(self.contact_angle), np.sin(self.contact_angle)
        c, s = np.repeat(np.cos(psi), self.slices), np.repeat(np.sin(psi), self.slices)
        lever = np.tile(self._places - self.pitch_radius * sine, self.rollers)
        return np.array([c * cosine, s * cosine, np.full_like(c, sine), -lever * s, lever * c]).T

    @cached_property
    def _products(self) -> Real:
        """(Z n_s, 25): what a unit of each slice's stiffness adds to K."""
        return np.asarray((self._rows[:, :, None] * self._rows[:, None, :]).reshape(-1, 25))

    def _approach(self, q: Real) -> Real:
        back = self.radial_clearance * np.cos(self.contact_angle) + np.tile(self._drops, self.rollers)
        approach = q @ self._rows.T - back
        # d^(1/9) makes a hundredth of the full stiffness of the rounding error of a roller that just does not touch
        terms = np.abs(q) @ np.abs(self._rows).max(axis=0) + np.abs(back).max()
        return np.where(approach > _ROUNDING * terms[:, None], approach, 0.0)

    def _potential(self, q: Real) -> tuple[Real, Real]:
        approach = self._approach(q)
        loads = self.roller_stiffness / self.slices * approach**LINE
        return (loads * approach).sum(axis=1) / (LINE + 1.0), loads @ self._rows

    def _stiffness(self, q: Real) -> Real:
        """K = sum Q' g g^T."""
        approach = self._approach(q)
        slope = np.where(approach > 0, approach, 1.0) ** (LINE - 1.0) * (approach > 0)
        return np.asarray((LINE * self.roller_stiffness / self.slices * slope @ self._products).reshape(-1, 5, 5))

    def _contacts(self, q: Real) -> Contacts:
        loads = self.roller_stiffness / self.slices * self._approach(q) ** LINE
        load = loads.reshape(len(q), self.rollers, self.slices).sum(axis=2)
        return Contacts(load, np.full_like(load, self.contact_angle))

    def limits(self, found: Contacts, speed: float | None) -> Sequence[str]:
        """Centrifugal force of rollers that nearly touch each other: an upper bound, as no diameter is given."""
        if speed is None or self.rollers < 2:
            return ()
        diameter = 2.0 * self.pitch_radius * float(np.sin(np.pi / self.rollers))
        mass = DENSITY * np.pi / 4.0 * diameter**2 * self.roller_length
        gamma = 0.5 * diameter * np.cos(self.contact_angle) / self.pitch_radius
        return centrifugal_note(mass, self.pitch_radius, gamma, speed, float(found.load.max()), "at most ")
