"""Undamped natural frequencies of the assembled machine."""

import numpy as np
import scipy.linalg

from ..components.massless import STATIC_HZ
from ..numerics.arrays import Real
from .measured import fitted
from .modal import ModalNetwork


def natural_frequencies(network: ModalNetwork) -> Real:
    """Square roots of the eigenvalues of L + P^T K P, Hz, ascending; rigid-body modes come out as 0.

    Measured components take part with the modes of their fit. Those of STATIC_HZ and above, which stand for the own
    flexibility of motions without mass, are left out.
    """
    network = fitted(network)
    K, _ = network.interface_matrices()
    P = network.relative
    values = scipy.linalg.eigvalsh(np.diag(network.eigenvalues) + P.T @ K @ P)
    rounding = 16.0 * np.finfo(float).eps * values[-1]
    found = np.sqrt(np.where(values > rounding, values, 0.0)) / (2.0 * np.pi)
    return np.asarray(found[found < (1.0 - 1e-6) * STATIC_HZ])
