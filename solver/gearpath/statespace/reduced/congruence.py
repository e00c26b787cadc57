"""Reduction by congruence: every component on a few coordinates of its own, V = W real, the joints untouched.

    q = V r,   V^T V = I,   V^T L V = diag(mu):    r'' + X_r r' + diag(mu) r = V^T (f - P^T g),   g = K P V r + C P V r'

Mass, stiffness and damping stay symmetric and positive semidefinite, so that the reduced network is as passive as the
complete one for any order, and K and C of the joints stay what they are: tunable.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
import scipy.linalg

from ...network.modal import ModalNetwork
from ...network.records import Load
from ...numerics.arrays import Real


@dataclass(frozen=True)
class Basis:
    """The coordinates that a component keeps: n modes on k shapes, its own modes or blends of them."""

    shapes: Real  # V (n, k), orthonormal columns
    eigenvalues: Real  # mu (k,), (rad/s)^2: V^T L V is their diagonal
    shares: Mapping[str, Real] = field(default_factory=dict)  # rho (k,) of each damping ratio; none: diag(V^T X V)


def blended(eigenvalues: Real, shapes: Real) -> Basis:
    """The basis of the span of orthonormal `shapes` (n, k) in which L is diagonal."""
    mu, T = scipy.linalg.eigh(shapes.T @ (eigenvalues[:, None] * shapes))
    return Basis(shapes @ T, np.maximum(mu, 0.0))


def whole(eigenvalues: Real) -> Basis:
    """All modes of a component, as they are."""
    return Basis(np.eye(len(eigenvalues)), eigenvalues)


def congruent(network: ModalNetwork, bases: Mapping[str, Basis]) -> ModalNetwork:
    """The network of viscous damping on these coordinates of its components.

    Where a basis has no shares of its own, a blend of modes keeps the diagonal of V^T X V.
    """
    V = scipy.linalg.block_diag(*(bases[name].shapes for name in network.components))
    ends = np.cumsum([len(bases[name].eigenvalues) for name in network.components])
    mu = np.concatenate([bases[name].eigenvalues for name in network.components])

    def load(item: Load) -> Load:
        d = None if item.mesh_displacement is None else item.mesh_displacement @ V
        return replace(item, column=item.column @ V, mesh_displacement=d)

    return replace(
        network,
        components={
            name: slice(int(end) - len(bases[name].eigenvalues), int(end))
            for name, end in zip(network.components, ends)
        },
        eigenvalues=mu,
        damping_shares={name: _shares(network, name, bases) for name in network.modal_damping},
        dashpots={name: D @ V for name, D in network.dashpots.items()},
        joints=tuple(replace(j, source=j.source @ V, receiver=j.receiver @ V) for j in network.joints),
        loads=tuple(load(item) for item in network.loads),
        outputs=tuple(replace(o, row=None if o.row is None else o.row @ V) for o in network.outputs),
    )


def _shares(network: ModalNetwork, ratio: str, bases: Mapping[str, Basis]) -> Real:
    """Shares of one damping ratio that the kept coordinates of all components take, (k,)."""
    share = network.damping_share(ratio) * np.sqrt(network.eigenvalues)
    parts = []
    for name, block in network.components.items():
        basis = bases[name]
        damped = share[block] @ basis.shapes**2
        diagonal = np.divide(
            damped, np.sqrt(basis.eigenvalues), out=np.zeros_like(damped), where=basis.eigenvalues > 0.0
        )
        parts.append(basis.shares.get(ratio, diagonal))
    return np.concatenate(parts)


def component_rows(network: ModalNetwork, name: str) -> Real:
    """What joints, loads and outputs see of a component, (m, n): rows that are not 0, each once, of unit length.

    Motions d of transmission errors are among them. K and C of the joints are not, so that a basis made of these
    serves any joint.
    """
    block = network.components[name]
    seen = [rows for joint in network.joints for rows in (joint.source, joint.receiver)]
    seen += [item.column[None] for item in network.loads]
    seen += [item.mesh_displacement[None] for item in network.loads if item.mesh_displacement is not None]
    seen += [output.row[None] for output in network.outputs if output.row is not None]
    rows = np.vstack(seen)[:, block]
    length = np.linalg.norm(rows, axis=1)
    rows = rows[length > 0.0] / length[length > 0.0, None]
    kept: list[int] = []
    for i, row in enumerate(rows):
        if all(abs(rows[k] @ row) < 1.0 - 1e-12 for k in kept):
            kept.append(i)
    return np.asarray(rows[kept])
