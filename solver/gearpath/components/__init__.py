"""Structures known by what they do at named ports: shaft trains, rigid bodies, plates, frames, measured ones."""

from .cross_section import BarSection
from .dashpots import split_damping
from .dofs import DOFS, ROTATIONS, TRANSLATIONS
from .footprint import Footprint
from .frame import Frame
from .frame_beam import FrameBeam
from .gear_mesh import Mesh
from .gear_train import GearTrain
from .material import Material
from .matrices import Matrices
from .measured import Measured
from .modal_model import ModalModel, modal_model
from .modes import Modes, modes
from .plate import Plate
from .rigid_body import RigidBody
from .section import Section
from .shaft import Disk, Shaft, ShaftPoint
from .structure import Structure

__all__ = [
    "DOFS",
    "ROTATIONS",
    "TRANSLATIONS",
    "BarSection",
    "Disk",
    "Footprint",
    "Frame",
    "FrameBeam",
    "GearTrain",
    "Material",
    "Matrices",
    "Measured",
    "Mesh",
    "ModalModel",
    "Modes",
    "Plate",
    "RigidBody",
    "Section",
    "Shaft",
    "ShaftPoint",
    "Structure",
    "modal_model",
    "modes",
    "split_damping",
]
