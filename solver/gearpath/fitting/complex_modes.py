"""What complex modes would bring: the same poles with complex residues of any rank, by linear least squares.

    Y_ab(x) = sum_r (i x alpha_r - x^2 beta_r) / (x_r^2 - x^2 + 2 i zeta_r x_r x)

beta_r = 0 is a real mode. Residues of any rank are more than complex modes have, so that this error is a bound from
below on what complex modes could reach with these poles. They would need a full damping matrix in time.
"""

import numpy as np

from ..numerics.arrays import Real
from .mode_lines import mode_lines
from .problem import Problem
from .refine import Trial


def complex_residual(problem: Problem, modes: Trial) -> Real:
    """Stacked misfit (2 F, P) of complex residues at the poles of these modes."""
    lines = mode_lines(problem.x, modes.frequency, modes.damping)
    bent = 1j * problem.x * lines[modes.frequency > 0.0]
    basis = np.vstack([lines, bent]).T
    A = np.vstack([basis.real, basis.imag])
    A = A / np.linalg.norm(A, axis=0)
    found, *_ = np.linalg.lstsq(A, problem.stacked, rcond=1e-10)
    return np.asarray(A @ found - problem.stacked)
