"""The mobility synthesis: interface forces and motions of the coupled network, line by line in frequency.

    (I + Z W) g = Z (B Y f_e - i w e),    W = B Y B^T,    Z = (1 + i eta) K/(i w) + C   (Eq. 3, without inverting K)
    v = Y (f_e - B^T g)                                                            (Eq. 4)

Y is never stored: the component mobilities are modal (Eq. 11), so W is one real product of the packed residues
P_pr P_qr with the modal responses of the chunk. A measured component's coordinates are its channels, and its Y is
that of its table.

At the free-free resonance of an undamped component Y is infinite although the coupled answer is not. Lines that close
to one (`_RESONANT`) are solved in modal coordinates without eliminating the components:

    [diag(L - w^2 + i w X) + P^T i w Z P] q~ = f - P^T i w Z P d e,    g = i w Z P (q~ + d e)

with f = column of a force, w^2 column e of a transmission error, and the elastic velocity i w q~.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..components.mobility import modal_response
from ..errors import AccuracyError
from ..numerics.arrays import Complex, Real
from ..numerics.lines import real_times_complex, solve_lines
from .measured import MeasuredRows, velocities
from .modal import ModalNetwork
from .records import Load

_RESONANT = 1e-6  # distance |w_r^2 - w^2 + i w X_r| / w^2 of a mode, below which its mobility loses six digits or more


@dataclass(frozen=True)
class Response:
    """Coupled response to unit loads on a chunk of F lines, m loads at a time."""

    force: Complex  # g (n_p, m, F): joint forces on the receivers
    elastic: Complex  # modal velocity q~' (N, m, F), without the motion i w d e of a transmission error itself
    velocity: Complex  # modal velocity of the physical motion, q~' + i w d e, (N, m, F)


@dataclass(frozen=True)
class _Residues:
    """P_pr P_qr of one component, p <= q, on the interface rows that it touches."""

    modes: slice
    rows: NDArray[np.intp]  # interface rows with motion in this component, (k,)
    products: Real  # (k (k + 1) / 2, N_c)
    unpack: NDArray[np.intp]  # (k, k): where each pair stands in `products`

    @classmethod
    def of(cls, P: Real, modes: slice) -> "_Residues":
        """Residues of the component whose modes are the given slice."""
        rows = np.flatnonzero(P[:, modes].any(axis=1))
        p, q = np.triu_indices(len(rows))
        unpack = np.zeros((len(rows), len(rows)), np.intp)
        unpack[p, q] = unpack[q, p] = np.arange(len(p))
        shapes = P[rows, modes]
        return cls(modes, rows, shapes[p] * shapes[q], unpack)


class Synthesis:
    """What does not depend on frequency, prepared once: residues of the components, joint matrices, loads."""

    def __init__(self, network: ModalNetwork, loads: Sequence[Load]) -> None:
        self.network, self.loads = network, tuple(loads)
        self.P = network.relative
        blocks = network.components
        self._residues = [_Residues.of(self.P, blocks[name]) for name in blocks if name not in network.measured]
        self._measured = [MeasuredRows.of(self.P, blocks[name], item) for name, item in network.measured.items()]
        K, C = network.interface_matrices()
        H = network.interface_hysteresis()
        self._joints = np.vstack([C, K + np.diag(H)])
        self._idle = ~self._joints.reshape(2, len(C), -1).any(axis=(0, 2))  # free: nothing, whatever pivoting leaves
        losses = network.joint_losses()
        self._phase = np.where(H > 0.0, 1.0, losses - 1j)[:, None] if losses.any() or H.any() else -1j  # of w Z / K
        self._stiffness = network.eigenvalues + 1j * network.hysteresis if network.loss_factors else network.eigenvalues

    @property
    def bytes_per_line(self) -> int:
        """Working set of one frequency line."""
        n_p, N = self.P.shape
        tables = 3 * sum(part.component.channels**2 for part in self._measured)
        return int(16 * (N * (1 + 3 * len(self.loads)) + 5 * n_p**2 + 4 * n_p * len(self.loads) + tables))

    def solve(self, omega: Real) -> Response:
        """Coupled response at the angular frequencies `omega` (rad/s, all positive).

        Raises AccuracyError where it is not finite: at an undamped resonance of the whole machine.
        """
        network, P = self.network, self.P
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            response = modal_response(self._stiffness, network.damping, omega)
        # |i w / (w_r^2 - w^2 + i w X_r)| = 1 / (w * relative distance); NaN where both parts are 0
        resonant = np.flatnonzero(~(abs(response) * (omega * _RESONANT) < 1.0).all(axis=0))
        response[:, resonant] = 0.0  # replaced below
        tables = [part.component.at(omega) for part in self._measured]
        for part in self._measured:
            response[part.block] = 0.0
        free, own = self._free_motion(response, tables, omega)
        W = self._interface_mobility(response, tables)
        A = self._joint_force(W, omega)
        diagonal = np.arange(len(P))
        A[diagonal, diagonal] += 1.0
        relative = real_times_complex(P, free if own is None else free + own)
        g = solve_lines(A, self._joint_force(relative, omega))
        g[self._idle] = 0.0
        pull = real_times_complex(P.T, g)
        elastic = free - response[:, None] * pull
        for part, Y in zip(self._measured, tables):
            elastic[part.block] -= velocities(Y, pull[part.block])
        for line in resonant:
            own_tables = [Y[:, :, line] for Y in tables]
            self._solve_coupled(float(omega[line]), own_tables, g[:, :, line], elastic[:, :, line])
        finite = np.isfinite(elastic).all(axis=(0, 1)) & np.isfinite(g).all(axis=(0, 1))
        if not finite.all():
            raise _not_finite(float(omega[np.argmin(finite)]))
        return Response(g, elastic, elastic if own is None else elastic + own)

    def _solve_coupled(self, w: float, tables: Sequence[Complex], force: Complex, elastic: Complex) -> None:
        """Solve one line in modal coordinates; writes `force` (n_p, m) and `elastic` (N, m).

        Rows of a measured component are multiplied by Y / (i w), for its Y may be singular.
        """
        network, P = self.network, self.P
        C, K = np.split(self._joints, 2)
        Z = 1j * self._phase * K + 1j * w * C
        own = np.diag(self._stiffness - w**2 + 1j * w * network.damping)
        between = P.T @ (Z @ P)
        held = np.column_stack(  # d of each load; 0 for a force
            [np.zeros(len(own)) if x.mesh_displacement is None else x.mesh_displacement for x in self.loads]
        )
        push = np.column_stack([x.column * (w**2 if x.is_transmission_error else 1.0) for x in self.loads])
        right = push - P.T @ (Z @ (P @ held))
        for part, Y in zip(self._measured, tables):
            own[part.block, part.block] = np.eye(len(Y))
            between[part.block] = Y / (1j * w) @ between[part.block]
            right[part.block] = Y / (1j * w) @ right[part.block]
        try:
            q = np.linalg.solve(own + between, right)
        except np.linalg.LinAlgError as error:
            raise _not_finite(w) from error
        force[:], elastic[:] = Z @ (P @ (q + held)), 1j * w * q

    def _interface_mobility(self, response: Complex, tables: Sequence[Complex]) -> Complex:
        """W = B Y B^T (n_p, n_p, F), summed over the components."""
        W = np.zeros((len(self.P), len(self.P), response.shape[1]), complex)
        for part in self._residues:
            packed = real_times_complex(part.products, response[part.modes])
            W[np.ix_(part.rows, part.rows)] += packed[part.unpack]
        for known, Y in zip(self._measured, tables):
            W[np.ix_(known.rows, known.rows)] += known.interface(Y)
        return W

    def _joint_force(self, motion: Complex, omega: Real) -> Complex:
        """Z @ motion; motion (n_p, m, F)."""
        both = real_times_complex(self._joints, motion)
        viscous, elastic = both[: len(motion)], both[len(motion) :]
        elastic *= np.asarray(self._phase)[..., None] / omega
        viscous += elastic
        return viscous

    def _free_motion(self, response: Complex, tables: Sequence[Complex], omega: Real) -> tuple[Complex, Complex | None]:
        """Modal velocities of the uncoupled components under each load; and i w d e of transmission errors."""
        free = np.empty((len(response), len(self.loads), len(omega)), complex)
        own = None
        for k, load in enumerate(self.loads):
            if load.mesh_displacement is None:
                free[:, k] = response * load.column[:, None]
                for part, Y in zip(self._measured, tables):
                    free[part.block, k] = np.einsum("abf,b->af", Y, load.column[part.block])
                continue
            free[:, k] = response * (load.column[:, None] * omega**2)
            own = np.zeros_like(free) if own is None else own
            own[:, k] = load.mesh_displacement[:, None] * (1j * omega)
        return free, own


def _not_finite(w: float) -> AccuracyError:
    return AccuracyError(
        f"the response is not finite at {w / (2.0 * np.pi):.12g} Hz, an undamped resonance of the machine; "
        "add damping or change the frequency"
    )


def load_power(network: ModalNetwork, load: Load, solved: Response, which: int, omega: Real) -> Real:
    """Input power of a unit load, W: `which` is its place among the solved loads.

    A force: P_e = 1/2 Re(v_e^* F). A transmission error: P_e = 1/2 Re(v_e^* F_e) with F_e = m_e w^2 e acting on
    v_e = column @ q~' / m_e (the mass cancels), plus what e does against joints that resist the spin d itself (zero
    unless a bearing has stiffness about the shaft axis).
    """
    v = real_times_complex(load.column[None, :], solved.elastic[:, which])[0]
    if load.mesh_displacement is None:
        return np.asarray(0.5 * v.real)
    held = (network.relative @ load.mesh_displacement) @ solved.force[:, which]
    return np.asarray(0.5 * (omega**2 * v.real + omega * held.imag))
