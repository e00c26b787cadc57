"""Linear least squares over many lines, condensed to triangles so that memory does not grow with the lines."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..numerics.arrays import Complex, Real

_LOST = 1e-9  # singular values below this part of the largest: directions that the equations do not see


@dataclass(frozen=True)
class Squares:
    """minimise |b + A x|^2, A and b complex, x real: A = Q R, every column of A scaled to unit length.

    `b` holds noise of unit variance E|e|^2 = 1, or of one unknown variance.
    """

    triangle: Real  # (q, q): R of the scaled columns
    rest: Real  # (q,): Q^T b
    remainder: float  # |b|^2 - |Q^T b|^2
    size: Real  # (q,): lengths of the columns
    equations: int  # complex ones

    @classmethod
    def of(cls, blocks: Iterable[tuple[Complex, Complex]]) -> Squares:
        """From blocks A (rows, q) and b (rows,)."""
        rows, count = [], 0
        for A, b in blocks:
            both = np.column_stack([A, b])
            rows.append(np.asarray(np.linalg.qr(np.concatenate([both.real, both.imag]), mode="r")))
            count += len(b)
        R: Real = np.asarray(np.linalg.qr(np.concatenate(rows), mode="r"))
        q = R.shape[1] - 1
        size = np.linalg.norm(R[:, :q], axis=0)
        size[size == 0.0] = 1.0
        return cls(R[:q, :q] / size, R[:q, q], float(np.sum(R[q:, q] ** 2)), size, count)

    @property
    def freedom(self) -> int:
        """Real equations more than unknowns that they determine."""
        return 2 * self.equations - self.rank

    @property
    def rank(self) -> int:
        """How many combinations of the unknowns the equations determine."""
        values = np.linalg.svd(self.triangle, compute_uv=False)
        return int(np.count_nonzero(values > _LOST * values[0]))

    @property
    def condition(self) -> float:
        """Condition number of the scaled columns, lost directions left out."""
        values = np.linalg.svd(self.triangle, compute_uv=False)
        return float(values[0] / values[self.rank - 1])

    def solution(self) -> Real:
        """x, the shortest in scaled unknowns where it is not unique."""
        return np.asarray(-(np.linalg.pinv(self.triangle, rcond=_LOST) @ self.rest) / self.size)

    def left(self, x: Real | None = None) -> float:
        """|b + A x|^2, at the solution for None."""
        if x is not None:
            return self.remainder + float(np.sum((self.rest + self.triangle @ (self.size * x)) ** 2))
        return self.left(self.solution())

    def noise(self) -> float:
        """sqrt(E|e|^2) that the solution leaves in b; 0 where nothing is left over to tell it."""
        return float(np.sqrt(2.0 * self.left() / self.freedom)) if self.freedom > 0 else 0.0

    def covariance(self) -> Real:
        """Covariance (q, q) of x for E|e|^2 = 1, without the lost directions."""
        inverse = np.linalg.pinv(self.triangle, rcond=_LOST) / self.size[:, None]
        return np.asarray(0.5 * inverse @ inverse.T)

    def moves(self) -> Real:
        """(q, q): how x moves, by column, while one of it moves by its standard deviation for E|e|^2 = 1."""
        covariance = self.covariance()
        deviation = np.sqrt(np.diagonal(covariance))
        return np.asarray(covariance / np.where(deviation > 0.0, deviation, 1.0))

    def lost(self) -> NDArray[np.bool_]:
        """(q,): which unknowns take part in a direction that the equations do not see."""
        _, values, Vh = np.linalg.svd(self.triangle)
        return np.asarray((np.abs(Vh[values <= _LOST * values[0]]) > 1e-6).any(axis=0))

    def small(self, step: Real, x: Real, part: float) -> bool:
        """Whether a step is no more than a part of x, in what it does to the equations."""
        return bool(np.linalg.norm(self.size * step) <= part * np.linalg.norm(self.size * x))
