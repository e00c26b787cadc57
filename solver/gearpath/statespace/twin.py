"""The network as a `control.StateSpace` with named inputs, outputs and states."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..network.modal import ModalNetwork
from ..network.time_twin import time_twin
from .signals import signal_name, with_units

if TYPE_CHECKING:
    from .named import StateSpace

_STATE_UNIT = "J^0.5"


def state_space(network: ModalNetwork) -> StateSpace:
    """x' = A x + B u, y = C x + D u: all loads as inputs, all linear outputs (SI units, as the FMU variables).

    States come in two halves, mode by mode: `component/mode_k/x`, the modal displacement times the mode's angular
    frequency, and `component/mode_k/v`, the modal velocity without what the transmission error adds at once. Modes are
    mass-normalised: both are in J^0.5, and half the squared norm of an elastic mode's pair is its energy. Units of all
    signals are in `input_units`, `output_units`, `state_units` and the object's own docstring.
    """
    from .named import StateSpace

    network = network.viscous()  # what can be simulated: its modes name the states
    twin = time_twin(network)
    modes = [
        f"{name}/mode_{k + 1}" for name, block in network.components.items() for k in range(block.stop - block.start)
    ]
    plant = StateSpace(
        twin.A,
        twin.B,
        twin.C,
        twin.D,
        inputs=[signal_name(load.name) for load in twin.loads],
        outputs=[signal_name(output.name) for output in twin.outputs],
        states=[f"{mode}/x" for mode in modes] + [f"{mode}/v" for mode in modes],
        name=signal_name(network.name),
        remove_useless_states=False,
    )
    about = f"State space of {network.name}: loads to all outputs that are linear in them."
    with_units(
        plant, about, [u.unit for u in twin.loads], [y.unit for y in twin.outputs], [_STATE_UNIT] * twin.A.shape[0]
    )
    return plant
