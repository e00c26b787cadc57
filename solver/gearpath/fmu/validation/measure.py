"""How a deviation is judged: relative to the output itself, or to a thousandth of the largest of its kind.

An output that vanishes by symmetry is rounding of the others, so its own size is no yardstick; and one that is exactly
zero must be found exactly zero, up to that same rounding.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...network.modal import ModalNetwork
from ...network.records import Load, Output
from ...numerics.arrays import Real

_FLOOR = 1e-3  # of the largest of its kind
_LEVER = 0.01  # m, turns forces into moments and motions into rotations for the floor


@dataclass(frozen=True)
class Drive:
    """What drives the outputs that are compared."""

    force: float  # largest input force, or its inertial equivalent, N
    rate: float  # largest angular frequency, rad/s
    rounding: float = 0.0  # force that is lost in the rounding of a transmission error's own motion, per unit limit, N


def spring_force(network: ModalNetwork, load: Load) -> float:
    """K, N/m: a transmission error passes the joints as a vanishing difference of motions, with rounding eps K e."""
    if not load.is_transmission_error:
        return 0.0
    return max((float(abs(joint.stiffness).max()) for joint in network.joints), default=0.0)


def relative(deviation: Real, size: Real) -> float:
    """Largest deviation / size: 0 where nothing deviates, infinite where a zero is not met, NaN for a NaN."""
    deviation, size = np.broadcast_arrays(np.asarray(deviation, float), np.asarray(size, float))
    out = np.divide(deviation, size, out=np.full(deviation.shape, np.inf), where=size > 0.0)
    return float(np.max(np.where(deviation == 0.0, 0.0, out), initial=0.0))


def yardsticks(outputs: Sequence[Output], sizes: Mapping[str, float], drive: Drive) -> dict[str, float]:
    """Size that each output is judged by; `sizes` are their largest moduli."""
    floors = _floors(outputs, sizes, drive)
    force = floors["force", False]
    scale = max(1.0, drive.rounding / force) if force > 0.0 else 1.0
    return {o.name: scale * max(sizes[o.name], _FLOOR * floors[o.quantity, _rotates(o)]) for o in outputs}


def _rotates(output: Output) -> bool:
    return output.unit.startswith("rad") or output.unit == "N.m"


def _floors(outputs: Sequence[Output], sizes: Mapping[str, float], drive: Drive) -> dict[tuple[str, bool], float]:
    """Largest value of each quantity; kinds that are all rounding get their size from the others."""

    def largest(quantity: str, turn: bool) -> float:
        return max((sizes[o.name] for o in outputs if o.quantity == quantity and _rotates(o) == turn), default=0.0)

    found: dict[tuple[str, bool], float] = {}
    force = max(largest("force", False), drive.force)
    found["force", False], found["force", True] = force, max(largest("force", True), _LEVER * force)
    velocity = max(
        max(rate * largest(q, False), rate * _LEVER * largest(q, True))
        for q, rate in (("displacement", drive.rate), ("velocity", 1.0), ("acceleration", 1.0 / drive.rate))
    )
    for quantity, rate in (("displacement", 1.0 / drive.rate), ("velocity", 1.0), ("acceleration", drive.rate)):
        found[quantity, False] = max(largest(quantity, False), rate * velocity)
        found[quantity, True] = max(largest(quantity, True), rate * velocity / _LEVER * _FLOOR)
    found["power", False] = max(largest("power", False), _FLOOR * force * velocity)
    return found


def largest_deviation(
    outputs: Sequence[Output],
    found: Mapping[str, NDArray[np.inexact]],
    expected: Mapping[str, NDArray[np.inexact]],
    drive: Drive,
) -> float:
    """Largest deviation of any output's values, relative to its yardstick; NaN if any value is NaN."""
    sizes = {o.name: float(np.max(abs(expected[o.name]))) for o in outputs}
    scale = yardsticks(outputs, sizes, drive)
    worst = [relative(np.max(abs(found[o.name] - expected[o.name])), np.array(scale[o.name])) for o in outputs]
    return float(np.max(worst, initial=0.0))
