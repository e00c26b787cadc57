"""The network in modal coordinates: what the synthesis, the time twin and the FMUs are computed from."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ..components import Measured
from ..numerics.arrays import Real
from .measured import fitted
from .records import JointRows, Load, MeshSource, Output, Schedule


@dataclass(frozen=True)
class JoinedLosses:
    """i eta K of components of different loss factors that move as one: i (eta L + E^T E) on the joined modes."""

    loss_factor: float  # the least of them, eta
    rows: Real  # E (k, N), (rad/s)


@dataclass(frozen=True)
class ModalNetwork:
    """All components in their own free-free modes, N in all, mass-normalised, and the joints between them.

    Uncoupled: q'' + X q' + (1 + i eta) L q = f with L = diag(eigenvalues), X = diag(2 zeta sqrt(L)) (Eq. 11b, 11c).
    Dashpots inside a component couple its modes: X + D^T D. To the synthesis they are joints to nowhere, which stand
    behind the joints in the stacked interface. No transmission error moves them, D d = 0.
    """

    name: str
    components: Mapping[str, slice]  # name -> its modes
    modal_damping: Mapping[str, float]  # component -> zeta of its elastic modes; only those that have elastic modes
    eigenvalues: Real  # (N,), (rad/s)^2, exactly zero for rigid-body modes
    joints: tuple[JointRows, ...]  # rows on the N modal coordinates
    loads: tuple[Load, ...]
    outputs: tuple[Output, ...]
    excitation: str  # the load that power ratios and frf outputs refer to
    paths: tuple[str, ...]  # joints that count as power flow paths (Network.paths)
    loss_factors: Mapping[str, float] = field(default_factory=dict)  # component -> eta, where it is not 0
    measured: Mapping[str, Measured] = field(default_factory=dict)  # component -> its mobilities; modes: its channels
    band: float = np.inf  # Hz, up to where components that were reduced to their band are exact
    loss_frequency: float = 1000.0  # Hz, where loss factors of joints and their viscous equivalents agree
    source: MeshSource | None = None  # of FMUs only: everything else takes the excitation as an input
    schedule: Schedule | None = None  # of FMUs only: everything else takes the joints as they are
    damping_shares: Mapping[str, Real] = field(default_factory=dict)  # component -> rho (N,), where not 1 on its modes
    loss_shares: Mapping[str, Real] = field(default_factory=dict)  # the same of loss factors
    dashpots: Mapping[str, Real] = field(default_factory=dict)  # component -> D (k, N), (N s/m)^0.5 ...
    joined_losses: Mapping[str, JoinedLosses] = field(default_factory=dict)  # group -> what replaces shares of eta
    decided: frozenset[str] = frozenset()  # of FMUs only: matrices, as bearing_1.stiffness, that their design decides

    def damping_share(self, name: str) -> Real:
        """rho (N,): the part of a component's damping ratio that each mode takes.

        1 on the component's own modes, unless they have ratios of their own (then relative to the component's) or
        are those of several components that move as one.
        """
        return self.damping_shares[name] if name in self.damping_shares else self._own(name)

    def loss_share(self, name: str) -> Real:
        """rho (N,): the part of a component's loss factor that each mode takes; 1 on its own modes."""
        return self.loss_shares[name] if name in self.loss_shares else self._own(name)

    def _own(self, name: str) -> Real:
        share = np.zeros_like(self.eigenvalues)
        share[self.components[name]] = 1.0
        return share

    @property
    def damping(self) -> Real:
        """Diagonal of X, 2 sqrt(L) sum_c zeta_c rho_c, (N,), rad/s."""
        ratios = np.zeros_like(self.eigenvalues)
        for name, zeta in self.modal_damping.items():
            ratios += zeta * self.damping_share(name)
        return np.asarray(2.0 * ratios * np.sqrt(self.eigenvalues))

    @property
    def hysteresis(self) -> Real:
        """eta L of every mode, L sum_c eta_c rho_c, (N,), (rad/s)^2: what loss factors add, imaginary."""
        factors = np.zeros_like(self.eigenvalues)
        for name, eta in self.loss_factors.items():
            factors += eta * self.loss_share(name)
        for name, losses in self.joined_losses.items():
            factors[self.components[name]] = losses.loss_factor
        return factors * self.eigenvalues

    @property
    def has_loss_factors(self) -> bool:
        """Whether any component or joint has a loss factor, which has no causal form in time."""
        return bool(self.loss_factors) or any(joint.loss_factor for joint in self.joints)

    def viscous(self) -> "ModalNetwork":
        """The network with viscous damping in place of loss factors: what can be simulated in time.

        A measured component becomes the modes of its fit.
        A mode gets zeta = eta / 2, which dissipates alike at its own frequency; a joint C + eta K / w, alike at
        `loss_frequency`.
        """
        if self.measured:
            return fitted(self).viscous()
        if not self.has_loss_factors:
            return self
        w = 2.0 * np.pi * self.loss_frequency
        ratios = {name: zeta + self.loss_factors.get(name, 0.0) / 2.0 for name, zeta in self.modal_damping.items()}
        shares = dict(self.damping_shares)
        for name in {*self.damping_shares, *self.loss_shares} & set(self.loss_factors) & set(ratios):
            zeta, eta = self.modal_damping[name], self.loss_factors[name]
            mixed = zeta * self.damping_share(name) + eta / 2.0 * self.loss_share(name)
            shares[name] = np.asarray(mixed / ratios[name])
        joints = tuple(
            replace(j, damping=j.damping + j.loss_factor / w * j.stiffness, loss_factor=0.0) for j in self.joints
        )
        return replace(
            self,
            modal_damping=ratios,
            joints=joints,
            damping_shares=shares,
            loss_factors={},
            loss_shares={},
            joined_losses={},
            schedule=self._viscous_schedule(1.0 / w),
        )

    def _viscous_schedule(self, time: float) -> Schedule | None:
        """The schedule where a loss factor eta makes C + eta time K of a joint: C then follows K."""
        if self.schedule is None:
            return None
        damping = dict(self.schedule.damping)
        for joint in self.joints:
            K = self.schedule.stiffness.get(joint.name)
            if K is not None and joint.loss_factor:
                damping[joint.name] = damping.get(joint.name, joint.damping) + joint.loss_factor * time * K
        return replace(self.schedule, damping=damping)

    def at_torque(self, torque: float) -> "ModalNetwork":
        """The network with the matrices of its schedule at a torque (N m); the components stay solved."""
        if self.schedule is None:
            return self
        K, C = self.schedule.at(torque)
        joints = tuple(
            replace(j, stiffness=K.get(j.name, j.stiffness), damping=C.get(j.name, j.damping)) for j in self.joints
        )
        return replace(self, joints=joints)

    @property
    def relative(self) -> Real:
        """P = B Phi, (n_p, N): relative motion of every joint degree of freedom; then D of dashpots, E of losses."""
        losses = [item.rows for item in self.joined_losses.values()]
        return np.vstack([*(joint.relative for joint in self.joints), *self.dashpots.values(), *losses])

    def joint_slices(self) -> dict[str, slice]:
        """Where each joint's degrees of freedom stand in the stacked interface."""
        ends = np.cumsum([len(joint.dofs) for joint in self.joints])
        return {j.name: slice(int(end) - len(j.dofs), int(end)) for j, end in zip(self.joints, ends)}

    def dashpot_slices(self) -> dict[str, slice]:
        """Where the dashpots inside each component stand in the stacked interface."""
        return _following(sum(len(joint.dofs) for joint in self.joints), self.dashpots)

    def loss_slices(self) -> dict[str, slice]:
        """Where the losses of joined components stand in the stacked interface, behind everything else."""
        start = sum(len(joint.dofs) for joint in self.joints) + sum(map(len, self.dashpots.values()))
        return _following(start, {name: losses.rows for name, losses in self.joined_losses.items()})

    def interface_hysteresis(self) -> Real:
        """H of every interface row, (n_p,), whose force is H / w of its velocity: 1 of losses, 0 of others."""
        found = np.zeros(len(self.relative))
        for rows in self.loss_slices().values():
            found[rows] = 1.0
        return found

    def interface_matrices(self) -> tuple[Real, Real]:
        """Block-diagonal K and C of all joints and dashpots, (n_p, n_p) each."""
        size = len(self.relative)
        K, C = np.zeros((size, size)), np.zeros((size, size))
        for joint, rows in zip(self.joints, self.joint_slices().values()):
            K[rows, rows], C[rows, rows] = joint.stiffness, joint.damping
        for rows in self.dashpot_slices().values():
            C[rows, rows] = np.eye(rows.stop - rows.start)
        return K, C

    def joint_losses(self) -> Real:
        """Loss factor of every interface row, (n_p,)."""
        losses = np.zeros(len(self.relative))
        for joint, rows in zip(self.joints, self.joint_slices().values()):
            losses[rows] = joint.loss_factor
        return losses

    def with_joint(self, name: str, stiffness: Real, damping: Real) -> "ModalNetwork":
        """The same network with one joint exchanged; the components stay solved."""
        joints = tuple(replace(j, stiffness=stiffness, damping=damping) if j.name == name else j for j in self.joints)
        return replace(self, joints=joints)


def _following(start: int, rows: Mapping[str, Real]) -> dict[str, slice]:
    """Where rows stand that follow each other from `start`."""
    ends = start + np.cumsum([len(item) for item in rows.values()])
    return {name: slice(int(end) - len(item), int(end)) for (name, item), end in zip(rows.items(), ends)}
