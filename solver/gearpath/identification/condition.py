"""What the mobilities on both sides of joints must satisfy, whatever the two parts are.

    rank [[I + Z Y_ba, Z Y_bb], [Y_aa, Y_ab]] = n                                                     (n x n blocks)

In words: forces that hold the source side still (v_a = 0) are those that the joints exert there, f_a = -Z v_b. It
follows from Y^-1 = [[Z_A + Z, -Z], [-Z, Z_B + Z]] for any Z_A and Z_B, but inverts nothing: it holds as well where Y is
singular, because a rigid part moves at more ports than it has coordinates, and where Z is. These are n^2 complex
equations a line, all that two unknown reciprocal parts leave.

With left and right singular vectors U, V of the n singular values that should vanish,

    m = U^H M V,   dm = a dY V + U_1^H dZ (Y_b: V),   a = U^H diag(Z, I) [Y_b: over Y_a:]
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..numerics.arrays import Complex, Real


@dataclass(frozen=True)
class Linearised:
    """The condition near mobilities Y (F, N, N) and an impedance Z (F, n, n)."""

    value: Complex  # (F, n, n): m, zero where the condition holds
    left: Complex  # (F, n, N): a
    right: Complex  # (F, N, n): V
    force: Complex  # (F, n, n): U_1^H
    motion: Complex  # (F, n, n): Y_b: V
    left_lever: Complex  # (F, n, N): M^+ dM is this times dY; how far noise turns the singular vectors
    right_lever: Complex  # (F, N, n)

    def of_mobility(self, change: Complex) -> Complex:
        """dm of a change of the mobilities (F, N, N), as (F, n^2)."""
        return np.asarray((self.left @ change @ self.right).reshape(len(change), -1))

    def of_impedance(self, basis: Real) -> Complex:
        """dm of unit amounts of basis matrices (q, n, n) in Z, as (F, n^2, q)."""
        change = np.einsum("fka,qab,fbl->fklq", self.force, basis, self.motion, optimize=True)
        return np.asarray(change.reshape(len(change), change.shape[1] ** 2, len(basis)))

    def covariance(self, deviation: Real) -> Complex:
        """E[m m^H] (F, n^2, n^2) of independent noise of the entries i <= j of Y, E|e_ij|^2 = deviation^2."""
        a, v = self.left, self.right.swapaxes(1, 2)
        F, n, N = a.shape
        t = deviation**2 * np.where(np.eye(N), 0.5, 1.0)
        aa = (a[:, :, None] * a[:, None].conj()).reshape(F, n * n, N)  # (k k', i)
        vv = (v[:, :, None] * v[:, None].conj()).reshape(F, n * n, N)  # (l l', j)
        av = (a[:, :, None] * v[:, None].conj()).reshape(F, n * n, N)  # (k l', i)
        direct = (aa @ t @ vv.swapaxes(1, 2)).reshape(F, n, n, n, n).transpose(0, 1, 3, 2, 4)
        crossed = (av @ t @ av.conj().swapaxes(1, 2)).reshape(F, n, n, n, n).transpose(0, 1, 4, 3, 2)
        return np.asarray((direct + crossed).reshape(F, n * n, n * n))

    def back(self, weights: Complex, deviation: Real) -> Complex:
        """Change of Y (F, N, N), deviation^2 times the adjoint of `of_mobility` of weights (F, n^2)."""
        F, n, N = self.left.shape
        pull = self.left.conj().swapaxes(1, 2) @ weights.reshape(F, n, n) @ self.right.conj().swapaxes(1, 2)
        both = pull + pull.swapaxes(1, 2)
        return np.asarray(deviation**2 * np.where(np.eye(N), 0.5, 1.0) * both)

    def unsteadiness(self, deviation: Real) -> Real:
        """(F,): by how much noise turns the singular vectors; above about 1/2 the line says nothing linear."""
        square = deviation**2

        def turn(left: Complex, right: Complex) -> Real:
            rows, columns = (np.abs(left) ** 2).sum(axis=1), (np.abs(right) ** 2).sum(axis=2)
            return np.asarray(np.einsum("fi,fij,fj->f", rows, square, columns))

        return np.sqrt(np.maximum(turn(self.left, self.right_lever), turn(self.left_lever, self.right)))


def linearise(Y: Complex, Z: Complex, scale: Real) -> Linearised:
    """The condition at Y and Z; `scale` (n,) are typical sqrt(mobility) of the ports, for units of alike size."""
    n = Z.shape[1]
    both = np.concatenate([scale, scale])
    Zs = Z * scale[:, None] * scale
    swap = np.zeros((len(Y), 2 * n, 2 * n), complex)
    swap[:, :n, n:] = Zs
    swap[:, n:, :n] = np.linalg.norm(Zs, 2, axis=(1, 2))[:, None, None] * np.eye(n)
    M = swap @ (Y / (both[:, None] * both))
    M[:, :n, :n] += np.eye(n)
    U, values, Vh = np.linalg.svd(M)
    U, V = np.asarray(U.conj().swapaxes(1, 2), complex), np.asarray(Vh.conj().swapaxes(1, 2), complex)
    kept = values[:, :n]
    right, push = V[:, :, n:] / both[:, None], swap / both
    m = np.zeros_like(Z)
    m[:, np.arange(n), np.arange(n)] = values[:, n:]
    return Linearised(
        value=m,
        left=U[:, n:] @ push,
        right=right,
        force=np.asarray(U[:, n:, :n] * scale, complex),
        motion=Y[:, n:] @ right,
        left_lever=(U[:, :n] / kept[:, :, None]) @ push,
        right_lever=V[:, :, :n] / kept[:, None, :] / both[:, None],
    )
