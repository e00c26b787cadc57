"""The network in modal coordinates: what the synthesis, the time twin and the FMUs are computed from."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ..numerics.arrays import Real
from .records import JointRows, Load, Output


@dataclass(frozen=True)
class ModalNetwork:
    """All components in their own free-free modes, N in all, mass-normalised, and the joints between them.

    Uncoupled: q'' + X q' + L q = f with L = diag(eigenvalues), X = diag(2 zeta sqrt(L)) (Eq. 11b, 11c).
    """

    name: str
    components: Mapping[str, slice]  # name -> its modes
    modal_damping: Mapping[str, float]  # name -> zeta of its elastic modes; only components that have elastic modes
    eigenvalues: Real  # (N,), (rad/s)^2, exactly zero for rigid-body modes
    joints: tuple[JointRows, ...]  # rows on the N modal coordinates
    loads: tuple[Load, ...]
    outputs: tuple[Output, ...]
    excitation: str  # the load that power ratios and frf outputs refer to
    paths: tuple[str, ...]  # joints that count as power flow paths (Network.paths)

    @property
    def damping(self) -> Real:
        """Diagonal of X, (N,), rad/s."""
        zeta = np.zeros_like(self.eigenvalues)
        for name, ratio in self.modal_damping.items():
            zeta[self.components[name]] = ratio
        return 2.0 * zeta * np.sqrt(self.eigenvalues)

    @property
    def relative(self) -> Real:
        """P = B Phi, (n_p, N): relative motion of every joint degree of freedom, stacked."""
        return np.vstack([joint.relative for joint in self.joints])

    def joint_slices(self) -> dict[str, slice]:
        """Where each joint's degrees of freedom stand in the stacked interface."""
        ends = np.cumsum([len(joint.dofs) for joint in self.joints])
        return {j.name: slice(int(end) - len(j.dofs), int(end)) for j, end in zip(self.joints, ends)}

    def interface_matrices(self) -> tuple[Real, Real]:
        """Block-diagonal K and C of all joints, (n_p, n_p) each."""
        size = sum(len(joint.dofs) for joint in self.joints)
        K, C = np.zeros((size, size)), np.zeros((size, size))
        for joint, rows in zip(self.joints, self.joint_slices().values()):
            K[rows, rows], C[rows, rows] = joint.stiffness, joint.damping
        return K, C

    def with_joint(self, name: str, stiffness: Real, damping: Real) -> "ModalNetwork":
        """The same network with one joint exchanged; the components stay solved."""
        joints = tuple(replace(j, stiffness=stiffness, damping=damping) if j.name == name else j for j in self.joints)
        return replace(self, joints=joints)
