"""Mobility of one component at chosen rows, direct (Eq. 6) and from its modes (Eq. 7 and 11a)."""

import numpy as np
import scipy.linalg
import scipy.sparse
import scipy.sparse.linalg

from ..errors import AccuracyError
from ..numerics.arrays import Complex, Real, Sparse
from .modes import Modes, modes
from .structure import Structure


def modal_response(eigenvalues: Real | Complex, damping: Real, omega: Real) -> Complex:
    """Mobility of single modes, i w / (w_r^2 - w^2 + i w X_r) (Eq. 7), shape (N, F); zero-frequency modes included.

    With a loss factor eta, w_r^2 is (1 + i eta) w_r^2.
    """
    w = omega[None, :]
    return np.asarray(1j * w / (eigenvalues[:, None] - w**2 + 1j * w * damping[:, None]))


def mobility_modal(modes: Modes, rows: Real, modal_damping: float, omega: Real) -> Complex:
    """Y = i w (L Phi) (Lambda - w^2 I + i w Xi)^-1 (L Phi)^T (Eq. 11a), shape (F, m, m) for rows (m, n)."""
    shapes = rows @ modes.shapes
    response = modal_response(modes.eigenvalues, 2.0 * modal_damping * np.sqrt(modes.eigenvalues), omega)
    return np.asarray(np.einsum("mr,rf,kr->fmk", shapes, response, shapes, optimize=True))


def mobility_direct(structure: Structure, rows: Real, omega: Real) -> Complex:
    """Y = i w L ((1 + i eta) K - w^2 M + i w C)^-1 L^T (Eq. 6), shape (F, m, m) for rows (m, n)."""
    C = damping_matrix(structure)
    out = np.empty((len(omega), len(rows), len(rows)), complex)
    for k, w in enumerate(omega):
        dynamic = (1.0 + 1j * structure.loss_factor) * structure.stiffness - w**2 * structure.mass + 1j * w * C
        motion = rows.T.astype(complex)
        if scipy.sparse.issparse(dynamic):
            out[k] = 1j * w * rows @ scipy.sparse.linalg.splu(scipy.sparse.csc_array(dynamic)).solve(motion)
        else:
            out[k] = 1j * w * rows @ scipy.linalg.solve(dynamic, motion)
    return out


def damping_matrix(structure: Structure) -> Real | Sparse:
    """C of a structure: modal damping of a dense one; a sparse one has a loss factor only.

    Raises AccuracyError for modal damping of a sparse structure, whose modes are not all known.
    """
    if not scipy.sparse.issparse(structure.mass):
        return modal_damping_matrix(structure)
    if structure.modal_damping:
        raise AccuracyError(
            "modal damping of a plate or frame has no damping matrix, for not all of its modes are known; "
            "give it a loss_factor for this"
        )
    return scipy.sparse.csc_array(structure.mass.shape)


def modal_damping_matrix(structure: Structure) -> Real:
    """C = M Phi diag(2 zeta w_r) Phi^T M: the damping ratio zeta in every elastic mode, none in rigid-body motion.

    It satisfies C M^-1 C = 4 zeta^2 K, which defines it without any modes. Modes that are the coordinates themselves
    may have a ratio each, and dashpots between them.
    """
    if structure.damping_ratios is not None:
        C = np.diag(2.0 * structure.damping_ratios * np.sqrt(np.diag(structure.stiffness)))
        return C if structure.dashpots is None else C + structure.dashpots.T @ structure.dashpots
    basis = modes(structure)
    momentum = structure.mass @ basis.shapes
    return np.asarray((momentum * (2.0 * structure.modal_damping * np.sqrt(basis.eigenvalues))) @ momentum.T)
