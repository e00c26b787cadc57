"""Rolling bearings from their geometry: load, stiffness and equilibrium (Lim and Singh, J. Sound Vib. 139, 1990).

Frame: z is the bearing axis, right-handed axes, rotations by the right hand. A displacement q is that of the inner ring
relative to the outer ring, the load f(q) what acts on the inner ring; f = grad U and K = hess U of a convex energy, so
that K is symmetric and positive semidefinite. Arrays hold the six degrees of freedom ux, uy, uz, rx, ry, rz (m, rad;
N, N m); the bearing turns freely about z: row and column rz are zero. Lengths in m, angles in rad.
"""

from .ball import BallBearing
from .catalogue import catalogue_bearing, designations
from .damping import loss_factor_damping, proportional_damping
from .equilibrium import Equilibrium
from .roller import RollerBearing
from .rolling import RollingBearing
from .stack import BearingStack, back_to_back, face_to_face, tandem

__all__ = [
    "BallBearing",
    "BearingStack",
    "Equilibrium",
    "RollerBearing",
    "RollingBearing",
    "back_to_back",
    "catalogue_bearing",
    "designations",
    "face_to_face",
    "loss_factor_damping",
    "proportional_damping",
    "tandem",
]
