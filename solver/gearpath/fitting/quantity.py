"""Measured quantities: accelerance a / F, mobility v / F and receptance u / F, each i w times the next."""

import numpy as np

from ..errors import InputError
from ..numerics.arrays import Complex, Real

QUANTITIES = {"accelerance": -1, "mobility": 0, "receptance": 1}  # power of i w that makes a mobility of it


def as_mobility(omega: Real, frf: Complex, quantity: str) -> Complex:
    """Mobility (F, m, m) of a matrix of FRFs at the angular frequencies `omega` (rad/s).

    Raises InputError for an unknown quantity.
    """
    if quantity not in QUANTITIES:
        raise InputError(f"quantity: there is no {quantity!r}; use one of: {', '.join(QUANTITIES)}")
    return np.asarray(frf * ((1j * omega) ** QUANTITIES[quantity])[:, None, None])
