"""Systems that their own source text describes: matrices of files are replaced by their modes."""

from dataclasses import replace

from ..components import DOFS, Matrices, modal_model
from .ports import Ports
from .system import System


def self_contained(system: System) -> System:
    """The system with the modes of its components of matrices in their place, as they are seen at their ports.

    A large component in the modes that its reduction to the band of the system left. Nothing is lost for the joints,
    sensors and actuators; `repr` then gives the system again.
    """
    if not any(isinstance(component, Matrices) for component in system.components.values()):
        return system
    ports, components = Ports(system), dict(system.components)
    for name, component in system.components.items():
        if not isinstance(component, Matrices):
            continue
        basis = ports.bases[name]
        rows = component.structure(DOFS, {port: port for port in component.ports}).ports
        ratios = [component.modal_damping] * len(basis.eigenvalues)
        components[name] = modal_model(basis, ratios, rows, component.places, component.loss_factor)
    return replace(system, components=components)
