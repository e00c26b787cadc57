"""The unsynthesised reference: the whole machine in physical coordinates, solved directly at every frequency.

Independent of the synthesis: no modes, no component mobilities, no elimination of the interface. Coordinates u and
joint forces g are solved together,

    [ K + i w C - w^2 M    B^T   ] [ u ]   [ f ]
    [ (K_p + i w C_p) B    -I    ] [ g ] = [ -(K_p + i w C_p) B d e ]

(with loss factors (1 + i eta) K and (1 + i eta) K_p; a measured component has the rows u + X B^T g = X f of its
receptances X = Y / (i w), which are not inverted), so that joint forces keep their digits across stiff joints, and
joint stiffness is never inverted. The solution is refined with residuals in extended precision (where the platform
has it): free shafts at low frequency are badly conditioned in physical coordinates, and a reference must be better
than what it judges.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
import scipy.sparse
import scipy.sparse.linalg
from numpy.typing import NDArray

from ..components import Structure
from ..numerics.arrays import Complex, Real
from .assemble import Network
from .power import ratio
from .reference_parts import Part, load_of, massless, measured_parts, reference_parts

Extended = NDArray[np.longdouble]
ExtendedComplex = NDArray[np.clongdouble]
_REFINEMENTS = 10
_EARNEST = 1e-12  # of |R|^T |K| |R|: more is no rounding


@dataclass(frozen=True)
class Reference:
    """Direct solution for the network's excitation with unit amplitude, F lines."""

    force: Complex  # (n_p, F): all joints, stacked
    velocity: Complex  # (n, F): physical velocities of all coordinates
    input_power: Real  # (F,)
    path_power: Real  # (n_p, F): 1/2 Re(conj(v_receiver) g) of every joint degree of freedom
    alpha: Real  # (F,): through the power flow paths


def reference_solution(network: Network, omega: Real) -> Reference:
    """Solve the assembled machine at each angular frequency (rad/s), one pivoted factorisation a line.

    Raises AccuracyError where damping has no matrix, as modal damping of a plate or frame (`reference_parts`).
    """
    parts = reference_parts(network)
    measured = measured_parts(network, parts, omega)
    parts = [massless(part) if k in measured else part for k, part in enumerate(parts)]
    motion = scipy.sparse.hstack([part.motion for part in parts], format="csc")
    sparse = any(scipy.sparse.issparse(part.structure.mass) for part in parts)
    M, K, H, C = (_sparse_blocks if sparse else _extended_blocks)(parts)
    losses = np.concatenate([np.full(len(joint.dofs), joint.loss_factor) for joint in network.joints])
    source, receiver = (
        np.vstack([getattr(joint, side) for joint in network.joints]) @ motion for side in ("source", "receiver")
    )
    B = source - receiver
    K_p, C_p = (
        scipy.linalg.block_diag(*(getattr(joint, name) for joint in network.joints))
        for name in ("stiffness", "damping")
    )
    load = load_of(network, parts, next(item for item in network.loads if item.name == network.excitation))
    n_p, n = B.shape
    starts = np.cumsum([0, *(part.motion.shape[1] for part in parts)])
    receptances = [(slice(starts[k], starts[k + 1]), X) for k, X in measured.items()]
    # the unknown forces are counted in units of a joint's stiffness times a unit motion: keeps the pivots sensible
    unit = max(float(abs(K_p).max()), 1.0)
    force, velocity = np.empty((n_p, len(omega)), complex), np.empty((motion.shape[0], len(omega)), complex)
    input_power, path_power = np.empty(len(omega)), np.empty((n_p, len(omega)))
    for k, w in enumerate(omega):
        Z = ((1.0 + 1j * losses[:, None]) * K_p + 1j * w * C_p) / unit
        dynamic, right = K + 1j * (H + w * C) - w**2 * M, (unit * B.T).astype(complex)
        b = np.zeros(n + n_p, complex)
        if load.mesh_displacement is None:
            b[:n] = load.column
        else:
            b[:n] = w**2 * load.column
            b[n:] = -Z @ (B @ load.mesh_displacement)
        for rows, X in receptances:
            right[rows], b[rows] = X[:, :, k] @ right[rows], X[:, :, k] @ b[rows]
        x = (_solve_sparse if sparse else _solve_refined)(dynamic, right, Z @ B, b)
        g, v = unit * x[n:], 1j * w * x[:n]  # powers are small beside |v||F| at low frequency: taken before rounding
        input_power[k] = 0.5 * (load.column @ v).real * (w**2 if load.is_transmission_error else 1.0)
        if load.mesh_displacement is not None:  # the physical motion, and the power of e against the joints
            own = 1j * w * load.mesh_displacement
            v = v + own
            input_power[k] += 0.5 * np.real(np.vdot(B @ own, g))
        force[:, k], velocity[:, k] = g, motion @ v.astype(complex)
        path_power[:, k] = 0.5 * np.real(np.conj(receiver @ v) * g)
    carried = [joint.name in network.paths for joint in network.joints for _ in joint.dofs]
    return Reference(force, velocity, input_power, path_power, ratio(path_power[carried].sum(axis=0), input_power))


