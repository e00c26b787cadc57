"""Powers of several excitations together: Hermitian matrices Q with P = F^H Q F (Eq. 5b and 5c, corrected).

    Q_e  = 1/4 (R + R^H),  R = V^H D + (i w P d)^H G         input power of all excitations
    Q_p  = 1/4 (v_p^H g_p + g_p^H v_p)                       power through path p into the receiver
    Q_d  = 1/2 V^H X V  or  1/2 dv^H C dv                    power lost in a component or joint
    Q_d  = 1/4 (f^H V + V^H f)                               in a measured component, f the forces on it

F are the n_e excitations; V, G, dv and v_p, g_p are the responses to unit ones. For correlated random excitations
with the cross-spectral matrix S = E[F F^H] the expected power is E[P] = tr(Q S). Summed over all paths Q_p is
1/2 Gamma^H Re(Y_c) Gamma; the paper's 5c holds for a single excitation only.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from ..numerics.arrays import Complex, Real
from ..numerics.lines import chunks, real_times_complex
from .measured import port_forces
from .modal import ModalNetwork
from .power import element_damping, inner_damping, path_rows
from .records import Load
from .synthesis import Response, Synthesis

_SKEW = 1e-9  # of the largest entry: by so much a spectral matrix may miss being Hermitian, or an eigenvalue 0


@dataclass(frozen=True)
class PowerMatrices:
    """Hermitian power matrices of n excitations on F lines; p paths, e elements; W per unit of both excitations."""

    loads: tuple[Load, ...]
    paths: tuple[str, ...]
    elements: tuple[str, ...]
    input: Complex  # (F, n, n)
    path: Complex  # (p, F, n, n)
    dissipated: Complex  # (e, F, n, n)


def power_matrices(
    network: ModalNetwork, omega: Real, loads: Sequence[Load], progress: Callable[[int], None] = lambda _: None
) -> PowerMatrices:
    """Power matrices of the given excitations at `omega` (rad/s, positive)."""
    synthesis, rows = Synthesis(network, loads), path_rows(network)
    F, n, p, e = len(omega), len(loads), len(rows.names), len(rows.elements)
    Q_e, Q_p, Q_d = np.empty((F, n, n), complex), np.empty((p, F, n, n), complex), np.empty((e, F, n, n), complex)
    for part in chunks(F, synthesis.bytes_per_line + 16 * n**2 * (p + e)):
        w = omega[part]
        solved = synthesis.solve(w)
        Q_e[part] = _input(network, loads, solved, w)
        force, velocity = solved.force[rows.interface], real_times_complex(rows.receiver, solved.velocity)
        product = np.einsum("pjf,pkf->pfjk", velocity.conj(), force)
        Q_p[:, part] = (product + product.conj().swapaxes(-1, -2)) / 4.0
        Q_d[:, part] = _dissipated(network, loads, solved, w)
        progress(len(w))
    return PowerMatrices(tuple(loads), rows.names, rows.elements, Q_e, Q_p, Q_d)


def _input(network: ModalNetwork, loads: Sequence[Load], solved: Response, w: Real) -> Complex:
    """Q_e (F, n, n): the conjugate of a force is the elastic velocity, see `synthesis.load_power`."""
    columns = np.array([load.column for load in loads])
    drive = np.array([w**2 if load.is_transmission_error else np.ones_like(w) for load in loads])
    v = real_times_complex(columns, solved.elastic)  # (k, j, F): at load k under load j
    R = np.einsum("kjf,kf->fjk", v.conj(), drive)
    held = np.array(
        [
            np.zeros(len(network.relative)) if d is None else network.relative @ d
            for d in (load.mesh_displacement for load in loads)
        ]
    )
    if held.any():
        R = R + np.einsum("jr,rkf,f->fjk", held, solved.force, -1j * w)
    return np.asarray((R + R.conj().swapaxes(-1, -2)) / 4.0)


def _dissipated(network: ModalNetwork, loads: Sequence[Load], solved: Response, w: Real) -> Complex:
    """Q_d (e, F, n, n)."""
    damping, joints = element_damping(network, w)
    slip = real_times_complex(network.relative, solved.velocity)
    out = []
    for name, modes in network.components.items():
        V = solved.elastic[modes]
        if name in network.measured:  # 1/2 Re(f^H v) of the forces on its channels
            product = np.einsum("rjf,rkf->fjk", port_forces(network, loads, solved.force, modes).conj(), V)
            out.append((product + product.conj().swapaxes(-1, -2)) / 2.0)
            continue
        out.append(np.einsum("rjf,rf,rkf->fjk", V.conj(), damping[modes], V, optimize=True))
        for places, weight in inner_damping(network, w):
            dv = slip[places.get(name, slice(0, 0))]
            out[-1] += np.einsum("rjf,f,rkf->fjk", dv.conj(), weight, dv)
    for at, (C, K_lost) in zip(network.joint_slices().values(), joints):
        dv = slip[at]
        drag = real_times_complex(C, dv) + real_times_complex(K_lost, dv) / w
        out.append(np.einsum("rjf,rkf->fjk", dv.conj(), drag))
    return np.asarray(0.5 * np.array(out))


def checked_spectrum(spectrum: object, names: Sequence[str], lines: int) -> Complex:
    """A cross-spectral matrix S as (F or 1, n, n); raises InputError unless Hermitian and positive semidefinite.

    S is given as one matrix (n, n), as (F, n, n), or as (n,) or (F, n) powers of uncorrelated excitations.
    """
    n = len(names)
    try:
        S = np.asarray(spectrum, complex)
    except (TypeError, ValueError) as error:
        raise InputError(f"spectrum: {spectrum!r} is not a matrix; give {n} x {n} numbers") from error
    if S.shape in ((n,), (lines, n)) and S.shape != (n, n):
        S = S[..., None] * np.eye(n)
    if S.shape not in ((n, n), (lines, n, n)):
        raise InputError(
            f"spectrum: shape {S.shape} does not fit {n} inputs and {lines} frequencies; give ({n}, {n}) or "
            f"({lines}, {n}, {n}), or ({n},) or ({lines}, {n}) for uncorrelated inputs"
        )
    S = S.reshape(-1, n, n)
    if not np.isfinite(S).all():
        raise InputError("spectrum: has entries that are not finite; give finite numbers")
    # inputs have different units: judged after scaling each to a unit autospectrum
    size = np.sqrt(abs(np.diagonal(S, axis1=-2, axis2=-1)).max(axis=0))
    scaled = S / np.where(size > 0, size, 1.0)[:, None] / np.where(size > 0, size, 1.0)
    skew = abs(scaled - scaled.conj().swapaxes(-1, -2)).max(initial=0.0)
    if skew > _SKEW:
        raise InputError(f"spectrum: S - S^H is {skew:.2g} of the autospectra; give a Hermitian matrix, S_jk = S_kj*")
    lowest = np.linalg.eigvalsh(scaled).min(initial=0.0)
    if lowest < -_SKEW:
        raise InputError(
            f"spectrum: has a negative eigenvalue ({lowest:.2g} of the autospectra), as no excitation can have; "
            "keep |S_jk|^2 <= S_jj S_kk"
        )
    return np.asarray((S + S.conj().swapaxes(-1, -2)) / 2.0)


def expected(Q: Complex, S: Complex) -> Real:
    """E[P] = tr(Q S), real; Q (..., F, n, n), S (F or 1, n, n)."""
    return np.asarray(np.einsum("...jk,...kj->...", Q, np.broadcast_to(S, Q.shape)).real)
