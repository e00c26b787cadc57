"""Modal data of the assembled model: natural frequencies, damping, and which component moves."""

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from ...network.modal import ModalNetwork
from ...network.natural import natural_frequencies
from ...network.time_twin import time_twin
from ...numerics.arrays import Real


@dataclass(frozen=True)
class Mode:
    """An oscillating mode of the coupled model with its damping."""

    frequency: float  # |p| / (2 pi), Hz, p the pole
    damping: float  # -Re p / |p|
    shares: Real  # (components,) of the kinetic energy, sum 1


@dataclass(frozen=True)
class ModalData:
    """All oscillating modes, ascending; how many motions are rigid, and the real poles that are left (rad/s)."""

    modes: tuple[Mode, ...]
    rigid: int
    decaying: Real


def modal_data(network: ModalNetwork) -> ModalData:
    """From the eigenvalues of A of the time twin, x' = A x."""
    rigid, blocks = int((natural_frequencies(network) == 0).sum()), list(network.components.values())
    poles, vectors = scipy.linalg.eig(time_twin(network, outputs=()).A)
    order = np.argsort(abs(poles))[2 * rigid :]
    poles, speeds = poles[order], vectors[len(vectors) // 2 :, order]
    upper = np.flatnonzero(poles.imag > 0)
    energy = np.array([(abs(speeds[block]) ** 2).sum(axis=0) for block in blocks])
    shares = energy / energy.sum(axis=0)
    modes = tuple(
        Mode(float(abs(poles[i])) / (2.0 * np.pi), float(-poles[i].real / abs(poles[i])), shares[:, i]) for i in upper
    )
    return ModalData(modes, rigid, np.sort(poles[poles.imag == 0].real)[::-1])
