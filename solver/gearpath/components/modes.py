"""Free-free modes of a structure, rigid-body modes known beforehand and kept exact."""

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from ..errors import AccuracyError
from ..numerics.arrays import Real
from .structure import Structure

_NULL = 1e-11  # residual |K R| / |K||R| of a declared rigid mode; rounding leaves 1e-14
_FLOOR = 16.0 * np.finfo(float).eps  # elastic eigenvalues below this part of the largest lose digits to its rounding
_SKEW = 1e-6  # of the elastic modes' modal mass matrix: a mode that is one of the others shows here
_CLOSE = 1e-2  # modes whose eigenvalues differ by less (relatively) are kept orthogonal by force
_CLUSTER = 1e-4  # modes whose eigenvalues differ by less (relatively) are separated among themselves


@dataclass(frozen=True)
class Modes:
    """Mass-normalised modes: Phi^T M Phi = I, Phi^T K Phi = diag(eigenvalues)."""

    eigenvalues: Real  # (N,), (rad/s)^2, ascending; exactly zero for rigid-body modes
    shapes: Real  # (n, N)

    @property
    def frequencies(self) -> Real:
        """Natural frequencies, Hz."""
        return np.sqrt(self.eigenvalues) / (2.0 * np.pi)


def modes(structure: Structure) -> Modes:
    """All free-free modes of a structure (Eq. 11 with a complete basis).

    The rigid-body modes come from the structure, not from the eigensolver: their eigenvalue is exactly zero, and the
    elastic modes are made orthogonal to them, so that low frequencies keep all digits. Eigenvalues are Rayleigh
    quotients of the sharpened shapes, whose error is the square of that of the shapes.

    Raises AccuracyError where the structure has rigid-body motions that it did not declare, or the reverse, and
    where its highest eigenvalue (of its shortest span) is so high that the lowest ones drown in its rounding.
    """
    M, K, R = structure.mass, structure.stiffness, structure.rigid_modes
    count = R.shape[1]
    residual = abs(K @ R).max(axis=0, initial=0.0) > _NULL * (abs(K) @ abs(R)).max(axis=0, initial=0.0)
    if residual.any():
        raise AccuracyError(
            f"{np.count_nonzero(residual)} of the {count} rigid-body modes that the structure declares deform it"
        )
    if count:
        R = R @ scipy.linalg.inv(scipy.linalg.cholesky(R.T @ M @ R, lower=False))
    rough, vectors = scipy.linalg.eigh(K, M)
    elastic = vectors[:, count:]
    elastic -= R @ (R.T @ (M @ elastic))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # judged below
        elastic, eigenvalues = sharpen(elastic, K, M)
    skew = abs(elastic.T @ M @ elastic - np.eye(len(eigenvalues))).max(initial=0.0)
    if len(eigenvalues) and not (skew < _SKEW and eigenvalues.min() > _FLOOR * rough[-1]):
        raise AccuracyError(
            f"beside the {count} rigid-body modes that the structure declares, modes drown in the rounding of its "
            f"highest (lowest eigenvalue {eigenvalues.min():.3g}, highest {rough[-1]:.3g} (rad/s)^2): it can move "
            "in more ways without deforming, or one of its spans is too short (below some micrometres)"
        )
    order = np.argsort(eigenvalues)
    return Modes(np.concatenate([np.zeros(count), eigenvalues[order]]), np.hstack([R, elastic[:, order]]))


def sharpen(shapes: Real, K: Real, M: Real) -> tuple[Real, Real]:
    """Iterative refinement of all modes together (Ogita and Aishima 2018), and their Rayleigh quotients.

    The eigensolver's error is relative to the highest eigenvalue, 1e9 times that of the first bending modes. The
    residuals of the shapes, formed with the matrices themselves, are far smaller: the mixing E_ij of mode i in mode j
    follows from them to second order, so two steps are enough. Modes too close for that are separated within their
    own cluster, where the eigensolver's error is relative to their own eigenvalue.
    """
    for _ in range(2):
        S, G = shapes.T @ (K @ shapes), shapes.T @ (M @ shapes)
        values = np.diag(S) / np.diag(G)
        gap = values[None, :] - values[:, None]
        larger = np.maximum(values[None, :], values[:, None])
        apart = abs(gap) > _CLUSTER * larger
        E = np.where(apart, (S - values[None, :] * G) / np.where(apart, gap, 1.0), -G / 2.0)
        np.fill_diagonal(E, (1.0 - np.diag(G)) / 2.0)
        # rounding over a small gap must not spoil orthogonality: E + E^T = I - G
        E -= np.where(abs(gap) < _CLOSE * larger, (E + E.T + G - np.eye(len(G))) / 2.0, 0.0)
        shapes = shapes + shapes @ E
        shapes = shapes[:, np.argsort(values)]
        ends = np.flatnonzero(np.diff(np.sort(values)) > _CLUSTER * np.sort(values)[1:]) + 1
        for cluster in np.split(np.arange(len(values)), ends):
            if len(cluster) > 1:
                part = shapes[:, cluster]
                shapes[:, cluster] = part @ scipy.linalg.eigh(part.T @ (K @ part), part.T @ (M @ part))[1]
    return shapes, np.einsum("ij,ij->j", shapes, K @ shapes) / np.einsum("ij,ij->j", shapes, M @ shapes)
