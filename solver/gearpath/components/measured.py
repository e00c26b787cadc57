"""A structure known by measured mobilities at its ports."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from ..errors import InputError
from ..numerics.arrays import Complex, Real
from .modal_model import named_rows
from .rigid_body import Vector
from .structure import Structure

_EDGE = 1e-9  # rounding of the first and the last line, relative


@dataclass(frozen=True, eq=False)
class Measured:
    """Mobilities Y (F, m, m) between m channels at F lines, m/s per N and the like; every channel is a port's freedom.

    Y is taken as it was measured but for reciprocity: the mean of Y_ab and Y_ba. Between two lines the accelerance
    i w Y is the straight line between them: passive where the data are, and exact for rigid-body motion. Off the band
    nothing is known. `tolerance` and `modes` are those of the fit that stands for it in time (`gearpath.fitting`).
    Equal to any other of the same content.
    """

    omega: Real  # (F,), rad/s, increasing
    mobility: Complex  # (F, m, m), as measured
    ports: Mapping[str, Mapping[str, int]]  # port -> degree of freedom, such as "uy" -> its channel
    places: Mapping[str, Vector] = field(default_factory=dict)  # m, of ports whose place is known
    tolerance: float = 1e-3
    modes: int | None = None

    @property
    def channels(self) -> int:
        """Number of channels m."""
        return int(self.mobility.shape[1])

    @property
    def band(self) -> tuple[float, float]:
        """First and last line, Hz."""
        return float(self.omega[0] / (2.0 * np.pi)), float(self.omega[-1] / (2.0 * np.pi))

    @cached_property
    def reciprocal(self) -> Complex:
        """Mean of Y_ab and Y_ba, (F, m, m)."""
        return np.asarray((self.mobility + self.mobility.swapaxes(1, 2)) / 2.0)

    def position(self, port: str) -> Vector | None:
        """Place of a port, m; None where it is not known."""
        return self.places.get(port)

    def at(self, omega: Real) -> Complex:
        """Y at `omega` (rad/s), (m, m, F), the line last. Raises InputError off the measured band."""
        low, high = self.omega[0] * (1.0 - _EDGE), self.omega[-1] * (1.0 + _EDGE)
        if omega.size and not (low <= omega.min() and omega.max() <= high):
            off = float(omega.min() if omega.min() < low else omega.max()) / (2.0 * np.pi)
            raise InputError(
                f"frequencies: {off:g} Hz is outside {self.band[0]:g} to {self.band[1]:g} Hz, where a component was "
                "measured; stay within"
            )
        right = np.clip(np.searchsorted(self.omega, omega), 1, len(self.omega) - 1)
        left = right - 1
        share = np.clip((omega - self.omega[left]) / (self.omega[right] - self.omega[left]), 0.0, 1.0)[:, None, None]
        before, after = (self.omega[k] / omega for k in (left, right))
        lines = (1.0 - share) * before[:, None, None] * self.reciprocal[left]
        lines += share * after[:, None, None] * self.reciprocal[right]
        return np.ascontiguousarray(np.moveaxis(lines, 0, -1))

    def structure(
        self, dofs: Sequence[str], ports: Mapping[str, str | Vector], probes: Mapping[str, str | Vector] | None = None
    ) -> Structure:
        """Its channels as the coordinates, with the rows of each of ports and probes, which name ports.

        Mass and stiffness are those of nothing (unit mass, free): the network takes the mobilities or their fit.
        """
        unit = np.eye(self.channels)
        shapes = {name: {dof: unit[k] for dof, k in channels.items()} for name, channels in self.ports.items()}
        rows = {key: named_rows(shapes, port, dofs, self.channels) for key, port in {**ports, **(probes or {})}.items()}
        return Structure(unit, np.zeros_like(unit), unit, 0.0, rows)

    @cached_property
    def _digest(self) -> bytes:
        plain = (
            sorted((name, sorted(dofs.items())) for name, dofs in self.ports.items()),
            sorted(self.places.items()),
            self.tolerance,
            self.modes,
            self.mobility.shape,
        )
        content = hashlib.sha256(repr(plain).encode())
        content.update(np.ascontiguousarray(self.omega).tobytes())
        content.update(np.ascontiguousarray(self.mobility).tobytes())
        return content.digest()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Measured) and self._digest == other._digest

    def __hash__(self) -> int:
        return hash(self._digest)
