"""Frequency responses from any load to any linear output of the network."""

from collections.abc import Callable, Sequence

import numpy as np

from ..errors import InputError
from ..numerics.arrays import Complex, Real
from ..numerics.lines import chunks, real_times_complex
from .modal import ModalNetwork
from .records import Load, Output
from .synthesis import Response, Synthesis

_FACTORS = {"displacement": -1, "velocity": 0, "acceleration": 1}  # powers of i w on the velocity


def frequency_response(
    network: ModalNetwork,
    omega: Real,
    outputs: Sequence[Output],
    loads: Sequence[Load],
    progress: Callable[[int], None] = lambda _: None,
) -> Complex:
    """Response of every output to every unit load, (F, outputs, loads), at `omega` (rad/s, positive)."""
    synthesis = Synthesis(network, loads)
    H = np.empty((len(omega), len(outputs), len(loads)), complex)
    for part in chunks(len(omega), synthesis.bytes_per_line):
        H[part] = np.moveaxis(read_outputs(network, outputs, synthesis.solve(omega[part]), omega[part]), -1, 0)
        progress(part.stop - part.start)
    return H


def read_outputs(network: ModalNetwork, outputs: Sequence[Output], solved: Response, omega: Real) -> Complex:
    """The outputs from a solved response, (outputs, m, F)."""
    slices = network.joint_slices()
    out = np.empty((len(outputs), *solved.force.shape[1:]), complex)
    for k, output in enumerate(outputs):
        if output.quantity == "power":
            raise InputError(f"{output.name} is a power, not linear in the inputs; use gearpath.power_flow for it")
        if output.quantity == "force":
            assert output.joint is not None
            out[k] = solved.force[slices[output.joint].start + output.dof]
            continue
        assert output.row is not None
        factor = (1j * omega) ** _FACTORS[output.quantity]
        out[k] = factor * real_times_complex(output.row[None, :], solved.velocity)[0]
    return out
