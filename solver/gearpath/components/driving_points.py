"""Whether driving-point mobilities can be mobilities: a passive structure takes in power at every line.

Re(Y_aa) >= 0, and away from resonances (|Im Y_aa| > |Re Y_aa|) Im(Y_aa) rises with frequency (Foster's reactance
theorem, for modes of light damping), with phasors e^(+i w t). An accelerance or receptance, i w Y or Y / (i w), has a
real part of either sign; phasors e^(-i w t) turn the slope round.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from ..numerics.arrays import Complex, Real

_ACTIVE = 0.3  # -Re Y of |Y|: more than noise
_OFTEN, _SELDOM = 0.05, 0.01  # of the values: when they are no mobilities, and when they are
_FALLING, _RISING = 0.2, 0.8  # part of the steps that rise, of phasors e^(-i w t) and e^(+i w t)
_STEPS, _FEWEST = 200, 20  # steps of frequency, and how many are enough to tell
_ORDERS = {"receptance": 0, "mobility": 1, "accelerance": 2}  # powers of i w against the receptance


def complaint(omega: Real, mobility: Complex, quantity: str, channels: Sequence[str]) -> str | None:
    """What data declared as `quantity` and turned into mobilities (F, m, m) look like instead; None: nothing wrong.

    `omega` (F,), rad/s, increasing; `channels` are m names.
    """
    Y = np.einsum("faa->fa", mobility)
    turned = [name for k, name in enumerate(channels) if Y[:, k].real.sum() < 0.0 and _falls(Y[:, k : k + 1])]
    if turned:
        return f"at {', '.join(turned)} the driving point gives off power: force and response have opposite signs"
    if _falls(Y):
        return "the phase falls where that of a structure rises, as with phasors e^(-i w t); conjugate the data"
    if _active(Y).mean() > _OFTEN:
        for other, taken in _others(omega, Y, quantity):
            if _active(taken).mean() <= _SELDOM and _rising(taken) > _RISING:
                return f"no passive structure has such driving points; they would do as {other}"
    return None


def active_part(mobility: Complex) -> float:
    """Part of the driving-point values (F, m, m) at which a structure would give off power, beyond noise."""
    return float(_active(np.einsum("faa->fa", mobility)).mean())


def _others(omega: Real, Y: Complex, quantity: str) -> Iterator[tuple[str, Complex]]:
    """The same data taken for another quantity."""
    for other, order in _ORDERS.items():
        if other != quantity:
            yield other, Y * (1j * omega[:, None]) ** (_ORDERS[quantity] - order)


def _active(Y: Complex) -> np.ndarray:
    return np.asarray(Y.real < -_ACTIVE * abs(Y))


def _falls(Y: Complex) -> bool:
    return _rising(Y) < _FALLING


def _rising(Y: Complex) -> float:
    """Part of the steps away from resonances on which Im Y rises; 1/2 where there are too few to tell."""
    apart = max(1, len(Y) // _STEPS)
    low, high = Y[:-apart:apart], Y[apart::apart]
    clear = (abs(low.imag) > abs(low.real)) & (abs(high.imag) > abs(high.real)) & (low.imag * high.imag > 0.0)
    if clear.sum() < _FEWEST:
        return 0.5
    return float((high.imag > low.imag)[clear].mean())
