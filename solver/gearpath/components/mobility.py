"""Mobility of one component at chosen rows, direct (Eq. 6) and from its modes (Eq. 7 and 11a)."""

import numpy as np
import scipy.linalg

from ..numerics.arrays import Complex, Real
from .modes import Modes
from .structure import Structure


def modal_response(eigenvalues: Real, damping: Real, omega: Real) -> Complex:
    """Mobility of single modes, i w / (w_r^2 - w^2 + i w X_r) (Eq. 7), shape (N, F); zero-frequency modes included."""
    w = omega[None, :]
    return np.asarray(1j * w / (eigenvalues[:, None] - w**2 + 1j * w * damping[:, None]))


def mobility_modal(modes: Modes, rows: Real, modal_damping: float, omega: Real) -> Complex:
    """Y = i w (L Phi) (Lambda - w^2 I + i w Xi)^-1 (L Phi)^T (Eq. 11a), shape (F, m, m) for rows (m, n)."""
    shapes = rows @ modes.shapes
    response = modal_response(modes.eigenvalues, 2.0 * modal_damping * np.sqrt(modes.eigenvalues), omega)
    return np.einsum("mr,rf,kr->fmk", shapes, response, shapes, optimize=True)


def mobility_direct(structure: Structure, rows: Real, omega: Real) -> Complex:
    """Y = i w L (K - w^2 M + i w C)^-1 L^T (Eq. 6), shape (F, m, m) for rows (m, n)."""
    C = modal_damping_matrix(structure)
    out = np.empty((len(omega), len(rows), len(rows)), complex)
    for k, w in enumerate(omega):
        dynamic = structure.stiffness - w**2 * structure.mass + 1j * w * C
        out[k] = 1j * w * rows @ scipy.linalg.solve(dynamic, rows.T.astype(complex))
    return out


def modal_damping_matrix(structure: Structure) -> Real:
    """C = 2 zeta L (L^-1 K L^-T)^(1/2) L^T with M = L L^T: the same damping ratio in every elastic mode.

    The principal square root needs no mode shapes, which keeps the direct route apart from the modal one.
    """
    if structure.modal_damping == 0.0:
        return np.zeros_like(structure.mass)
    L = scipy.linalg.cholesky(structure.mass, lower=True)
    inner = scipy.linalg.solve_triangular(L, structure.stiffness, lower=True)
    A = scipy.linalg.solve_triangular(L, inner.T, lower=True)
    values, vectors = scipy.linalg.eigh((A + A.T) / 2.0)
    values[: structure.rigid_modes.shape[1]] = 0.0
    root = vectors * np.sqrt(np.maximum(values, 0.0)) @ vectors.T
    return np.asarray(2.0 * structure.modal_damping * L @ root @ L.T)
