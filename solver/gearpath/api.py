"""The public functions: a model in, labelled results, python-control objects and FMUs out."""

from .analysis import (
    amplitude,
    expected_power,
    frequency_response,
    identify_joint,
    measure_joint,
    modal_network,
    natural_frequencies,
    operating_point,
    power_flow,
    power_matrices,
    torque_sweep,
)
from .exports import export_fmu, linearize, reduce, state_space, to_frd, validate_fmu
from .fitting import fit_mobility
from .modelfile import Model, load

__all__ = [
    "Model",
    "amplitude",
    "expected_power",
    "export_fmu",
    "fit_mobility",
    "frequency_response",
    "identify_joint",
    "linearize",
    "load",
    "measure_joint",
    "modal_network",
    "natural_frequencies",
    "operating_point",
    "power_flow",
    "power_matrices",
    "reduce",
    "state_space",
    "to_frd",
    "torque_sweep",
    "validate_fmu",
]
