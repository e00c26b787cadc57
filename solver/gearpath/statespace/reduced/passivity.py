"""Passivity without sampling: by congruence for networks, by a Hamiltonian matrix for any state equations.

A network r'' + X r' + L r = f - P^T g, g = K P r + C P r' is positive real from forces to the velocities of the same
rows if and only if none of its energies can be negative: L, X, K and C positive semidefinite. For state equations
x' = A x + B u, y = C x + D u with a stable A the matrix

    N = [A - B S C,  -B S B^T;  C^T S C,  -A^T + C^T S B^T],       S = (D + D^T + 2 eps I)^-1

has an eigenvalue i w exactly where an eigenvalue of G(i w) + G(i w)^H + 2 eps I passes through 0 (Boyd, Balakrishnan
and Kabamba 1989); eps is rounding. Between two such frequencies the sign is that of any one point.
"""

import numpy as np
import scipy.linalg

from ...network.modal import ModalNetwork
from ...numerics.arrays import Complex, Real

_ROUNDING = 1e-12  # of the largest eigenvalue: a negative one below this is rounding
_EPSILON = 1e-7  # of the largest gain: what counts as 0 in the Hamiltonian test
_IMAGINARY = 1e-6  # of an eigenvalue's modulus: a real part below this counts as 0, to be judged by the sign there


def is_passive_network(network: ModalNetwork) -> bool:
    """Whether every component and every joint is passive, and with them the network."""
    joints = [matrix for joint in network.joints for matrix in (joint.stiffness, joint.damping)]
    tables = [network.schedule.stiffness, network.schedule.damping] if network.schedule else []
    joints += [matrix for table in tables for matrices in table.values() for matrix in matrices]
    return bool((network.eigenvalues >= 0.0).all() and (network.damping >= 0.0).all()) and all(
        map(_semidefinite, joints)
    )


def _semidefinite(matrix: Real) -> bool:
    values = np.linalg.eigvalsh(0.5 * (matrix + matrix.T))
    return bool(values.min() >= -_ROUNDING * abs(values).max())


def is_positive_real(A: Real, B: Real, C: Real, D: Real) -> bool:
    """Whether G(s) = C (s I - A)^-1 B + D is positive real, up to 1e-7 of its largest gain.

    The ports of G are pairs of a force and the velocity of its own place; rows and columns in the same order. Without
    ports nothing can be taken out.
    """
    if not len(D):
        return True
    poles = scipy.linalg.eigvals(A)
    if (poles.real > _ROUNDING * abs(poles).max(initial=0.0)).any():
        return False

    def response(w: float) -> Complex:
        return np.asarray(C @ np.linalg.solve(1j * w * np.eye(len(A)) - A, B) + D)

    natural = abs(poles.imag)
    gain = max(np.linalg.norm(response(w), 2) for w in np.unique(np.maximum(natural, 1e-3 * natural.max(initial=1.0))))
    floor = _EPSILON * gain
    S = np.linalg.inv(D + D.T + 2.0 * floor * np.eye(len(D)))
    N = np.block([[A - B @ S @ C, -B @ S @ B.T], [C.T @ S @ C, -A.T + C.T @ S @ B.T]])
    found = scipy.linalg.eigvals(N)
    crossings = np.unique(abs(found.imag[abs(found.real) <= _IMAGINARY * abs(found)]))
    ends = np.concatenate([[0.0], crossings, [2.0 * max(crossings.max(initial=0.0), natural.max(initial=1.0))]])
    middle = (ends[:-1] + ends[1:]) / 2.0
    samples = np.unique(np.concatenate([middle, natural[natural > 0.0]]))
    return all(np.linalg.eigvalsh(H + H.conj().T).min() >= -2.0 * floor for H in map(response, samples))
