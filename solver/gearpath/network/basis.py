"""The modes that stand for a large component: constraint modes and Lanczos vectors, as many as the band needs."""

import numpy as np

from ..components import Modes, Structure
from ..errors import AccuracyError
from ..reduction import LanczosReduction, estimated_deviation, hold, inertia_relief, port_rows, reduced_modes

_TOLERANCE = 1e-6  # estimated deviation of the interface mobility anywhere in the band
_LINES = 16
_MOST = 2000  # vectors


def basis_of(structure: Structure, band: float, vectors: int | None) -> Modes:
    """Modes of a reduced sparse structure, shapes (n, r), rigid-body modes exact.

    With `vectors` that many Lanczos vectors beside the constraint modes of the ports; without, as many as bring the
    estimated deviation of the interface mobility below 1e-6 up to `band` (Hz). Raises AccuracyError where 2000 do not.
    """
    held = hold(structure, port_rows(structure))
    lanczos = LanczosReduction(held)
    if vectors is not None:
        return reduced_modes(structure, lanczos.take(vectors))
    omega = 2.0 * np.pi * np.linspace(band / _LINES, band, _LINES)
    flexibility = inertia_relief(structure, held)
    count = max(4 * held.boundary, 24)
    while True:
        reduction = lanczos.take(count)
        worst = float(estimated_deviation(structure, reduction, omega, flexibility=flexibility).max())
        if worst < _TOLERANCE:
            return reduced_modes(structure, reduction)
        if count >= _MOST or reduction.vectors < count:
            raise AccuracyError(
                f"{reduction.vectors} vectors leave the mobility of a component off by {worst:.1g} below {band:g} Hz; "
                "give a lower frequency.stop, or choose the number of vectors and accept its error"
            )
        count = min(count + count // 2, _MOST)
