"""The bases that rational Krylov is compared with: truncated free modes, and Craig-Bampton."""

from functools import cached_property

import numpy as np
import scipy.linalg

from ...network.modal import ModalNetwork
from ...numerics.arrays import Real
from .congruence import Basis, blended, component_rows


class FreeModes:
    """The lowest free-free modes of all components together (Eq. 7, truncated); no residual flexibility."""

    def __init__(self, network: ModalNetwork) -> None:
        self.network = network
        self._ranked = np.argsort(network.eigenvalues, kind="stable")
        self.least, self.most = 1, len(self._ranked)

    def bases(self, order: int) -> dict[str, Basis]:
        """Bases of all components with `order` modes in all."""
        chosen = np.zeros(self.most, bool)
        chosen[self._ranked[:order]] = True
        return {
            name: Basis(np.eye(len(chosen[block]))[:, chosen[block]], self.network.eigenvalues[block][chosen[block]])
            for name, block in self.network.components.items()
        }


class CraigBampton:
    """Constraint modes of all that joints, loads and outputs see of a component, and its lowest modes held there.

    On a component's own free-free modes, with rows R and L = diag(w^2): the held modes are those of L on the null space
    of R; the constraint modes span the rigid motions and L^-1 R^T f of all forces f that balance (R_rigid^T f = 0).
    (Craig and Bampton 1968.)
    """

    def __init__(self, network: ModalNetwork) -> None:
        self.network = network

    @cached_property
    def _parts(self) -> dict[str, tuple[Real, Real, Real]]:
        """Component -> constraint modes (n, m), held modes (n, n - m) and their eigenvalues (n - m,)."""
        return {name: self._part(name) for name in self.network.components}

    def _part(self, name: str) -> tuple[Real, Real, Real]:
        L = self.network.eigenvalues[self.network.components[name]]
        rows, rigid = component_rows(self.network, name), L == 0.0
        balanced = scipy.linalg.null_space(rows[:, rigid].T) if rigid.any() else np.eye(len(rows))
        flexible = np.divide(rows, L, out=np.zeros_like(rows), where=~rigid).T @ balanced
        size = np.linalg.norm(flexible, axis=0)
        constraint = scipy.linalg.orth(
            np.hstack([np.eye(len(L))[:, rigid], flexible[:, size > 0.0] / size[size > 0.0]])
        )
        held = scipy.linalg.null_space(rows) if len(rows) else np.eye(len(L))
        values, shapes = scipy.linalg.eigh(held.T @ (L[:, None] * held))
        return constraint, held @ shapes, values

    @cached_property
    def _ranking(self) -> list[tuple[float, str]]:
        """Held modes of all components by frequency."""
        return sorted((float(v), name) for name, (_, _, values) in self._parts.items() for v in values)

    @property
    def least(self) -> int:
        """Constraint modes alone."""
        return sum(constraint.shape[1] for constraint, _, _ in self._parts.values())

    @property
    def most(self) -> int:
        """Constraint modes and all held modes."""
        return self.least + len(self._ranking)

    def bases(self, order: int) -> dict[str, Basis]:
        """Bases of all components with `order` coordinates in all."""
        chosen = [name for _, name in self._ranking[: max(order - self.least, 0)]]
        out = {}
        for name, (constraint, held, _) in self._parts.items():
            vectors, _ = scipy.linalg.qr(np.hstack([constraint, held[:, : chosen.count(name)]]), mode="economic")
            out[name] = blended(self.network.eigenvalues[self.network.components[name]], vectors)
        return out
