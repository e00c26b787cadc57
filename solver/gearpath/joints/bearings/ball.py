"""Ball bearings: deep groove, angular contact and thrust, with the contact angle of every ball under load."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np

from ...errors import InputError
from ...numerics.arrays import Real
from .checks import count, finite, positive
from .contact import POINT, effective_modulus, groove_radii, in_series, point_contact, semi_major_axis
from .limits import DENSITY, centrifugal_note, ellipse_note, wrong_side_note
from .rolling import Contacts, RollingBearing

STEEL = (206e9, 0.3)  # Pa, -


class _Balls(NamedTuple):
    """Every ball at displacements (k, Z): stretched groove distance, its direction, elastic approach and load."""

    length: Real  # A
    radial: Real  # e = (dr*, dz*) / A
    axial: Real
    approach: Real  # d, 0 where the ball is free
    load: Real  # Q


@dataclass(frozen=True)
class BallBearing(RollingBearing):
    """A ball bearing by its geometry (m, rad, Pa), after Lim and Singh in tensor form.

    `inner_conformity` and `outer_conformity` are groove radius / ball diameter. `contact_angle` is the free one;
    positive means that +uz loads the bearing. `radial_clearance` is half the diametral clearance and belongs to
    bearings with the contact angle 0 only: a free contact angle says the same, cos(a) = 1 - r_L / A0; negative is
    interference. `phase` (rad) is where the first ball stands, from +x to +y. `reference`: the point whose displacement
    is meant, on the plane of the inner groove centres or of the ball centres. Raises InputError for a geometry that
    cannot be.
    """

    balls: int
    ball_diameter: float
    pitch_diameter: float
    inner_conformity: float
    outer_conformity: float
    contact_angle: float
    radial_clearance: float = 0.0
    youngs_modulus: float = STEEL[0]
    poisson_ratio: float = STEEL[1]
    phase: float = 0.0
    reference: Literal["groove_centres", "ball_centres"] = "groove_centres"

    def __post_init__(self) -> None:
        count(1, balls=self.balls)
        D, pitch = self.ball_diameter, self.pitch_diameter
        positive(ball_diameter=D, pitch_diameter=pitch, youngs_modulus=self.youngs_modulus)
        finite(contact_angle=self.contact_angle, phase=self.phase, poisson_ratio=self.poisson_ratio)
        finite(radial_clearance=self.radial_clearance)
        finite(inner_conformity=self.inner_conformity, outer_conformity=self.outer_conformity)
        for name, value in (("inner", self.inner_conformity), ("outer", self.outer_conformity)):
            if not 0.5 < value < 1.0:
                where = "is groove radius / ball diameter and lies between 0.5 and 1, usually near 0.52"
                raise InputError(f"{name}_conformity: {value!r} {where}")
        if not 0.0 <= self.poisson_ratio < 0.5:
            raise InputError(f"poisson_ratio: {self.poisson_ratio!r} must lie from 0 to below 0.5")
        if not abs(self.contact_angle) <= 0.5 * np.pi:
            raise InputError(
                f"contact_angle: {self.contact_angle!r} rad must lie within a quarter turn; is it in degrees?"
            )
        if pitch * (np.sin(np.pi / self.balls) if self.balls > 1 else 1.0) <= D:
            raise InputError(
                f"balls: {self.balls} of the diameter {D:g} m do not fit on the pitch diameter of {pitch:g} m; check "
                "the number and the units (m)"
            )
        self._check_clearance()
        if self.reference not in ("groove_centres", "ball_centres"):
            raise InputError(f"reference: {self.reference!r} is none of groove_centres, ball_centres")

    def _check_clearance(self) -> None:
        if self.radial_clearance != 0.0 and self.contact_angle != 0.0:
            raise InputError(
                "radial_clearance: a bearing with a contact angle has its clearance in that angle already "
                "(cos a = 1 - r_L / A0); give one of them"
            )
        if abs(self.radial_clearance) >= self.groove_distance:
            raise InputError(
                f"radial_clearance: {self.radial_clearance:g} m exceeds the distance of the groove centres, "
                f"{self.groove_distance:g} m; is it in micrometres?"
            )

    @property
    def elements(self) -> int:
        """Number of balls Z."""
        return self.balls

    @property
    def contact_count(self) -> int:
        """One contact pair a ball."""
        return self.balls

    @property
    def groove_distance(self) -> float:
        """Unloaded distance of the groove centres, A0 = (f_i + f_o - 1) D, m."""
        return (self.inner_conformity + self.outer_conformity - 1.0) * self.ball_diameter

    @property
    def lever(self) -> float:
        """Radius of the inner groove centres, r = d_m / 2 + (f_i - 1/2) D cos(a), m."""
        return 0.5 * self.pitch_diameter + (self.inner_conformity - 0.5) * self.ball_diameter * float(
            np.cos(self.contact_angle)
        )

    @cached_property
    def contact_stiffness(self) -> float:
        """Kn of both contacts in series, N/m^1.5, by the exact Hertzian solution."""
        modulus = effective_modulus(self.youngs_modulus, self.poisson_ratio)
        inner, outer = (point_contact(*self._radii(side), modulus) for side in (-1, 1))
        return in_series(inner, outer, POINT)

    def _radii(self, side: int) -> tuple[float, float]:
        conformity = self.inner_conformity if side < 0 else self.outer_conformity
        return groove_radii(self.ball_diameter, self.pitch_diameter, conformity, self.contact_angle, side)

    @property
    def scale(self) -> tuple[float, float]:
        """Kn and n."""
        return self.contact_stiffness, POINT

    @cached_property
    def _rows(self) -> Real:
        """G (2, Z, 5) = d(dr, dz) / dq of every ball."""
        psi = self.phase + self._pitch * np.arange(self.balls)
        c, s, one, none = np.cos(psi), np.sin(psi), np.ones(self.balls), np.zeros(self.balls)
        r = self.lever
        z0 = 0.0
        if self.reference == "ball_centres":
            z0 = (self.inner_conformity - 0.5) * self.ball_diameter * float(np.sin(self.contact_angle))
        return np.array([[c, s, none, -z0 * s, z0 * c], [none, none, one, r * s, -r * c]]).transpose(0, 2, 1)

    @cached_property
    def _products(self) -> Real:
        """(3 Z, 25): what a unit of each entry of a ball's 2x2 stiffness adds to K."""
        g, h = self._rows
        mixed = g[:, :, None] * h[:, None, :]
        parts = (g[:, :, None] * g[:, None, :], mixed + mixed.transpose(0, 2, 1), h[:, :, None] * h[:, None, :])
        return np.concatenate(parts).reshape(-1, 25)

    def _balls(self, q: Real) -> _Balls:
        A0, cosine, sine = self.groove_distance, np.cos(self.contact_angle), np.sin(self.contact_angle)
        dr = q @ self._rows[0].T - self.radial_clearance
        dz = q @ self._rows[1].T
        radial, axial = A0 * cosine + dr, A0 * sine + dz
        length = np.hypot(radial, axial)
        # A - A0 without cancellation
        approach = (2.0 * A0 * (cosine * dr + sine * dz) + dr**2 + dz**2) / (length + A0)
        approach = np.maximum(approach, 0.0)
        safe = np.where(length > 0, length, 1.0)
        return _Balls(safe, radial / safe, axial / safe, approach, self.contact_stiffness * approach**POINT)

    def _potential(self, q: Real) -> tuple[Real, Real]:
        ball = self._balls(q)
        energy = (ball.load * ball.approach).sum(axis=1) / (POINT + 1.0)
        return energy, (ball.load * ball.radial) @ self._rows[0] + (ball.load * ball.axial) @ self._rows[1]

    def _stiffness(self, q: Real) -> Real:
        """K = sum G^T [Q' e e^T + (Q/A)(I - e e^T)] G; the second term is the change of the contact angles."""
        ball = self._balls(q)
        along = POINT * self.contact_stiffness * np.sqrt(ball.approach)
        across = ball.load / ball.length
        turned = along - across
        mixed = turned * ball.radial * ball.axial
        entries = (across + turned * ball.radial**2, mixed, across + turned * ball.axial**2)
        return np.asarray((np.concatenate(entries, axis=1) @ self._products).reshape(-1, 5, 5))

    def _contacts(self, q: Real) -> Contacts:
        ball = self._balls(q)
        return Contacts(ball.load, np.arctan2(ball.axial, ball.radial))

    def limits(self, found: Contacts, speed: float | None) -> Sequence[str]:
        """Centrifugal force, the contact ellipse at the shoulder, and balls on the side without a shoulder."""
        heaviest = int(found.load.argmax())
        load, angle = float(found.load[heaviest]), float(found.angle[heaviest])
        notes: list[str] = []
        if speed is not None:
            mass = DENSITY * np.pi / 6.0 * self.ball_diameter**3
            gamma = self.ball_diameter * np.cos(angle) / self.pitch_diameter
            notes += centrifugal_note(mass, 0.5 * self.pitch_diameter, gamma, speed, load)
        modulus = effective_modulus(self.youngs_modulus, self.poisson_ratio)
        for side, conformity in ((-1, self.inner_conformity), (1, self.outer_conformity)):
            half = semi_major_axis(*self._radii(side), modulus, load)
            notes += ellipse_note(half, angle, conformity, self.ball_diameter, "inner" if side < 0 else "outer")
        if self.contact_angle:
            notes += wrong_side_note(found.load, found.angle * np.sign(self.contact_angle))
        return notes
