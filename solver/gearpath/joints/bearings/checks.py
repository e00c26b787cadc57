"""Refusals of what cannot be a bearing: one sentence that names the argument."""

from collections.abc import Iterable
from numbers import Real as Number

import numpy as np
from numpy.typing import ArrayLike

from ...errors import InputError
from ...numerics.arrays import Real

DOFS = ("ux", "uy", "uz", "rx", "ry", "rz")


def finite(**values: float) -> None:
    """Refuse what is not a finite number."""
    for name, value in values.items():
        if isinstance(value, bool) or not isinstance(value, Number) or not np.isfinite(float(value)):
            raise InputError(f"{name}: {value!r} must be a finite number in SI units")


def positive(**values: float) -> None:
    """Refuse what is not a positive finite number."""
    finite(**values)
    for name, value in values.items():
        if value <= 0:
            raise InputError(f"{name}: {value!r} must be a positive number in SI units")


def count(low: int, **values: int) -> None:
    """Refuse what is not a whole number of at least `low`."""
    for name, value in values.items():
        if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < low:
            raise InputError(f"{name}: {value!r} must be a whole number of at least {low}")


def numbers(name: str, values: Iterable[float]) -> tuple[float, ...]:
    """A tuple of finite floats."""
    try:
        result = tuple(float(value) for value in values)
    except (TypeError, ValueError):
        raise InputError(f"{name}: {values!r} must be a list of numbers in SI units") from None
    finite(**{f"{name}[{i}]": value for i, value in enumerate(result)})
    return result


def displacements(values: ArrayLike) -> Real:
    """Displacements (..., 6) as an array."""
    try:
        q = np.asarray(values, float)
    except (TypeError, ValueError):
        raise InputError(f"a displacement has the six numbers {', '.join(DOFS)} (m, rad), not {values!r}") from None
    if q.ndim == 0 or q.shape[-1] != 6:
        raise InputError(
            f"a displacement has the six entries {', '.join(DOFS)} (m, rad) along its last axis, not shape {q.shape}"
        )
    if not np.isfinite(q).all():
        raise InputError("a displacement must be finite; check its numbers and units (m, rad)")
    return q
