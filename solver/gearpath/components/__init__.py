"""Structures known by what they do at named ports: shaft trains and rigid bodies."""

from .dofs import DOFS, ROTATIONS, TRANSLATIONS
from .gear_train import Disk, GearTrain, Mesh, Shaft, ShaftPoint
from .material import Material
from .modes import Modes, modes
from .rigid_body import RigidBody
from .section import Section
from .structure import Structure

__all__ = [
    "DOFS",
    "ROTATIONS",
    "TRANSLATIONS",
    "Disk",
    "GearTrain",
    "Material",
    "Mesh",
    "Modes",
    "RigidBody",
    "Section",
    "Shaft",
    "ShaftPoint",
    "Structure",
    "modes",
]
