"""Rules between several keys of a model file; every breach is a ModelError."""

from ..tables import FileTable
from .components import check_components
from .extras import check_actuators, check_excitation, check_frequency, check_sensors
from .joints import check_joints
from .names import check_names
from .network import check_network
from .source import check_source

_RULES = (
    check_frequency,
    check_names,
    check_components,
    check_joints,
    check_network,
    check_excitation,
    check_actuators,
    check_sensors,
    check_source,
)


def check_file(file: FileTable) -> None:
    """Apply every rule, in this order."""
    for rule in _RULES:
        rule(file)


__all__ = ["check_file"]
