"""Damping of the blends that stand for all modes above the band.

A blend of modes has no ratio of its own: V^T X V couples it with its neighbours, which a network of modal ratios cannot
hold. What the ratios must give is what these modes damp in the band. To first order, with r all rows that see them,

    sum_h r_h r_h^T rho_h w_h / (w_h^2 - w^2)^2  =  sum_k r_k r_k^T rho_k w_k / (w_k^2 - w^2)^2

at frequencies w of the band: linear in the shares rho_k of the blends, which must not be negative. Non-negative least
squares keep the damping positive semidefinite and make the reduced model ten to a hundred times more accurate than the
diagonal of V^T X V.
"""

import numpy as np
import scipy.linalg
import scipy.optimize

from ...numerics.arrays import Real

_LINES = 12


def blend_shares(
    rows: Real, eigenvalues: Real, share: Real, blends: Real, blend_eigenvalues: Real, highest: float
) -> Real:
    """Shares rho_k (m,) of blends, from those of the modes above the band, `share` (n,).

    rows (p, n) are what sees the modes, of eigenvalues (n,); blends (n, m), of eigenvalues (m,); `highest` is the upper
    end of the band, rad/s.
    """
    if not len(rows) or not blends.shape[1] or not share.any():
        return np.zeros(blends.shape[1])
    w2 = (highest * np.linspace(0.0, 1.0, _LINES)) ** 2
    a, b = np.triu_indices(len(rows))
    seen = rows @ blends
    wanted = (rows[a] * rows[b]) @ _responses(eigenvalues, w2, share)
    given = (seen[a] * seen[b])[:, :, None] * _responses(blend_eigenvalues, w2, np.ones(len(blend_eigenvalues)))
    own = np.einsum("ph,hw->pw", rows**2, _responses(eigenvalues, w2, share))
    scale = np.sqrt(own[a] * own[b])
    scale = np.where(scale > 0.0, 1.0 / np.where(scale > 0.0, scale, 1.0), 0.0)
    system = np.column_stack([(given * scale[:, None, :]).swapaxes(1, 2).reshape(-1, blends.shape[1])])
    R = scipy.linalg.qr(np.column_stack([system, (wanted * scale).ravel()]), mode="r")[0][: blends.shape[1] + 1]
    return np.asarray(scipy.optimize.nnls(R[:, :-1], R[:, -1])[0])


def _responses(eigenvalues: Real, w2: Real, share: Real) -> Real:
    """rho_h w_h / (w_h^2 - w^2)^2, (n, lines); modes at the end of the band are taken a little above it."""
    gap = np.maximum(eigenvalues[:, None] - w2, 1e-3 * eigenvalues[:, None])
    return np.asarray((share * np.sqrt(eigenvalues))[:, None] / gap**2)
