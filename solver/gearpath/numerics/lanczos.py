"""Block Lanczos vectors: an M-orthonormal basis of a Krylov space, with full re-orthogonalisation."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .arrays import Real

DEPENDENT = 1e-9  # a vector that keeps less than this part of its length beside the others adds no direction
_EQUAL = 1e-3  # remainders closer than this, of mirror-image columns, are equal but for rounding: the first one counts


@dataclass(frozen=True)
class LanczosVectors:
    """M-orthonormal vectors V, V^T M V = I, in the order in which they were found."""

    vectors: Real  # (n, k)
    blocks: tuple[int, ...]  # vectors of each block; their sum is k
    exhausted: bool  # the Krylov space ended before the wanted number (breakdown): it is invariant, and complete


def block_lanczos(
    operator: Callable[[Real], Real], mass: Any, start: Real, count: int, held: Real | None = None
) -> LanczosVectors:
    """At most `count` vectors of span{X, P X, P^2 X, ...}, P = operator, self-adjoint in the inner product of `mass`.

    With P = K^-1 M and X = K^-1 F a Galerkin projection on j full blocks matches the first 2 j moments
    F^T (K^-1 M)^k K^-1 F at zero frequency (Nour-Omid and Clough 1984; Craig and Hale 1988). mass (n, n), dense or
    sparse, positive definite; start X (n, m); held (n, h), M-orthonormal, are vectors to be orthogonal to.

    Every column is made orthogonal to all earlier vectors twice (which is enough for rounding). Of a block the
    column with the largest remainder, relative to its own length, comes first (of equal ones the first), so that a
    block that `count` cuts off keeps its most independent directions. Deflation: a column left with less than 1e-9 of
    its length is dropped and the blocks stay narrower; breakdown: when a whole block is dropped the space is invariant
    and ends. No random numbers: the same input gives the same vectors.
    """
    n = len(start)
    V = np.zeros((n, 0)) if held is None else held
    first, blocks = V.shape[1], list[int]()
    momentum, X = mass @ V, start
    while V.shape[1] - first < count:
        block = independent(X, mass, V, momentum, count - (V.shape[1] - first))
        if not block.shape[1]:
            return LanczosVectors(V[:, first:], tuple(blocks), True)
        V, momentum = np.hstack([V, block]), np.hstack([momentum, mass @ block])
        blocks.append(block.shape[1])
        if V.shape[1] - first < count:
            X = operator(block)
    return LanczosVectors(V[:, first:], tuple(blocks), False)


def independent(X: Real, mass: Any, V: Real, momentum: Real, count: int | None = None) -> Real:
    """M-orthonormal vectors of what the columns of X add to V, most independent first, at most `count`, (n, k).

    momentum is M V. Columns that add nothing (below `DEPENDENT` of their length) are dropped.
    """
    length = _lengths(X, mass)
    X = X[:, length > 0.0] / length[length > 0.0]
    found: list[Real] = []
    pushes: list[Real] = []
    for _ in range(2):
        X = X - V @ (momentum.T @ X)
    while X.shape[1] and (count is None or len(found) < count):
        remaining = _lengths(X, mass)
        best = int(np.argmax(remaining > (1.0 - _EQUAL) * remaining.max()))
        if remaining[best] < DEPENDENT:
            break
        x = X[:, best] / remaining[best]
        for _ in range(2):  # the remainder may be short: what rounding left along the others counts again
            x = x - V @ (momentum.T @ x)
            for other, push in zip(found, pushes):
                x = x - other * (push @ x)
            x = x / np.sqrt(x @ (mass @ x))
        push = mass @ x
        found.append(x)
        pushes.append(push)
        X = np.delete(X, best, axis=1)
        for _ in range(2):
            X = X - np.outer(x, push @ X)
    return np.array(found).T if found else np.zeros((len(X), 0))


def _lengths(X: Real, mass: Any) -> Real:
    """M-norms of the columns."""
    return np.asarray(np.sqrt(np.maximum(np.einsum("ij,ij->j", X, mass @ X), 0.0)))
