"""The modes of the coupled network, for integrating it pair by pair: exact and fast.

With M = I, damping D = X + P^T C P and stiffness S = L + P^T K P, all symmetric, the modes solve

    (p^2 I + p D + S) f = 0,      x = [w f ; p f],      y = [(p f + D f) / w ; f],

x the right and y the left eigenvector of the time twin's A (network/time_twin.py), y^T x = 2 p f^T f + f^T D f.
A rigid motion f that nothing resists (S f = D f = 0) has the double pole 0 with the chain [w f ; 0], [0 ; f].
"""

from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np
import scipy.linalg

from ..numerics.arrays import Complex, Real
from .modal import ModalNetwork
from .time_twin import state_scale, time_twin

_DEFECT = 1e-10  # largest deviation of T^-1 T from I, T's columns of unit length: beyond, T is not well conditioned


class PairKind(IntEnum):
    """What two coordinates of the modal form belong to; the numbers are those of fmu_src/gp_model.h."""

    OSCILLATING = 0  # two conjugate poles
    DECAYING = 1  # two real poles
    DRIFTING = 2  # a rigid motion that nothing resists


@dataclass(frozen=True)
class CoupledModes:
    """N pairs of coordinates that the coupled network falls apart into."""

    kinds: tuple[PairKind, ...]
    poles: Real  # (N, 2) real and imaginary part of the pole, or two real poles, rad/s
    norms: Real  # (N, 2) y^T x, likewise
    shapes: Real  # (N, 2, N) real and imaginary part of f, or two real f


def coupled_modes(network: ModalNetwork) -> CoupledModes | None:
    """The modes, or None where they are no well conditioned basis (repeated roots, critical damping)."""
    w, P, (K, C) = state_scale(network), network.relative, network.interface_matrices()
    damping, stiffness = _Matrix(network.damping, P, C), _Matrix(network.eigenvalues, P, K)
    rigid = _free_motions(network, P, K, C)
    poles, vectors = scipy.linalg.eig(time_twin(network, outputs=()).A)
    kept = np.argsort(abs(poles))[2 * rigid.shape[1] :]
    poles, vectors = poles[kept], vectors[:, kept]
    upper, real = poles.imag > 0, poles.imag == 0
    if 2 * upper.sum() + real.sum() != len(poles) or real.sum() % 2:
        return None
    p, f = _in_order(poles[upper], vectors[:, upper], w, np.argsort(poles[upper].imag))
    slow, g = _in_order(poles[real], vectors[:, real], w, np.argsort(-poles[real].real))
    poles = _refined(p, f, slow.real, g.real, rigid, damping, stiffness)
    modes = _assembled(rigid, *poles, damping)
    return modes if _is_well_conditioned(modes, w, damping) else None


class _Matrix:
    """diag(d) + P^T J P, applied without forming it."""

    def __init__(self, diagonal: Real, P: Real, joints: Real) -> None:
        self.diagonal, self.P, self.joints = diagonal[:, None], P, joints

    def __matmul__(self, vectors: Any) -> Any:
        return np.asarray(self.diagonal * vectors + self.P.T @ (self.joints @ (self.P @ vectors)))


def _free_motions(network: ModalNetwork, P: Real, K: Real, C: Real) -> Real:
    """Rigid motions that no joint resists, orthonormal, (N, number)."""
    rigid = np.flatnonzero(network.eigenvalues == 0)
    if not rigid.size:
        return np.zeros((len(network.eigenvalues), 0))
    rows = np.vstack([K, C]) @ P[:, rigid]
    size = np.abs(np.vstack([K, C])) @ np.abs(P[:, rigid]).max(axis=1)  # N and N m rows count alike
    scaled = rows / np.where(size > 0, size, 1.0)[:, None]
    _, values, right = scipy.linalg.svd(scaled)
    rank = int((values > 1e-10).sum())
    free = np.zeros((len(network.eigenvalues), len(rigid) - rank))
    free[rigid] = right[rank:].T
    return free


def _in_order(poles: Complex, vectors: Complex, w: Real, order: np.ndarray) -> tuple[Complex, Complex]:
    """Poles and modes f, from the half of the eigenvectors that is larger."""
    p, x, N = poles[order], vectors[:, order], len(w)
    return p, np.where(abs(p) > w[:, None], x[N:] / p, x[:N] / w[:, None])


