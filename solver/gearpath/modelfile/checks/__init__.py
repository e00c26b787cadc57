"""Rules between several keys of a model file; every breach is a ModelError."""

from pathlib import Path

from ..tables import FileTable
from .bearings import check_operation
from .components import check_components
from .extras import check_actuators, check_excitation, check_frequency, check_sensors
from .foreign import check_foreign
from .joints import check_joints
from .measured import check_measured
from .names import check_names
from .network import check_network
from .source import check_source

_BEFORE = (check_frequency, check_names, check_components, check_operation)
_AFTER = (
    check_network,
    check_excitation,
    check_actuators,
    check_sensors,
    check_source,
)


def check_file(file: FileTable, folder: Path) -> None:
    """Apply every rule, in this order; `folder` is where the model file is."""
    for rule in _BEFORE:
        rule(file)
    check_foreign(file, folder)
    check_measured(file, folder)
    check_joints(file, folder)
    for rule in _AFTER:
        rule(file)


__all__ = ["check_file"]