def _solve_refined(dynamic: ExtendedComplex, right: Complex, lower: Complex, b: Complex) -> ExtendedComplex:
    """Solve [dynamic, right; lower, -I] x = b with iterative refinement, residuals in extended precision."""
    A = np.block([[dynamic, right], [lower, -np.eye(len(lower))]])
    factors = scipy.linalg.lu_factor(A.astype(complex))
    x = np.zeros(b.shape, np.clongdouble)
    for _ in range(_REFINEMENTS):
        change = scipy.linalg.lu_solve(factors, (b - A @ x).astype(complex))
        x += change
        if abs(change).max() <= np.finfo(float).eps * float(abs(x).max()):
            break
    return x


def _solve_sparse(dynamic: Any, right: Complex, lower: Complex, b: Complex) -> Complex:
    """The same for sparse structures, in double precision."""
    rows = [
        [dynamic, scipy.sparse.csc_array(right)],
        [scipy.sparse.csc_array(lower), -scipy.sparse.eye_array(len(lower))],
    ]
    A = scipy.sparse.csc_array(scipy.sparse.block_array(rows))
    factors = scipy.sparse.linalg.splu(A)
    x = factors.solve(b)
    for _ in range(2):
        x += factors.solve(b - A @ x)
    return np.asarray(x)


def _sparse_blocks(parts: Sequence[Part]) -> tuple[Any, Any, Any, Any]:
    """Block-diagonal M, K, eta K and C."""
    matrices = [(p.structure.mass, p.structure.stiffness, p.hysteresis, p.damping) for p in parts]
    return tuple(scipy.sparse.block_diag(blocks, format="csc") for blocks in zip(*matrices))


def _extended_blocks(parts: Sequence[Part]) -> tuple[Extended, Extended, Extended, Extended]:
    """Block-diagonal M, K, eta K and C in extended precision, all but M exactly free of rigid-body motion."""
    return (
        _block_diagonal([np.asarray(p.structure.mass).astype(np.longdouble) for p in parts]),
        _block_diagonal([_exactly_free(p.structure, np.asarray(p.structure.stiffness)) for p in parts]),
        _block_diagonal([_exactly_free(p.structure, p.hysteresis) for p in parts]),
        _block_diagonal([_exactly_free(p.structure, p.damping) for p in parts]),
    )


def _exactly_free(structure: Structure, matrix: Real) -> Extended:
    """Stiffness or damping without the rounding that resists rigid-body motion, in extended precision.

    Element stiffnesses of 1e11 N/m leave a net force of 1e-5 N per m of rigid motion, which counts beside the
    inertia forces at low frequency; damping likewise would dissipate. K - M R R^T K and its transpose, R the
    mass-normalised rigid motions. A damping matrix may resist them in earnest; then it is left alone.
    """
    M, K = np.asarray(structure.mass).astype(np.longdouble), matrix.astype(np.longdouble)
    basis: list[Extended] = []
    for column in structure.rigid_modes.T.astype(np.longdouble):
        for _ in range(2):  # twice is enough to be orthogonal to rounding
            for other in basis:
                column = column - other * (other @ (M @ column))
        basis.append(column / np.sqrt(column @ (M @ column)))
    if not basis:
        return K
    R = np.array(basis).T
    # by the power that each motion takes: single rows of a damping matrix may hold nothing but rounding
    if (np.diag(R.T @ K @ R) > _EARNEST * np.diag(abs(R).T @ abs(K) @ abs(R))).any():
        return K
    momentum = M @ R
    K = K - momentum @ (R.T @ K)
    return K - (K @ R) @ momentum.T


def _block_diagonal(blocks: Sequence[Extended]) -> Extended:
    """Block-diagonal matrix that keeps extended precision."""
    ends = np.cumsum([len(block) for block in blocks])
    out = np.zeros((int(ends[-1]),) * 2, np.longdouble)
    for block, end in zip(blocks, ends):
        out[end - len(block) : end, end - len(block) : end] = block
    return out
