"""Choosing the order: as given, or the smallest whose certificate keeps a tolerance."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from numbers import Real as Number
from typing import Protocol

import numpy as np

from ...errors import InputError
from ...network.modal import ModalNetwork
from ...network.response import frequency_response
from ...numerics.arrays import Complex, Real
from .certificate import Certificate, Comparison, certify, linear_outputs, poles
from .congruence import Basis, congruent
from .krylov import RationalKrylov
from .modes import CraigBampton, FreeModes
from .passivity import is_passive_network

METHODS = ("rational_krylov", "modal", "craig_bampton", "balanced")
_ROUGHLY = 0.9  # of the tolerance: what the certificate's finer grid may add to the grid for choosing


class Bases(Protocol):
    """A method of reduction by congruence: bases of any order between its least and its most."""

    @property
    def least(self) -> int:
        """Smallest order that is worth a try."""

    @property
    def most(self) -> int:
        """Largest order."""

    def bases(self, order: int) -> Mapping[str, Basis]:
        """Bases of all components with `order` coordinates in all."""


@dataclass(frozen=True)
class Reduced:
    """A reduced network and its certificate."""

    network: ModalNetwork
    certificate: Certificate
    comparison: Comparison  # with the complete network


def check_request(
    network: ModalNetwork, order: int | None, tolerance: float | None, band: tuple[float, float], method: str
) -> None:
    """Refuse what cannot be computed. Raises InputError."""
    if method not in METHODS:
        raise InputError(f"method: there is no method {method!r} of reduction; use one of: {', '.join(METHODS)}")
    if (order is None) == (tolerance is None):
        raise InputError("order, tolerance: give one of the two, order=40 or tolerance=1e-3")
    if order is not None and (isinstance(order, bool) or not isinstance(order, (int, np.integer)) or order < 1):
        raise InputError(f"order: {order!r} is not a number of coordinates; give a whole number from 1 up")
    if tolerance is not None and not (isinstance(tolerance, Number) and 0.0 < tolerance < 1.0):
        raise InputError(f"tolerance: {tolerance!r} is not a relative error; give a number between 0 and 1")
    low, high = band
    if not 0.0 < low < high < np.inf:
        raise InputError(f"band: {low:g} to {high:g} Hz is none; give two frequencies, the lower one first")
    if high > network.band * (1.0 + 1e-9):
        raise InputError(
            f"band: {high:g} Hz is above {network.band:g} Hz, up to which plates and frames of this model were "
            "reduced; raise frequency.stop of the model"
        )


def reduced_network(
    network: ModalNetwork,
    *,
    order: int | None = None,
    tolerance: float | None = None,
    band: tuple[float, float],
    method: str = "rational_krylov",
) -> Reduced:
    """The viscous network on few coordinates, its joints still explicit, with a certificate over the band (Hz).

    Raises:
        InputError: neither or both of order and tolerance, an unknown method or one without networks, or an order that
            the method does not have.
    """
    check_request(network, order, tolerance, band, method)
    if method == "balanced":
        raise InputError(
            "method: balanced truncation mixes components and joints, so that no network is left; use gearpath.reduce, "
            "or another method for FMUs"
        )
    complete = network.viscous()
    makers: dict[str, Callable[[], Bases]] = {
        "rational_krylov": lambda: RationalKrylov(complete, band),
        "modal": lambda: FreeModes(complete),
        "craig_bampton": lambda: CraigBampton(complete),
    }
    bases = makers[method]()
    comparison = Comparison(complete, band)
    if order is None:
        assert tolerance is not None
        check_tolerance(comparison, tolerance)
        return _by_tolerance(complete, comparison, bases, tolerance, method)
    if method == "craig_bampton" and order < bases.least:
        raise InputError(f"order: {order} is below the {bases.least} constraint modes; give at least so many")
    network = congruent(complete, bases.bases(min(int(order), bases.most)))
    return certified(network, comparison, method, _note(int(order), len(network.eigenvalues), bases))


def check_tolerance(comparison: Comparison, tolerance: float) -> None:
    """Refuse a tolerance that rounding alone exceeds. Raises InputError."""
    floor, low = comparison.rounding, comparison.band[0]
    if floor > tolerance:
        raise InputError(
            f"tolerance: {tolerance:g} cannot be certified from {low:g} Hz on, where rounding alone is {floor:.2g} of "
            "the responses; begin the band higher"
        )


def certified(network: ModalNetwork, comparison: Comparison, method: str, note: str = "") -> Reduced:
    """A reduced network with what is certain of it."""
    passive = is_passive_network(network)
    stable = passive or bool((poles(network).real <= 0.0).all())
    return Reduced(network, certify(network, comparison, method, stable=stable, passive=passive, note=note), comparison)


def _note(asked: int, found: int, bases: Bases) -> str:
    """What to know of a reduction to a given order."""
    notes = []
    if asked > bases.most:
        notes.append(f"order {asked} was asked for: there are no more than {bases.most} coordinates")
    elif found > asked:
        notes.append(f"order {asked} was asked for: equal coordinates, such as rigid motions, stay together")
    elif found < asked:
        notes.append(f"order {asked} was asked for: equal coordinates stay together, and no more differ in this band")
    if found < bases.least:
        notes.append(f"the components have {bases.least} modes up to the end of the band: give at least this order")
    return "; ".join(notes)


def _of_order(
    complete: ModalNetwork, comparison: Comparison, bases: Bases, order: int, method: str, note: str = ""
) -> Reduced:
    return certified(congruent(complete, bases.bases(order)), comparison, method, note)


def _by_tolerance(
    complete: ModalNetwork, comparison: Comparison, bases: Bases, tolerance: float, method: str
) -> Reduced:
    """The smallest order that keeps the tolerance: by halves on a grid for choosing, then certified."""

    def error(order: int) -> float:
        network = congruent(complete, bases.bases(order))

        def respond(omega: Real) -> Complex:
            return frequency_response(network, omega, linear_outputs(network), network.loads)

        return comparison.rough(respond).error

    low, high = bases.least - 1, bases.most  # too few, surely enough
    step = 1
    while low + step < high:  # by doubling from below: large orders cost most
        if error(low + step) <= _ROUGHLY * tolerance:
            high = low + step
            break
        low, step = low + step, 2 * step
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if error(middle) <= _ROUGHLY * tolerance else (middle, high)
    while True:
        note = f"no smaller order keeps {tolerance:g}" if high >= bases.most else ""
        found = _of_order(complete, comparison, bases, high, method, note)
        if found.certificate.error <= tolerance or high >= bases.most:
            return found
        high += 1
