"""The records that the network is made of: plain arrays with names, in any one set of coordinates.

The same records describe the network in the components' physical coordinates (for the reference solution) and in
their modal coordinates (for the mobility synthesis, the time twin and the FMUs): only the width n of the rows differs.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ..numerics.arrays import Real

Quantity = Literal["displacement", "velocity", "acceleration", "force", "power"]


@dataclass(frozen=True)
class JointRows:
    """A massless vector spring-damper between two ports; its force g acts on the receiver, -g on the source."""

    name: str
    kind: str  # "bearing" | "mount"
    dofs: tuple[str, ...]  # the joint's degrees of freedom, d of them
    source: Real  # (d, n): motion of the first port = source @ q
    receiver: Real  # (d, n): motion of the second port; zero rows on the ground
    stiffness: Real  # (d, d), symmetric, positive semidefinite, N/m ...
    damping: Real  # (d, d), symmetric, positive semidefinite, N s/m ...
    scalar: bool = False  # whether the model file gives it as one number (a mount's axial stiffness)
    grounded: bool = False  # whether the receiver is the ground
    loss_factor: float = 0.0  # eta of (1 + i eta) K

    @property
    def relative(self) -> Real:
        """(d, n): the joint's relative motion, source minus receiver (the signed selection B of the design)."""
        return self.source - self.receiver


@dataclass(frozen=True)
class Load:
    """An input of the network: a generalised force, or the transmission error of a mesh.

    A force input u pushes with `column * u`. A transmission error e pushes with `-column * e''` on the
    coordinates without it, and column = M d of `MeshMotion`.
    """

    name: str  # the FMU variable, such as "mesh.force"
    unit: str
    column: Real  # (n,)
    mesh_displacement: Real | None = None  # d (n,) where the input is a transmission error, else None
    equivalent_mass: float = 0.0  # m_e, kg, where the input is a transmission error

    @property
    def is_transmission_error(self) -> bool:
        """Whether the input is a displacement inside a gear mesh."""
        return self.mesh_displacement is not None


@dataclass(frozen=True)
class Output:
    """An output of the network, linear in the motion and the joint forces except for a joint's power."""

    name: str  # the FMU variable, such as "bearing_1.force_uy"
    unit: str
    quantity: Quantity
    row: Real | None = None  # (n,) for displacement, velocity and acceleration
    joint: str | None = None  # for force and power
    dof: int = 0  # index into the joint's degrees of freedom, for force


@dataclass(frozen=True)
class Tone:
    """One tone of a gear mesh source: a cos((harmonic * teeth + shift) theta + phase), theta the shaft angle."""

    name: str  # the FMU variables begin with it, such as "mesh.harmonic_1"
    harmonic: float  # of the tooth meshing
    shift: float = 0.0  # orders of the shaft to the side: a sideband of a modulated harmonic
    amplitude: float = 0.0  # m
    phase: float = 0.0  # rad


@dataclass(frozen=True)
class MeshSource:
    """A transmission error that turns with the driving shaft, made inside an FMU and added to the input."""

    load: str  # the transmission error that it adds to
    speed: float  # rev/min, start value of the input
    teeth: int  # of the gear on the driving shaft
    tones: tuple[Tone, ...]


@dataclass(frozen=True)
class Schedule:
    """Matrices of joints over the torque through the machine, linear between the operating points.

    K(T) = (1 - s) K_i + s K_(i+1) with s = (T - T_i) / (T_(i+1) - T_i); beyond the first and the last point theirs.
    """

    torques: Real  # (T,), N m, increasing
    stiffness: Mapping[str, Real]  # joint -> (T, d, d)
    damping: Mapping[str, Real]  # joint -> (T, d, d), of joints whose damping follows their stiffness
    start: float | None = None  # N m, where an FMU begins; the first point where it is None or beyond the points

    @property
    def first(self) -> float:
        """The torque that an FMU begins with, N m."""
        inside = self.start is not None and self.torques[0] <= self.start <= self.torques[-1]
        return float(self.start if inside and self.start is not None else self.torques[0])

    def at(self, torque: float) -> tuple[dict[str, Real], dict[str, Real]]:
        """Stiffness and damping by joint at a torque (N m), (d, d) each; a convex combination of two points."""
        used = float(min(max(torque, self.torques[0]), self.torques[-1]))
        i = int(np.clip(np.searchsorted(self.torques, used, side="right") - 1, 0, len(self.torques) - 2))
        s = (used - self.torques[i]) / (self.torques[i + 1] - self.torques[i])
        stiffness, damping = (
            {name: np.asarray((1.0 - s) * table[i] + s * table[i + 1]) for name, table in tables.items()}
            for tables in (self.stiffness, self.damping)
        )
        return stiffness, damping
