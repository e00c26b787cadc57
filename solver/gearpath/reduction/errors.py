"""How good a reduction is: static completeness, a residual estimate over the band, and the true deviation.

The first two need one factorisation and no complete basis. The estimate compares the reduction with a better basis,

    [Phi, G L^T, G M G L^T, G M Phi_b],

G the elastic flexibility: the static responses to the interface loads, their first correction by inertia, one step of
inverse iteration for each reduced mode in the band or up to twice its upper end. What is wrong with a reduction is
either a quasi-static response that it does not hold or a mode that has not converged.
"""

from typing import Any

import numpy as np
import scipy.sparse

from ..components.modes import Modes
from ..components.structure import Structure
from ..numerics.arrays import Complex, Real
from .flexibility import Flexibility, inertia_relief
from .interface import interface_rows
from .record import Reduction, extended, reduced_modes

_BEYOND = 2.0  # modes up to so many times the band's upper end respond in it enough to matter


def static_defect(
    structure: Structure, reduction: Reduction, rows: Any = None, flexibility: Flexibility | None = None
) -> float:
    """Largest part of a driving-point static compliance that the reduction misses, 0 to 1.

    max over the interface rows of 1 - C_r / C, C = L G L^T of the free structure (inertia relief), C_r its counterpart
    in the basis. 0, down to rounding of about 1e-11, says statically complete; by Rayleigh and Ritz C_r <= C.
    """
    L = _rows(structure, rows)
    exact = np.diag(L @ (flexibility or inertia_relief(structure)).apply(L.T))
    found = np.diag(_static_compliance(reduced_modes(structure, reduction), L))
    elastic = exact > 0.0
    return float(np.max(1.0 - found[elastic] / exact[elastic], initial=0.0))


def estimated_deviation(
    structure: Structure,
    reduction: Reduction,
    omega: Real,
    rows: Any = None,
    flexibility: Flexibility | None = None,
) -> Real:
    """Estimated relative deviation of the interface mobility over the lines omega (rad/s), (F,); no complete basis.

    Judge a reduction by the largest value in the band: where that is below 0.1 it tells the true one within a factor of
    two down to 1e-5. A basis that misses whole modes is shown as bad, but its single lines may be several times off.
    """
    flexibility = flexibility or inertia_relief(structure)
    found = reduced_modes(structure, reduction)
    M = scipy.sparse.csc_array(structure.mass)
    count = flexibility.rigid.shape[1]
    near = found.eigenvalues < (_BEYOND * omega.max()) ** 2
    near[:count] = False
    static = flexibility.apply(_rows(structure, rows).T)
    further = flexibility.apply(np.hstack([M @ static, M @ found.shapes[:, near]]))
    better = extended(structure, found.shapes, count, np.hstack([static, further]), "estimate")
    return deviation(structure, reduction, reduced_modes(structure, better), omega, rows)


def deviation(structure: Structure, reduction: Reduction, complete: Modes, omega: Real, rows: Any = None) -> Real:
    """Relative deviation |H - H_r| / |H| of the interface mobility from that of the `complete` modes, (F,).

    Frobenius norms on each line; each row in units of its own static elastic compliance, so that forces and moments
    compare. omega in rad/s.
    """
    L = _rows(structure, rows)
    found = _receptance(structure, reduced_modes(structure, reduction), L, omega)
    exact = _receptance(structure, complete, L, omega)
    unit = _units(_static_compliance(complete, L))
    return _size(exact - found, unit) / _size(exact, unit)


def _rows(structure: Structure, rows: Any) -> Real:
    L = interface_rows(structure) if rows is None else rows
    return np.asarray(scipy.sparse.csr_array(L).toarray())


def _responses(structure: Structure, basis: Modes, omega: Real) -> Complex:
    """Receptance of single modes, (F, N): 1 / ((1 + i eta) w_k^2 - w^2 + 2 i zeta w_k w)."""
    w, natural = omega[:, None], np.sqrt(basis.eigenvalues)[None, :]
    stiff = (1.0 + 1j * structure.loss_factor) * basis.eigenvalues[None, :]
    return np.asarray(1.0 / (stiff - w**2 + 2j * structure.modal_damping * natural * w))


def _receptance(structure: Structure, basis: Modes, L: Real, omega: Real) -> Complex:
    seen = L @ basis.shapes
    return np.asarray(seen @ (_responses(structure, basis, omega)[:, :, None] * seen.T[None]))


def _static_compliance(basis: Modes, L: Real) -> Real:
    elastic = basis.eigenvalues > 0.0
    seen = L @ basis.shapes[:, elastic]
    return np.asarray((seen / basis.eigenvalues[elastic]) @ seen.T)


def _units(compliance: Real) -> Real:
    return np.asarray(1.0 / np.sqrt(np.diag(compliance)))


def _size(matrices: Complex, unit: Real) -> Real:
    return np.asarray(np.linalg.norm(matrices * np.outer(unit, unit), axis=(1, 2)))
