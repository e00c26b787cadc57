"""The solver's transfers on a fine grid, for the curves that an FMU was compared with at a few frequencies."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..fmu.checks import Comparison
from ..network.modal import ModalNetwork
from ..network.natural import natural_frequencies
from ..numerics.arrays import Complex, Real
from ..results.labelled import labelled_response

POINTS = 500  # of the fine grid, beside the natural frequencies
SAME = 1e-6  # a transfer that differs by less, relative to its largest value, is the one compared


class Transfers:
    """Finds for a comparison the input it belongs to, and draws the transfer between the compared frequencies."""

    def __init__(self, network: ModalNetwork, comparisons: Sequence[Comparison]) -> None:
        known = {output.name for output in network.outputs if output.quantity != "power"}
        self._names = [name for name in dict.fromkeys(item.name for item in comparisons) if name in known]
        self._at: dict[bytes, Complex] = {}
        self._network = network
        self.frequency: Real = np.empty(0)
        grids = [item.solver_frequency for item in comparisons if len(item.solver_frequency)]
        if self._names and grids:
            every = np.concatenate(grids)
            natural = natural_frequencies(network)
            natural = natural[(natural > every.min()) & (natural < every.max())]
            self.frequency = np.unique(np.concatenate([np.geomspace(every.min(), every.max(), POINTS), natural, every]))
            self._fine = self._response(self.frequency)

    def load(self, item: Comparison) -> str | None:
        """The input that the comparison's transfer starts from; None where no transfer of the model is like it."""
        if item.name not in self._names or not len(item.solver_frequency):
            return None
        found = self._response(item.solver_frequency)[:, self._names.index(item.name)]
        size = abs(item.solver).max()
        for k, load in enumerate(self._network.loads):
            if size and abs(found[:, k] - item.solver).max() <= SAME * size:
                return load.name
        return None

    def curve(self, name: str, load: str) -> Complex:
        """The transfer from an input to an output, on `frequency`."""
        loads = [item.name for item in self._network.loads]
        return np.asarray(self._fine[:, self._names.index(name), loads.index(load)])

    def _response(self, frequency: Real) -> Complex:
        """All transfers, (F, outputs, inputs)."""
        key = np.asarray(frequency, float).tobytes()
        if key not in self._at:
            self._at[key] = np.asarray(labelled_response(self._network, frequency, self._names).values)
        return self._at[key]
