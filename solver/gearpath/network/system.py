"""The whole machine as data: components, joints, excitation, actuators and sensors.

Every class here and below is a frozen dataclass of plain values, so that `repr` of a system is Python source that
builds it again: this is how the python FMU carries its model.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from ..components import Frame, GearTrain, Matrices, Measured, ModalModel, Plate, RigidBody
from ..joints import Joint, Port
from .records import MeshSource as MeshSource
from .records import Tone as Tone  # named here because the repr of a system names it

Vector = tuple[float, float, float]
Component = GearTrain | RigidBody | Plate | Frame | Matrices | ModalModel | Measured


@dataclass(frozen=True)
class MeshExcitation:
    """Transmission error of a mesh, amplitude in m."""

    component: str
    mesh: str
    displacement: float = 1.0e-6


@dataclass(frozen=True)
class PointExcitation:
    """A force (N) or moment (N m) on one degree of freedom of a port."""

    port: Port
    dof: str
    force: float = 1.0
    at: Vector | None = None  # on a rigid body; None is the centre of gravity


@dataclass(frozen=True)
class Actuator:
    """An additional force input on one degree of freedom."""

    port: Port
    dof: str
    at: Vector | None = None


@dataclass(frozen=True)
class Sensor:
    """An additional motion output on one degree of freedom."""

    port: Port
    dof: str
    quantity: Literal["displacement", "velocity", "acceleration"] = "velocity"
    at: Vector | None = None


@dataclass(frozen=True)
class Operation:
    """A steady torque through a gear train, at which its rolling bearings work."""

    component: str  # the gear train
    torque: float  # N m, on the driving shaft, in the sense that presses the teeth together
    shaft: str | None = None  # where it enters; None: the first gear's of the first mesh
    speed: float | None = None  # of that shaft, rev/min: only to warn of centrifugal forces


@dataclass(frozen=True)
class System:
    """A machine; names of components, joints and meshes are unique."""

    name: str
    dofs: tuple[str, ...]
    components: Mapping[str, Component]
    joints: Mapping[str, Joint]
    excitation: MeshExcitation | PointExcitation
    actuators: Mapping[str, Actuator] = field(default_factory=dict)
    sensors: Mapping[str, Sensor] = field(default_factory=dict)
    loss_frequency: float = 1000.0  # Hz, where the viscous equivalents of joints' loss factors dissipate alike
    band: float = 5000.0  # Hz, up to where reduced components must be exact
    vectors: Mapping[str, int] = field(default_factory=dict)  # interior vectors of reduced components, where chosen
    source: MeshSource | None = None  # of native FMUs only
    operation: Operation | None = None
