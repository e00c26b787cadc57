"""Loss factors of components that rigid joints hold together: exact in frequency.

    sum_c eta_c T_c^T L_c T_c = eta diag(mu) + E^T E,    eta = min eta_c,    E_c = sqrt((eta_c - eta) L_c) T_c

for sum_c T_c^T L_c T_c = diag(mu). In time, and beside gears, each joined mode takes of eta_c the part of its strain
energy that is in the component, as of damping ratios.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..numerics.arrays import Real
from .joined_damping import composite, has_gears
from .modal import JoinedLosses, ModalNetwork
from .rigid import Group


def joined_losses(
    network: ModalNetwork, found: Sequence[Group], T: Real, mu: Real
) -> tuple[dict[str, Real], dict[str, JoinedLosses]]:
    """Shares rho' (n,) of the loss factors, and what replaces them in frequency by group.

    T (N, n) are the modes of the groups, of eigenvalues mu.
    """
    shares, exact = {}, {}
    for group in found:
        if not group.joints:
            continue
        elastic = [name for name in group.components if network.eigenvalues[network.components[name]].any()]
        factors = {name: network.loss_factors.get(name, 0.0) for name in elastic}
        for name in group.components:
            if name in network.loss_factors:
                shares[name] = composite(network.loss_share(name) * network.eigenvalues, T, mu)
        if len(set(factors.values())) > 1 and not has_gears(network, group):
            least = min(factors.values())
            rows = [
                np.sqrt((eta - least) * network.eigenvalues[network.components[name]])[:, None]
                * T[network.components[name]]
                for name, eta in factors.items()
                if eta > least
            ]
            E = np.vstack(rows)
            exact[group.name] = JoinedLosses(least, E[E.any(axis=1)])
    return shares, exact
