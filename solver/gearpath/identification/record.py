"""What an identification returns: K and C of every joint with their uncertainty, and how far to trust them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..numerics.arrays import Real

NORMAL_95 = 1.959963984540054


@dataclass(frozen=True)
class IdentifiedJoint:
    """K and C of one joint on its d degrees of freedom; SI units, N/m, N/rad, N m/rad and these times s.

    Estimates are unbiased and may have negative eigenvalues where noise is as large as they are; `passive_*` are the
    likeliest positive semidefinite matrices, for models.
    """

    dofs: tuple[str, ...]
    stiffness: Real  # (d, d)
    damping: Real  # (d, d)
    stiffness_error: Real  # (d, d), standard errors; infinite where the measurement does not tell the entry
    damping_error: Real  # (d, d)
    passive_stiffness: Real  # (d, d)
    passive_damping: Real  # (d, d)

    def stiffness_interval(self) -> tuple[Real, Real]:
        """Lower and upper end of the 95 % confidence interval of every entry of K."""
        return self.stiffness - NORMAL_95 * self.stiffness_error, self.stiffness + NORMAL_95 * self.stiffness_error

    def damping_interval(self) -> tuple[Real, Real]:
        """Lower and upper end of the 95 % confidence interval of every entry of C."""
        return self.damping - NORMAL_95 * self.damping_error, self.damping + NORMAL_95 * self.damping_error


@dataclass(frozen=True)
class CrossTalk:
    """What stiffness between different joints the same measurement asks for: none, where it is complete."""

    value: float  # largest |K_ij| / sqrt(|K_ii K_jj|) of different joints
    pair: tuple[str, str]  # where
    probability: float  # of at least so much where there is none; near 0: something else connects the parts


@dataclass(frozen=True)
class JointIdentification:
    """Joints identified in situ.

    noise is the relative noise of a single FRF that the fit leaves over, misfit its ratio to the noise known beforehand
    (given, or shown by Y_ij - Y_ji): near 1 the model explains the data, above it something else is in them.
    """

    joints: Mapping[str, IdentifiedJoint]
    noise: float
    misfit: float | None  # None where nothing tells the noise beforehand
    lines: int  # used
    discarded: Mapping[float, str]  # Hz -> why the line is not used
    band: tuple[float, float]  # Hz, of the lines used
    condition: float  # of the scaled equations; above 1e4 some combination of entries is poorly seen
    undetermined: tuple[str, ...]  # entries that no amount of such data determines, such as "bearing_1.stiffness[1,2]"
    cross_talk: CrossTalk | None  # None for a single joint
    covariance: Real  # (2 m, 2 m) of K's and then C's upper triangles, linearised: without the widening of bend.py
    notes: tuple[str, ...]

    def changes(self) -> dict[str, list[list[float]]]:
        """The passive matrices as changes of a model: `model.replace(found.changes())`."""
        out: dict[str, list[list[float]]] = {}
        for name, joint in self.joints.items():
            out[f"joints.{name}.stiffness"] = joint.passive_stiffness.tolist()
            out[f"joints.{name}.damping"] = joint.passive_damping.tolist()
        return out

    def __str__(self) -> str:
        text = [f"{'joint':12} {'entry':8} {'K':>12} {'+- (95 %)':>11} {'C':>12} {'+- (95 %)':>11}"]
        for name, joint in self.joints.items():
            for i, j in zip(*np.triu_indices(len(joint.dofs))):
                K, C = joint.stiffness[i, j], joint.damping[i, j]
                dK, dC = NORMAL_95 * joint.stiffness_error[i, j], NORMAL_95 * joint.damping_error[i, j]
                entry = f"{joint.dofs[i]},{joint.dofs[j]}"
                text.append(f"{name:12} {entry:8} {K:12.5g} {dK:11.2g} {C:12.4g} {dC:11.2g}")
        text.append(
            f"{self.lines} lines from {self.band[0]:.4g} to {self.band[1]:.4g} Hz, {len(self.discarded)} discarded; "
            f"noise {self.noise:.2g} of each FRF; condition {self.condition:.3g}"
        )
        return "\n".join([*text, *(f"- {note}" for note in self.notes)])
