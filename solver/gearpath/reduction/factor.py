"""One sparse factorisation of a positive definite stiffness, used for many right-hand sides."""

from typing import Any

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

from ..errors import AccuracyError
from ..numerics.arrays import Real

_BLOCK = 32  # right-hand sides solved at a time: bounds the memory beside the factor
_SINGULAR = (
    "the stiffness of the held structure is singular to working precision: it can move without deforming in a way that "
    "none of its rigid-body modes describes, or its stiffest and softest parts lie too far apart; declare that motion"
)
_DIGITS = 1e-3  # relative error of a known solution above which the matrix counts as singular


class Factor:
    """K = L U by SuperLU in its symmetric mode, scaled to a unit diagonal; K dense or sparse, (n, n), SPD.

    The minimum degree ordering of K + K^T without pivoting keeps the fill of a Cholesky factor. Raises AccuracyError
    where K is singular to working precision.
    """

    def __init__(self, stiffness: Any) -> None:
        self.matrix = scipy.sparse.csc_array(stiffness)
        self.size = int(self.matrix.shape[0])
        diagonal = self.matrix.diagonal()
        if np.any(diagonal <= 0.0):
            raise AccuracyError(_SINGULAR)
        self._scale = 1.0 / np.sqrt(diagonal)
        if not self.size:
            return
        D = scipy.sparse.diags_array(self._scale)
        options = {"SymmetricMode": True, "Equil": False}
        try:
            self._lu = scipy.sparse.linalg.splu(
                scipy.sparse.csc_array(D @ self.matrix @ D),
                permc_spec="MMD_AT_PLUS_A",
                diag_pivot_thresh=0.0,
                options=options,
            )
        except RuntimeError as error:  # "Factor is exactly singular"
            raise AccuracyError(_SINGULAR) from error
        known = np.cos(1.0 + np.arange(self.size) ** 2 % 7919) * self._scale  # no pattern that a mode could share
        found = self.solve((self.matrix @ known)[:, None])[:, 0]
        if not np.linalg.norm((found - known) / self._scale) < _DIGITS * np.linalg.norm(known / self._scale):
            raise AccuracyError(_SINGULAR)

    @property
    def entries(self) -> int:
        """Stored entries of L and U."""
        return int(self._lu.nnz) if self.size else 0

    def solve(self, right: Real) -> Real:
        """K^-1 right, (n, m)."""
        out = np.empty(right.shape)
        for start in range(0, right.shape[1] if self.size else 0, _BLOCK):
            part = slice(start, start + _BLOCK)
            out[:, part] = self._scale[:, None] * self._lu.solve(self._scale[:, None] * right[:, part])
        return out