def _refined(
    p: Complex, f: Complex, slow: Real, g: Real, rigid: Real, D: _Matrix, S: _Matrix
) -> tuple[Complex, Complex, Real, Real]:
    """Modes and poles made accurate relative to each pole itself; LAPACK's are so to the largest one only.

    G_ij = y_i^T x_j = (p_i + p_j) f_i^T f_j + f_i^T D f_j and H_ij = y_i^T A x_j = p_i p_j f_i^T f_j - f_i^T S f_j are
    small sums of energies. The mode x_j lacks (H_ij - p_j G_ij) / (p_j - p_i) / G_ii of x_i. Where poles are close,
    that quotient is rounding, so at last the modes are made orthogonal: half of G_ij / G_ii is taken off either one.
    """
    k, n = len(p), len(slow)
    for last in (False, False, True, True):
        P, F = np.concatenate([p, p.conj(), slow]), np.hstack([f, f.conj(), g])
        F = F - rigid @ (rigid.T @ F)
        mass, damping, stiffness = F.T @ F, F.T @ (D @ F), F.T @ (S @ F)
        P = P - ((mass.diagonal() * P + damping.diagonal()) * P + stiffness.diagonal()) / (
            2 * mass.diagonal() * P + damping.diagonal()
        )
        G = (P[:, None] + P) * mass + damping
        gap = P - P[:, None]
        np.fill_diagonal(gap, np.inf)
        lack = P[:, None] * P * mass - stiffness - G * P
        step = -0.5 * G + np.diag(0.5 * G.diagonal()) if last else lack / np.where(gap == 0, np.inf, gap)
        step /= G.diagonal()[:, None]
        F = F + F @ step
        p, f, slow, g = P[:k], F[:, :k], P[2 * k :].real, F[:, 2 * k :].real
    if n == 0:
        g = np.zeros((len(f), 0))
    return p, f, slow, g


def _assembled(rigid: Real, p: Complex, f: Complex, slow: Real, g: Real, D: _Matrix) -> CoupledModes:
    norm, slow_norm = ((2 * q * h * h + h * (D @ h)).sum(axis=0) for q, h in ((p, f), (slow, g)))
    drifting, pairs = rigid.shape[1], len(slow) // 2
    kinds = [PairKind.DRIFTING] * drifting + [PairKind.DECAYING] * pairs + [PairKind.OSCILLATING] * len(p)
    squares = (rigid**2).sum(axis=0)
    return CoupledModes(
        tuple(kinds),
        np.vstack([np.zeros((drifting, 2)), slow.reshape(-1, 2), np.column_stack([p.real, p.imag])]),
        np.vstack(
            [np.column_stack([squares, squares]), slow_norm.reshape(-1, 2), np.column_stack([norm.real, norm.imag])]
        ),
        np.concatenate(
            [
                np.stack([rigid.T, 0 * rigid.T], axis=1),
                g.T.reshape(pairs, 2, len(g)),
                np.stack([f.real.T, f.imag.T], axis=1),
            ]
        ),
    )


def _is_well_conditioned(modes: CoupledModes, w: Real, D: _Matrix) -> bool:
    """Whether the left vectors, which follow from symmetry, are the inverse of the right ones."""
    right, left = [], []
    for kind, pole, norm, (f, g) in zip(modes.kinds, modes.poles, modes.norms, modes.shapes):
        if kind is PairKind.DRIFTING:
            right += [np.concatenate([w * f, 0 * f]), np.concatenate([0 * f, f])]
            left += [np.concatenate([f / w, 0 * f]) / norm[0], np.concatenate([0 * f, f]) / norm[1]]
            continue
        pairs = [(complex(*pole), complex(*norm), f + 1j * g)]
        if kind is PairKind.DECAYING:
            pairs = [(pole[0], norm[0], f), (pole[1], norm[1], g)]
        for p, n, h in pairs:
            x = np.concatenate([w * h, p * h])
            y = np.concatenate([(p * h + (D @ h[:, None])[:, 0]) / w, h]) / n
            right += [x] if kind is PairKind.DECAYING else [x, x.conj()]
            left += [y] if kind is PairKind.DECAYING else [y, y.conj()]
    T = np.array(right).T
    length = np.linalg.norm(T, axis=0)  # left and right vectors belong to each other; how long they are says nothing
    defect = length[:, None] * (np.array(left) @ T - np.eye(len(length))) / length
    return bool(abs(defect).max() < _DEFECT)
