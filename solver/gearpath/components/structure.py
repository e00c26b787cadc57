"""An elastic structure as the network sees it: matrices, rigid-body motions and what its ports read."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from ..numerics.arrays import Real, Sparse


@dataclass(frozen=True)
class Structure:
    """A linear structure in n generalised coordinates q: M q'' + C q' + (1 + i eta) K q = f.

    C is modal: each elastic free-free mode has the damping ratio `modal_damping`, and D^T D of `dashpots` beside.
    eta is `loss_factor`.
    """

    mass: Real | Sparse  # (n, n), symmetric positive definite
    stiffness: Real | Sparse  # (n, n), symmetric positive semidefinite
    rigid_modes: Real  # (n, r), a basis of the null space of the stiffness
    modal_damping: float  # damping ratio of every elastic mode
    ports: Mapping[str, Real]  # port name -> (6, n): motion ux uy uz rx ry rz of the port = rows @ q
    meshes: Mapping[str, "MeshMotion"] = field(default_factory=dict)
    loss_factor: float = 0.0
    damping_ratios: Real | None = None  # (n,), where the coordinates are the modes themselves, each with its own
    dashpots: Real | None = None  # D (k, n), likewise: what couples the modes

    @property
    def size(self) -> int:
        """Number of generalised coordinates n."""
        return int(self.mass.shape[0])


@dataclass(frozen=True)
class MeshMotion:
    """How a gear mesh is excited: the rigid spin d that a unit transmission error leaves undone.

    With q = q~ + d e the stiffness force of the transmission error becomes the inertial excitation -M d e''
    on q~ (`F_e = m_e w^2 e` of the paper, corrected by the mass m_e = d^T M d).
    """

    displacement: Real  # d, (n,), m of spin per m of transmission error
    equivalent_mass: float  # m_e = d^T M d, kg
    spin: Real  # (n,): what the gears' turning alone deforms the mesh, p = spin @ q; a tooth force F loads it by F spin
