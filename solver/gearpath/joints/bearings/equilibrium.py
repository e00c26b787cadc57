"""The displacement at which a bearing carries a given load: Newton's method on its convex energy."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import AccuracyError, InputError
from ...numerics.arrays import Real
from ...numerics.convex import Look, Minimum, minimise
from .checks import DOFS, displacements, finite
from .rolling import Contacts

if TYPE_CHECKING:
    from .rolling import RollingBearing

TOLERANCE, ENOUGH = 1e-11, 1e-9  # of the load: what is aimed at, and what must be reached
_ROUNDING = 1e-14  # of the sum of the element loads
_FAR = 0.2  # of the lever: a displacement as large as this is a bearing that comes apart


@dataclass(frozen=True)
class Equilibrium:
    """A bearing under load; six degrees of freedom, SI units."""

    displacement: Real  # (6,)
    load: Real  # (6,) what the bearing carries, with the reactions of the degrees of freedom that were held
    stiffness: Real  # (6, 6)
    element_loads: Real  # (Z,) N
    contact_angles: Real  # (Z,) rad; of free elements, where they would touch
    loaded: int  # elements that carry load
    iterations: int  # linear solves
    residual: float  # of the free degrees of freedom, over the load
    notes: tuple[str, ...] = ()  # where the theory stops


def solve(
    bearing: RollingBearing, load: Mapping[str, float], *, start: ArrayLike | None = None, speed: float | None = None
) -> Equilibrium:
    """See RollingBearing.equilibrium."""
    if speed is not None:
        finite(speed=speed)
    found = settle(bearing, load, start)
    notes = tuple(bearing.limits(Contacts(found.element_loads, found.contact_angles), speed))
    for note in notes:
        warnings.warn(note, stacklevel=3)
    return replace(found, notes=notes)


def settle(bearing: RollingBearing, load: Mapping[str, float], start: ArrayLike | None = None) -> Equilibrium:
    """The equilibrium without a look at the limits of the theory."""
    free, wanted = _given(load)
    q = np.zeros(6) if start is None else displacements(start).copy()
    if q.shape != (6,):
        raise InputError(f"start: must be one displacement (6,), not of shape {q.shape}")
    q[~free] = 0.0
    size = np.array([1.0, 1.0, 1.0, bearing.lever, bearing.lever])  # of a load: moments over the lever
    strength = float(np.abs(wanted[:5] / size).max()) or float(bearing.contacts(q).load.max())
    if strength == 0.0:
        raise InputError(
            "load: zero leaves a bearing without preload where it is; name at least one force or moment (N, N m)"
        )
    q, solves, residual = _minimise(bearing, q, wanted, np.flatnonzero(free), size, strength)
    return state_at(bearing, q, solves, residual)


def state_at(bearing: RollingBearing, q: Real, iterations: int = 0, residual: float = 0.0) -> Equilibrium:
    """What a bearing carries at a displacement (6,), however that was found."""
    contacts = bearing.contacts(q)
    return Equilibrium(
        displacement=q,
        load=bearing.load(q),
        stiffness=bearing.stiffness(q),
        element_loads=contacts.load,
        contact_angles=contacts.angle,
        loaded=int((contacts.load > 0).sum()),
        iterations=iterations,
        residual=residual,
    )


def _given(load: Mapping[str, float]) -> tuple[NDArray[np.bool_], Real]:
    """Which degrees of freedom are free, and the load on all six."""
    if not isinstance(load, Mapping):
        raise InputError(f'load: {load!r} must give loads by name, such as {{"ux": 1e3, "rx": 2.0}} (N, N m)')
    free, wanted = np.zeros(6, np.bool_), np.zeros(6)
    for name, value in load.items():
        if name not in DOFS:
            raise InputError(f"load: there is no degree of freedom {name!r}; use {', '.join(DOFS[:5])}")
        if name == "rz":
            raise InputError("load: a bearing turns freely about its axis and carries no moment rz; leave it out")
        finite(**{f"load: {name}": value})
        free[DOFS.index(name)], wanted[DOFS.index(name)] = True, value
    if not free.any():
        raise InputError("load: names no degree of freedom; give at least one force or moment (N, N m)")
    return free, wanted


def _minimise(
    bearing: RollingBearing, q: Real, wanted: Real, free: NDArray[np.intp], size: Real, strength: float
) -> Minimum:
    """The minimum of U - F q, rotations scaled by the lever, in units of what one element has under the whole load."""
    constant, exponent = bearing.scale
    guess = (strength / constant) ** (1.0 / exponent)
    s = size[free] * np.sqrt(strength / guess)
    inside = np.ix_(free, free)

    def at(x: Real) -> Real:
        moved = q.copy()
        moved[free] = x / s
        return moved

    def look(x: Real) -> Look:
        moved = at(x)
        energy, load = bearing._potential(moved[None, :5])
        rest = wanted[free] - load[0, free]
        residual = float(np.abs(rest / size[free]).max()) / strength
        return Look(float(energy[0]) - float(wanted @ moved), rest / s, residual)

    found = minimise(
        look,
        lambda x: bearing._stiffness(at(x)[None, :5])[0][inside] / np.outer(s, s),
        q[free] * s,
        tolerance=TOLERANCE,
        slack=1e-14 * strength * guess,
        lost=lambda x: bool(np.abs(at(x)[:5] * size).max() > _FAR * bearing.lever),
    )
    displacement = at(found.place)
    # internal forces far above the load leave no more digits
    if found.residual <= max(ENOUGH, _ROUNDING * float(bearing.contacts(displacement).load.sum()) / strength):
        return found._replace(place=displacement)
    raise _failure(bearing, displacement, wanted, size, found.residual)


def _failure(bearing: RollingBearing, q: Real, wanted: Real, size: Real, residual: float) -> Exception:
    """What to tell where no equilibrium was found: a load without support, or lost digits."""
    loads = ", ".join(f"{name} = {value:g}" for name, value in zip(DOFS, wanted) if value) or "no load"
    if np.abs(q[:5] * size).max() > _FAR * bearing.lever:
        away = DOFS[int(np.abs(q[:5] * size).argmax())]
        return InputError(
            f"load: the bearing cannot carry {loads}: it comes apart along {away}; hold that degree of freedom (leave "
            "it out of the load), add preload or turn the bearing round"
        )
    return AccuracyError(f"the equilibrium under {loads} was found only to {residual:.1e} of the load")
