"""Damping of components that rigid joints hold together.

Where a component has one damping ratio, each joined mode takes its part of the strain energy of it (composite damping),

    rho'_cr = sum_k rho_ck L_k T_kr^2 / mu_r,    zeta_r = sum_c zeta_c rho'_cr.

Where each of its modes has a ratio of its own, or dashpots couple them, its damping is a matrix, and stays that matrix:
T^T (X + D^T D) T, in ratios of the joined modes and dashpots between them. Gears keep composite damping, for a
transmission error that acted on dashpots would act with its derivative.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..components import split_damping
from ..errors import InputError
from ..numerics.arrays import Real
from .modal import ModalNetwork
from .rigid import Group


def joined_damping(
    network: ModalNetwork, found: Sequence[Group], T: Real, blocks: Mapping[str, slice], mu: Real
) -> tuple[dict[str, Real], dict[str, Real]]:
    """Shares rho' (n,) of the damping ratios whose component moves with others, and dashpots (k, n) by group.

    T (N, n) are the modes of the groups, of eigenvalues mu and in `blocks`. Raises InputError for gears on dashpots.
    """
    shares, dashpots = {}, {}
    for group in found:
        block, rows = blocks[group.name], [np.zeros((0, len(mu)))]
        for name in group.components:
            if group.joints and _is_matrix(network, name) and not has_gears(network, group):
                own, inside = _matrix(network, name, T[:, block], mu[block])
                shares[name], D = np.zeros(len(mu)), np.zeros((len(inside), len(mu)))
                shares[name][block], D[:, block] = own, inside
                rows.append(D)
                continue
            if name in network.modal_damping and (group.joints or name in network.damping_shares):
                shares[name] = composite(network.damping_share(name) * network.eigenvalues, T, mu)
            if name in network.dashpots:
                rows.append(network.dashpots[name] @ T)
                _check_gears(network, group, name)
        if len(D := np.vstack(rows)):
            dashpots[group.name] = D
    return shares, dashpots


def composite(energy: Real, T: Real, mu: Real) -> Real:
    """rho' (n,) of the joined modes, by the part of their strain energy; `energy` is rho L (N,)."""
    return np.divide(energy @ T**2, mu, out=np.zeros_like(mu), where=mu > 0.0)


def _is_matrix(network: ModalNetwork, name: str) -> bool:
    """Whether a component's viscous damping is a matrix of its own."""
    return name in network.damping_shares or name in network.dashpots


def has_gears(network: ModalNetwork, group: Group) -> bool:
    """Whether a transmission error moves any component of a group."""
    moved = [load.mesh_displacement for load in network.loads if load.mesh_displacement is not None]
    return any(d[network.components[name]].any() for d in moved for name in group.components)


def _matrix(network: ModalNetwork, name: str, T: Real, mu: Real) -> tuple[Real, Real]:
    """Shares of the component's damping ratio (n,), and dashpots (k, n), that together are its damping matrix."""
    zeta = network.modal_damping.get(name, 0.0)
    x = 2.0 * zeta * network.damping_share(name) * np.sqrt(network.eigenvalues)
    D = network.dashpots.get(name, np.zeros((0, len(x)))) @ T
    X = T.T @ (x[:, None] * T) + D.T @ D
    split = split_damping((X + X.T) / 2.0, mu)
    if zeta > 0.0:
        size = 2.0 * zeta * np.sqrt(mu)
        return np.divide(split.own, size, out=np.zeros_like(mu), where=mu > 0.0), split.dashpots
    return np.zeros_like(mu), np.vstack([split.dashpots, np.diag(np.sqrt(split.own))[split.own > 0.0]])


def _check_gears(network: ModalNetwork, group: Group, name: str) -> None:
    """Dashpots on gears, even by rigid joints, are refused."""
    if group.joints and has_gears(network, group):
        raise InputError(
            f"joints.{group.joints[0]}: a gear mesh would act straight on the damping matrix of {name}; give "
            "modal_damping instead of the matrix, or a stiff bearing instead of the rigid joint"
        )
