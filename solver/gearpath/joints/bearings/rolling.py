"""What all rolling bearings have in common: sums over their contacts, vectorised over displacements."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike

from ...errors import InputError
from ...numerics.arrays import Real
from .checks import count, displacements
from .damping import loss_factor_damping, proportional_damping

if TYPE_CHECKING:
    from .equilibrium import Equilibrium

_CHUNK = 200_000  # contacts at a time: bounds the memory of long sweeps


@dataclass(frozen=True)
class Contacts:
    """State of the rolling elements: `load` (..., Z) N and `angle` (..., Z) rad, the direction in which it acts."""

    load: Real
    angle: Real


class RollingBearing(ABC):
    """A bearing whose load derives from a convex energy of its contacts."""

    @abstractmethod
    def _potential(self, q: Real) -> tuple[Real, Real]:
        """Energy (k,) and load (k, 5) of displacements (k, 5)."""

    @abstractmethod
    def _stiffness(self, q: Real) -> Real:
        """Stiffness (k, 5, 5)."""

    @abstractmethod
    def _contacts(self, q: Real) -> Contacts:
        """Loads and angles (k, Z)."""

    @property
    @abstractmethod
    def lever(self) -> float:
        """The radius that makes rotations comparable with displacements, m."""

    @property
    @abstractmethod
    def scale(self) -> tuple[float, float]:
        """Kn and n of one element: they say how far a load moves it."""

    @property
    @abstractmethod
    def contact_count(self) -> int:
        """Contacts that are summed up."""

    @abstractmethod
    def limits(self, found: Contacts, speed: float | None) -> Sequence[str]:
        """Sentences on where the theory stops with these element loads, N, at this speed, rev/min."""

    def energy(self, displacement: ArrayLike) -> Real:
        """Elastic energy U = sum Kn d^(n+1) / (n+1), J, of displacements (..., 6)."""
        return self._over(lambda q: self._potential(q)[0], displacement, ())

    def load(self, displacement: ArrayLike) -> Real:
        """Load on the inner ring, f = grad U (..., 6), N and N m, at displacements (..., 6), m and rad."""
        return self._over(lambda q: self._potential(q)[1], displacement, (5,))

    def stiffness(self, displacement: ArrayLike) -> Real:
        """Stiffness K = hess U (..., 6, 6), N/m, N/rad and N m/rad; symmetric, positive semidefinite, rz zero."""
        return self._over(self._stiffness, displacement, (5, 5))

    def contacts(self, displacement: ArrayLike) -> Contacts:
        """Load and direction (..., Z) of every rolling element at displacements (..., 6)."""
        q = displacements(displacement)
        found = self._contacts(q.reshape(-1, 6)[:, :5])
        shape = (*q.shape[:-1], -1 if q.size else self.elements)
        return Contacts(found.load.reshape(shape), found.angle.reshape(shape))

    def equilibrium(
        self, load: Mapping[str, float], *, start: ArrayLike | None = None, speed: float | None = None
    ) -> Equilibrium:
        """The displacement at which the bearing carries `load`, such as {"ux": 1e3, "uz": 500.0} (N, N m).

        The named degrees of freedom are free, the others stay at zero displacement; what they carry is in the result's
        `load`. Raises InputError for a load that the bearing cannot carry. With `speed` (rev/min, of the inner ring)
        the result warns where the centrifugal force on the elements matters, which this theory leaves out.
        """
        from .equilibrium import solve

        return solve(self, load, start=start, speed=speed)

    def phase_average(self, at: Mapping[str, float] | Sequence[float] | Real, samples: int = 16) -> Real:
        """Stiffness (6, 6) averaged over the positions of the cage, at a load (by name) or at a displacement (6,)."""
        from .equilibrium import settle

        count(1, samples=samples)
        positions = [self._shifted(i / samples) for i in range(samples)]
        if isinstance(at, Mapping):
            every = [self.equilibrium(at).stiffness]  # warns once
            every += [settle(bearing, at).stiffness for bearing in positions[1:]]
        else:
            every = [bearing.stiffness(at) for bearing in positions]
        return np.asarray(np.mean(every, axis=0))

    def damping(
        self,
        displacement: ArrayLike,
        *,
        time: float | None = None,
        loss_factor: float | None = None,
        frequency: float | None = None,
    ) -> Real:
        """Damping (..., 6, 6) that goes with the stiffness: C = time K, or C = loss_factor K / w at `frequency` (Hz).

        See `proportional_damping` and `loss_factor_damping`. Raises InputError where not one of the two is given.
        """
        if time is not None and loss_factor is None and frequency is None:
            return proportional_damping(self.stiffness(displacement), time)
        if time is None and loss_factor is not None and frequency is not None:
            return loss_factor_damping(self.stiffness(displacement), loss_factor, frequency)
        raise InputError("damping: give time (s), or loss_factor and frequency (Hz)")

    def mirrored(self) -> Self:
        """The same bearing facing the other way: contact angle -a."""
        return replace(self, contact_angle=-self.contact_angle)  # type: ignore[type-var, attr-defined]

    def turned(self, phase: float) -> Self:
        """The same bearing with its cage turned on by `phase`, rad."""
        return replace(self, phase=self.phase + phase)  # type: ignore[type-var, attr-defined]

    def _shifted(self, part: float) -> RollingBearing:
        """The same bearing with its cage turned on by a part of the distance of two elements."""
        return self.turned(part * self._pitch)

    @property
    def _pitch(self) -> float:
        return 2.0 * np.pi / self.elements

    @property
    @abstractmethod
    def elements(self) -> int:
        """Number of rolling elements Z."""

    def _over(self, function: Any, displacement: ArrayLike, shape: tuple[int, ...]) -> Real:
        """Apply a function of (k, 5) in bounded chunks; pads its result to six degrees of freedom."""
        q = displacements(displacement)
        flat = q.reshape(-1, 6)
        result = np.zeros((len(flat), *(6 for _ in shape)))
        inside = (slice(None), *(slice(0, n) for n in shape))
        step = max(1, _CHUNK // self.contact_count)
        for begin in range(0, len(flat), step):
            part = slice(begin, begin + step)
            result[part][inside] = function(flat[part, :5])
        return result.reshape(q.shape[:-1] + result.shape[1:])
