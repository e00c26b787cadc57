"""Reduction of a structure to few coordinates, with its size and its error (Eq. 9 to 12)."""

from .errors import deviation, estimated_deviation, static_defect
from .fixed import LanczosReduction, constraint_modes, craig_bampton, guyan, lanczos
from .flexibility import Flexibility, inertia_relief
from .free import free_interface
from .held import Held, hold
from .interface import interface_rows, mesh_rows, port_rows
from .record import Reduction, reduced_modes, reduced_structure

__all__ = [
    "Flexibility",
    "Held",
    "LanczosReduction",
    "Reduction",
    "constraint_modes",
    "craig_bampton",
    "deviation",
    "estimated_deviation",
    "free_interface",
    "guyan",
    "hold",
    "inertia_relief",
    "interface_rows",
    "lanczos",
    "mesh_rows",
    "port_rows",
    "reduced_modes",
    "reduced_structure",
    "static_defect",
]
