"""Rational Krylov by congruence: modes of the band, and what the others answer at shifts in the band.

    V = [modes below f_2,  d_h,  span of (L_h - s_k^2)^-1 R_h^T],      s_k real shifts at Chebyshev points of the band

R_h are all rows that joints, loads and outputs see, on the modes h above the band. Each component's span is taken by
its singular values, so that directions come in the order of what they contribute. At a resonance in the band the Krylov
vector is the mode itself, hence the first part. The motion d of a transmission error is part of the answer itself, not
only a load: P d = 0 has to stay. (Grimme 1997; structure-preserving: Bai and Su 2005.)
"""

from functools import cached_property

import numpy as np
import scipy.linalg

from ...network.modal import ModalNetwork
from ...numerics.arrays import Real
from .congruence import Basis, blended, component_rows, whole
from .damping import blend_shares

Mask = np.ndarray[tuple[int], np.dtype[np.bool_]]
Places = np.ndarray[tuple[int], np.dtype[np.intp]]
_SHIFTS = 8
_EQUAL = 1e-6  # relative difference of what a symmetric machine makes equal
_ROUNDING = 1e-14  # singular values below this part of the largest are noise
_ALONE = 1e-9  # motions d that the modes of the band hold but for this part need no vector
_APART = 1e-9  # a shift closer to a mode than this part of its eigenvalue is moved away by as much


class RationalKrylov:
    """All orders of rational Krylov bases over a band (Hz), each containing those before it."""

    def __init__(self, network: ModalNetwork, band: tuple[float, float]) -> None:
        self.network = network
        low, high = (2.0 * np.pi * f for f in band)
        nodes = np.cos(np.pi * (2 * np.arange(_SHIFTS) + 1) / (2 * _SHIFTS))
        self._shifts = (low + high) / 2.0 + (high - low) / 2.0 * nodes
        self._highest = high**2

    @cached_property
    def _parts(self) -> dict[str, tuple[Places, Real, Real]]:
        """Component -> which modes lie in the band, the other vectors (n, m), and their weights (m,), inf for d."""
        return {name: self._part(name) for name in self.network.components}

    def _part(self, name: str) -> tuple[Places, Real, Real]:
        block = self.network.components[name]
        L = self.network.eigenvalues[block]
        above = self._highest < L
        rows = component_rows(self.network, name)[:, above]
        if not above.any() or not len(rows):
            return np.flatnonzero(~above), np.zeros((len(L), 0)), np.zeros(0)
        gap = L[above] - self._shifts[:, None] ** 2
        gap = np.where(abs(gap) < _APART * L[above], _APART * L[above], gap)
        # a row counts by what it moves of the modes above, relative to the row itself
        snapshots = (rows * self._highest / gap[:, None, :]).reshape(-1, rows.shape[1]).T
        spins = self._spins(block, above)
        U, weights, _ = scipy.linalg.svd(snapshots - spins @ (spins.T @ snapshots), full_matrices=False)
        kept = weights > _ROUNDING * max(weights[0], np.finfo(float).tiny)
        vectors, _ = scipy.linalg.qr(np.hstack([spins, U[:, kept]]), mode="economic")  # the last are nearly rounding
        full = np.zeros((len(L), vectors.shape[1]))
        full[above] = vectors
        weights = np.concatenate([np.full(spins.shape[1], np.inf), weights[kept]])
        return np.flatnonzero(~above), full, np.asarray(weights[: vectors.shape[1]])

    def _spins(self, block: slice, above: Mask) -> Real:
        """What modes above the band have of the motions d of transmission errors, orthonormal, (modes above, k)."""
        moved = [load.mesh_displacement[block] for load in self.network.loads if load.mesh_displacement is not None]
        if not moved:
            return np.zeros((int(above.sum()), 0))
        d = np.column_stack(moved)
        U, values, _ = scipy.linalg.svd(d[above], full_matrices=False)
        return np.asarray(U[:, values > _ALONE * max(float(np.linalg.norm(d)), np.finfo(float).tiny)])

    @cached_property
    def _ranking(self) -> list[tuple[float, float, str]]:
        """Every coordinate as (class, rank, component): modes of the band by frequency, then vectors by weight."""
        entries = []
        for name, (modes, _, weights) in self._parts.items():
            L = self.network.eigenvalues[self.network.components[name]]
            entries += [(0.0, float(L[i]), name) for i in modes]
            entries += [(1.0, -float(weight), name) for weight in weights]
        return sorted(entries)

    @property
    def least(self) -> int:
        """The smallest order that is worth a try: all modes of the band."""
        return max(1, sum(kind == 0.0 for kind, _, _ in self._ranking))

    @property
    def most(self) -> int:
        """The largest order: that of the complete network."""
        return len(self.network.eigenvalues)

    def _without_ties(self, order: int) -> int:
        """`order`, or less where it would part coordinates that a symmetry of the machine makes equal.

        Which of them came first would be rounding, and the model not the same twice. More where there is no less.
        """
        fewer, more = order, order
        while 0 < fewer < len(self._ranking) and self._are_equal(fewer):
            fewer -= 1
        while 0 < more < len(self._ranking) and self._are_equal(more):
            more += 1
        return fewer or more

    def _are_equal(self, place: int) -> bool:
        """Whether the coordinates before and behind a place of the ranking are equal."""
        (kind, last, _), (next_kind, following, _) = self._ranking[place - 1 : place + 1]
        return kind == next_kind and abs(last - following) <= _EQUAL * abs(last)

    def bases(self, order: int) -> dict[str, Basis]:
        """Bases of all components with `order` coordinates in all, or a few less; at the largest order all modes.

        Below it there are no more than the shifts tell apart in double precision.
        """
        if order >= self.most:
            blocks = self.network.components.items()
            return {name: whole(self.network.eigenvalues[block]) for name, block in blocks}
        chosen = self._ranking[: self._without_ties(order)]
        out = {}
        for name, (modes, vectors, _) in self._parts.items():
            L = self.network.eigenvalues[self.network.components[name]]
            own = [int(i) for i in modes[np.argsort(L[modes], kind="stable")]][
                : sum(k == 0.0 and n == name for k, _, n in chosen)
            ]
            blend = blended(L, vectors[:, : sum(k == 1.0 and n == name for k, _, n in chosen)])
            out[name] = Basis(
                np.hstack([np.eye(len(L))[:, own], blend.shapes]),
                np.concatenate([L[own], blend.eigenvalues]),
                self._shares(name, own, blend),
            )
        return out

    def _shares(self, name: str, own: list[int], blend: Basis) -> dict[str, Real]:
        """The modes keep their shares of each damping ratio, the blends damp the band as the modes above it do."""
        block = self.network.components[name]
        L, rows = self.network.eigenvalues[block], component_rows(self.network, name)
        above = self._highest < L
        out = {}
        for ratio in self.network.modal_damping:
            share = self.network.damping_share(ratio)[block]
            blends = blend.shapes[above]
            fitted = blend_shares(
                rows[:, above], L[above], share[above], blends, blend.eigenvalues, float(np.sqrt(self._highest))
            )
            out[ratio] = np.concatenate([share[own], fitted])
        return out
