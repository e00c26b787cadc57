"""Block Lanczos vectors: an M-orthonormal basis of a Krylov space, with full re-orthogonalisation."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg

from .arrays import Real

DEPENDENT = 1e-9  # a vector that keeps less than this part of its length beside the others adds no direction
_MASSLESS = 1e-14  # of the largest mass, each coordinate in units of its own: less is rounding
_EQUAL = 1e-3  # remainders closer than this, of mirror-image columns, are equal but for rounding: the first one counts


@dataclass(frozen=True)
class LanczosVectors:
    """M-orthonormal vectors V, V^T M V = I, in the order in which they were found."""

    vectors: Real  # (n, k)
    blocks: tuple[int, ...]  # vectors of each block; their sum is k
    exhausted: bool  # the Krylov space ended before the wanted number (breakdown): it is invariant, and complete


class BlockLanczos:
    """Vectors of span{X, P X, P^2 X, ...}, P = operator, self-adjoint in the inner product of `mass`; none twice.

    With P = K^-1 M and X = K^-1 F a Galerkin projection on j full blocks matches the first 2 j moments
    F^T (K^-1 M)^k K^-1 F at zero frequency (Nour-Omid and Clough 1984; Craig and Hale 1988). mass (n, n), dense or
    sparse, positive definite; start X (n, m); held (n, h), M-orthonormal, are vectors to be orthogonal to.

    Every column is made orthogonal to all earlier vectors twice (which is enough for rounding). Of a block the
    column with the largest remainder, relative to its own length, comes first (of equal ones the first), so that a
    block that is cut off keeps its most independent directions. Deflation: a column left with less than 1e-9 of
    its length is dropped and the blocks stay narrower; breakdown: when a whole block is dropped the space is invariant
    and ends. No random numbers: the same input gives the same vectors, in one go or in several.
    """

    def __init__(self, operator: Callable[[Real], Real], mass: Any, start: Real, held: Real | None = None) -> None:
        self._operator, self._mass, self._last = operator, mass, start
        self._vectors = np.zeros((len(start), 0)) if held is None else held
        self._momentum, self._first = np.asarray(mass @ self._vectors), self._vectors.shape[1]
        self._blocks: list[int] = []
        self._exhausted = False

    def take(self, count: int) -> LanczosVectors:
        """The first `count` vectors, fewer where the space ends before; those found earlier are not found again."""
        while sum(self._blocks) < count and not self._exhausted:
            self._add_block()
        ends = np.minimum(np.cumsum([0, *self._blocks]), count)
        blocks = tuple(width for width in np.diff(ends).tolist() if width)
        vectors = self._vectors[:, self._first : self._first + int(ends[-1])]
        return LanczosVectors(vectors, blocks, int(ends[-1]) < count)

    def _add_block(self) -> None:
        X = self._operator(self._last) if self._blocks else self._last
        block = independent(X, self._mass, self._vectors, self._momentum)
        self._exhausted = not block.shape[1]
        if not self._exhausted:
            self._blocks.append(block.shape[1])
            self._vectors = np.hstack([self._vectors, block])
            self._momentum = np.hstack([self._momentum, self._mass @ block])
            self._last = block


def independent(X: Real, mass: Any, V: Real, momentum: Real) -> Real:
    """M-orthonormal vectors of what the columns of X add to V, most independent first, (n, k).

    momentum is M V. Columns that add nothing (below `DEPENDENT` of their length) are dropped.
    """
    length = np.sqrt(np.maximum(np.einsum("ij,ij->j", X, mass @ X), 0.0))
    X = X[:, length > 0.0] / length[length > 0.0]
    for _ in range(2):
        X = X - V @ (momentum.T @ X)
    base, coordinates = _based(X, mass)
    found = base @ _most_independent(coordinates)
    found = found - V @ (momentum.T @ found)  # a remainder may be short: what rounding left along the others counts
    return _orthonormal(found, mass)


def _based(X: Real, mass: Any) -> tuple[Real, Real]:
    """X = B C with B^T M B = I: lengths and angles of the few columns of C are those of X in the mass.

    Householder's QR in units of diag(M)^1/2, in which a mass matrix is well conditioned, then what is left of the mass
    on it. Directions without mass, to rounding, are left out.
    """
    unit = np.sqrt(mass.diagonal())[:, None]
    unit[unit == 0.0] = unit.max(initial=0.0)
    Q, R = scipy.linalg.qr(unit * X, mode="economic")
    B = Q / unit
    weight, turn = scipy.linalg.eigh(B.T @ (mass @ B))
    heavy = weight > _MASSLESS * weight.max(initial=0.0)
    size, turn = np.sqrt(weight[heavy]), turn[:, heavy]
    return B @ (turn / size), size[:, None] * (turn.T @ R)


def _most_independent(C: Real) -> Real:
    """Orthonormal columns that span those of C, from the longest remainder to the shortest that counts, (m, k)."""
    found = np.zeros((len(C), 0))
    while C.shape[1]:
        remaining = np.linalg.norm(C, axis=0)
        best = int(np.argmax(remaining > (1.0 - _EQUAL) * remaining.max()))
        if remaining[best] < DEPENDENT:
            break
        z = C[:, best] / remaining[best]
        for _ in range(2):
            z = z - found @ (found.T @ z)
            z = z / np.linalg.norm(z)
        found = np.column_stack([found, z])
        C = np.delete(C, best, axis=1)
        for _ in range(2):
            C = C - np.outer(z, z @ C)
    return found


def _orthonormal(X: Real, mass: Any) -> Real:
    """Nearly orthonormal columns made so, each with those before it (Cholesky's QR)."""
    L = scipy.linalg.cholesky(X.T @ (mass @ X), lower=True)
    return np.asarray(scipy.linalg.solve_triangular(L, X.T, lower=True).T)
