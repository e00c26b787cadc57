"""What a fit returns: the modes, what they leave, and what the data themselves are worth."""

from dataclasses import dataclass

import numpy as np

from ..numerics.arrays import Complex, Real


@dataclass(frozen=True)
class Place:
    """A figure, and where it is largest: the line (Hz), the response's and the force's channel (0, 1, ...)."""

    value: float
    frequency: float
    pair: tuple[int, int]

    def __str__(self) -> str:
        return f"{self.value:.2g} at {self.frequency:.5g} Hz, channels {self.pair[0]} and {self.pair[1]}"


@dataclass(frozen=True)
class DataCheck:
    """What reciprocity and passivity say of measured mobilities, relative to the largest gains."""

    skew: Place  # largest |Y_ab - Y_ba| relative to the larger gain of both
    resistance: float  # smallest eigenvalue of Re(Y), each channel in parts of sqrt(max |Y_aa|); negative: active
    resistance_frequency: float  # Hz, where it occurs


@dataclass(frozen=True)
class ModalFit:
    """Real modes fitted to mobilities of m channels (m/s per N, rad/s per N m ...),

        Y(w) = sum_r i w phi_r phi_r^T / (w_r^2 - w^2 + 2 i zeta_r w_r w)

    Passive and reciprocal by construction: every mode has positive mass, stiffness and damping. Modes below the band
    and rigid-body modes (w_r = 0) are its lower residual terms, modes above it the upper ones.
    """

    eigenvalues: Real  # w_r^2, (N,), (rad/s)^2, ascending; exactly zero for rigid-body modes
    damping_ratios: Real  # zeta_r, (N,), 0 for rigid-body modes
    shapes: Real  # phi, (m, N), mass-normalised
    band: tuple[float, float]  # Hz, first and last line
    in_band: int  # modes whose frequencies lie in the band; the others are residual terms
    error: Real  # (m, m): largest |fit - Y| over the lines relative to the FRF's own largest gain
    rms: Real  # (m, m): root mean square of the same over the lines
    worst: Place  # the largest of `error`
    correlation: float  # of the misfit from line to line: near 0 it is noise, near 1 something is not modelled
    passive: bool  # positive real: no negative energy in any mode, and checked on a grid finer than its resonances
    data: DataCheck
    notes: tuple[str, ...]

    @property
    def order(self) -> int:
        """Second-order coordinates N; a realisation in time has 2 N states."""
        return len(self.eigenvalues)

    @property
    def frequencies(self) -> Real:
        """Natural frequencies, Hz, (N,)."""
        return np.asarray(np.sqrt(self.eigenvalues) / (2.0 * np.pi))

    def mobility(self, omega: Real) -> Complex:
        """Y of the fit, (F, m, m), at the angular frequencies `omega` (rad/s, positive)."""
        w, w_r = omega[None, :], np.sqrt(self.eigenvalues)[:, None]
        lines = 1j * w / (w_r**2 - w**2 + 2j * self.damping_ratios[:, None] * w_r * w)
        return np.asarray(np.einsum("ar,rf,br->fab", self.shapes, lines, self.shapes, optimize=True))

    def __str__(self) -> str:
        found = "passive" if self.passive else "NOT passive"
        below = int(np.count_nonzero(self.frequencies < self.band[0]))
        text = (
            f"{self.order} modes ({2 * self.order} states): {self.in_band} from {self.band[0]:g} to {self.band[1]:g} "
            f"Hz, {below} below and {self.order - self.in_band - below} above; largest error {self.worst} "
            f"(of the FRF's largest gain), root mean square {float(np.sqrt((self.rms**2).mean())):.2g}; {found}"
        )
        return "".join([text, *(f"\n- {note}" for note in self.notes)])
