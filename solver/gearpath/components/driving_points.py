"""Whether driving-point mobilities can be mobilities: a passive structure takes in power at every line.

Re(Y_aa) >= 0, and away from resonances (|Im Y_aa| > |Re Y_aa|) Im(Y_aa) rises with frequency (Foster's reactance
theorem, for modes of light damping), with phasors e^(+i w t). An accelerance or receptance, i w Y or Y / (i w), has a
real part of either sign; phasors e^(-i w t) turn the slope round (mobility) or the real part (the others).
"""

from collections.abc import Iterator, Sequence

import numpy as np

from ..numerics.arrays import Complex, Real

_ACTIVE = 0.3  # -Re Y of |Y|: more than noise
_OFTEN, _SELDOM = 0.05, 0.01  # of the values: when they are no mobilities, and when they are
_FALLING, _RISING = 0.2, 0.8  # part of the steps that rise, of phasors e^(-i w t) and e^(+i w t)
_STEPS, _FEWEST = 200, 20  # steps of frequency, and how many values are enough to tell
_ORDERS = {"receptance": 0, "mobility": 1, "accelerance": 2}  # powers of i w against the receptance


def complaint(omega: Real, mobility: Complex, quantity: str, channels: Sequence[str]) -> str | None:
    """What data declared as `quantity` and turned into mobilities (F, m, m) look like instead; None: nothing wrong.

    `omega` (F,), rad/s, increasing; `channels` are m names. Data are wrong for certain only where another reading of
    them makes driving points of them that are those of a structure.
    """
    Y = np.einsum("faa->fa", mobility)
    if _is_active(Y) or _falls(Y):
        found = [words for words, taken in _readings(omega, Y, quantity) if _is_passive(taken)]
        if found:
            return f"no passive structure has such driving points; they would do {' or '.join(found)}"
    turned = [name for k, name in enumerate(channels) if Y[:, k].real.sum() < 0.0 and _falls(Y[:, k : k + 1])]
    if turned:
        return f"at {', '.join(turned)} the driving point gives off power: force and response have opposite signs"
    return None


def active_part(mobility: Complex) -> float:
    """Part of the driving-point values (F, m, m) at which a structure would give off power, beyond noise."""
    return float(_active(np.einsum("faa->fa", mobility)).mean())


def _readings(omega: Real, Y: Complex, quantity: str) -> Iterator[tuple[str, Complex]]:
    """The same data read in another way, as mobilities (F, m)."""
    own = _ORDERS[quantity]
    for other, order in _ORDERS.items():
        if other != quantity:
            yield f"as {other}", Y * (1j * omega[:, None]) ** (own - order)
    yield "with phasors e^(-i w t): conjugate the data", Y.conj() * (1.0 if quantity == "mobility" else -1.0)
    yield "with force and response of opposite signs", -Y


def _is_passive(Y: Complex) -> bool:
    return bool(_active(Y).mean() <= _SELDOM) and _rising(Y) > _RISING


def _active(Y: Complex) -> np.ndarray:
    return np.asarray(Y.real < -_ACTIVE * abs(Y))


def _is_active(Y: Complex) -> bool:
    """Whether power comes out often, or more than it goes in at what is clearly resistive, as near resonances."""
    out, taken = int(np.count_nonzero(_active(Y))), int(np.count_nonzero(_active(-Y)))
    return out > _OFTEN * Y.size or out > max(2 * taken, _FEWEST)


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
