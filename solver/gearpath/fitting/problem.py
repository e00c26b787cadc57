"""The least-squares problem of a fit, in scaled units: what is to be met, and how its misfit weighs.

Frequencies are in parts of the highest line, x = w / w_max, channels in parts of d_a = sqrt(max |Y_aa|), and of the
symmetric matrix only the P = m (m + 1) / 2 pairs a <= b are kept. Each FRF weighs by its own largest gain,

    J = sum_(a <= b) W_ab sum_f |E_ab(w_f)|^2,    W_ab = (2 - delta_ab) / max_f |Y_ab|^2

so that the misfit of a weak transfer path counts like that of a driving point.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..numerics.arrays import Complex, Real

_SILENT = 1e-9  # a gain below this part of its two driving points' is a zero of symmetry, not a response


@dataclass(frozen=True)
class Problem:
    """Scaled lines x (F,), pairs (a, b) of the m channels, target Y (F, P) and weights W (P,)."""

    x: Real
    first: NDArray[np.intp]  # a of every pair, (P,)
    second: NDArray[np.intp]  # b of every pair, (P,)
    target: Complex  # (F, P)
    weight: Real  # W, (P,)
    scale: Real  # d (m,)
    top: float  # w_max, rad/s

    @classmethod
    def of(cls, omega: Real, mobility: Complex) -> "Problem":
        """The problem of a reciprocal mobility (F, m, m) at the angular frequencies `omega` (rad/s)."""
        gain = gains(mobility)
        scale = np.sqrt(np.diag(gain))
        scale = np.where(scale > 0.0, scale, 1.0)
        a, b = np.triu_indices(mobility.shape[1])
        relative = gain[a, b] / (scale[a] * scale[b])
        target = mobility[:, a, b] / (scale[a] * scale[b])
        weight = (2.0 - (a == b)) / np.maximum(relative, _SILENT) ** 2
        return cls(omega / omega.max(), a, b, target, weight, scale, float(omega.max()))

    @property
    def channels(self) -> int:
        """Number of channels m."""
        return len(self.scale)

    @cached_property
    def stacked(self) -> Real:
        """Target as real numbers, (2 F, P): real parts above imaginary ones."""
        return np.vstack([self.target.real, self.target.imag])

    def unpacked(self, pairs: Real) -> Real:
        """Symmetric matrices (..., m, m) of values of the pairs (..., P)."""
        out = np.empty((*pairs.shape[:-1], self.channels, self.channels))
        out[..., self.first, self.second] = out[..., self.second, self.first] = pairs
        return out

    def products(self, shapes: Real) -> Real:
        """psi_a psi_b of every mode and pair, (N, P), of shapes (N, m)."""
        return np.asarray(shapes[:, self.first] * shapes[:, self.second])

    def cost(self, residual: Real) -> float:
        """J of a stacked residual (2 F, P)."""
        return float(np.einsum("fp,fp,p->", residual, residual, self.weight))


def gains(mobility: Complex) -> Real:
    """Largest |Y_ab| over the lines, (m, m); Y is (F, m, m)."""
    return np.asarray(abs(mobility).max(axis=0))
