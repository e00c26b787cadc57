"""The parameters of a running python FMU, and the entries of its variable table. Bundled into the FMU."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np

from ..errors import InputError
from ..network.modal import ModalNetwork

Matrix = list[list[float]]


@dataclass(frozen=True)
class Entry:
    """A variable of the FMU; its value reference is its place in the table."""

    name: str
    kind: str  # input, frequency, stiffness, damping, modal_damping, design, followed (a matrix), output or response
    target: str = ""  # the load, joint, component or output over time that it belongs to
    row: int = 0  # of a matrix entry
    column: int = 0

    @property
    def is_output(self) -> bool:
        """Whether the variable is calculated."""
        return self.kind in ("output", "response", "followed")

    def check(self, value: float) -> None:
        """Raise InputError for a number that the variable can never take."""
        if self.kind == "followed":
            raise InputError(f"{self.name} follows from the bearing's geometry and load, and cannot be set; set those")
        if self.is_output:
            raise InputError(f"{self.name} is an output and cannot be set")
        if not np.isfinite(value):
            raise InputError(f"{self.name} must be set to a finite number, not {value}")
        if self.kind == "modal_damping" and not 0.0 <= value < 1.0:
            raise InputError(f"{self.name} is a damping ratio: at least 0 and less than 1, not {value:g}")
        if self.kind in ("stiffness", "damping") and self.row == self.column and value < 0.0:
            raise InputError(f"{self.name} is on the diagonal of its matrix and must not be negative, as {value:g} is")


@dataclass
class Settings:
    """All parameters as plain numbers; equal settings compare equal."""

    design: dict[str, float] = field(default_factory=dict)  # only those that were set
    stiffness: dict[str, Matrix] = field(default_factory=dict)  # joint -> matrix
    damping: dict[str, Matrix] = field(default_factory=dict)
    modal_damping: dict[str, float] = field(default_factory=dict)

    @classmethod
    def of(cls, network: ModalNetwork, decided: frozenset[str]) -> Settings:
        """The parameters that a network has, with no design parameter set.

        `decided`: matrices, as bearing_1.stiffness, that follow from the design and are no parameters.
        """
        return cls(
            stiffness={j.name: j.stiffness.tolist() for j in network.joints if f"{j.name}.stiffness" not in decided},
            damping={j.name: j.damping.tolist() for j in network.joints if f"{j.name}.damping" not in decided},
            modal_damping=dict(network.modal_damping),
        )

    @classmethod
    def from_plain(cls, plain: dict[str, Any]) -> Settings:
        """The reverse of `plain`."""
        return cls(**deepcopy(plain))

    def plain(self) -> dict[str, Any]:
        """A copy as dictionaries, lists and numbers."""
        return asdict(self)

    def copy(self) -> Settings:
        """An independent copy."""
        return deepcopy(self)

    def set_entry(self, entry: Entry, value: float) -> bool:
        """Set a joint's matrix entry and its mirror image, or a damping ratio; return whether it changed."""
        if entry.kind == "modal_damping":
            changed = self.modal_damping[entry.target] != value
            self.modal_damping[entry.target] = value
            return changed
        matrix = (self.stiffness if entry.kind == "stiffness" else self.damping)[entry.target]
        changed = matrix[entry.row][entry.column] != value
        matrix[entry.row][entry.column] = matrix[entry.column][entry.row] = value
        return changed

    def entry(self, entry: Entry) -> float:
        """The value of a joint's matrix entry or of a damping ratio."""
        if entry.kind == "modal_damping":
            return self.modal_damping[entry.target]
        matrices = self.stiffness if entry.kind == "stiffness" else self.damping
        return matrices[entry.target][entry.row][entry.column]

    def take_back_joints(self, valid: Settings) -> list[str]:
        """Give every joint with an indefinite matrix its valid matrices again; return a sentence for each."""
        problems = []
        for joint in {**self.stiffness, **self.damping}:
            for what, matrices in (("stiffness", self.stiffness), ("damping", self.damping)):
                if joint in matrices and not is_semidefinite(matrices[joint]):
                    for own, last in ((self.stiffness, valid.stiffness), (self.damping, valid.damping)):
                        own |= {joint: deepcopy(last[joint])} if joint in last else {}
                    problems.append(
                        f"The {what} matrix of {joint} is not positive semidefinite; "
                        "the joint keeps its last valid matrices."
                    )
                    break
        return problems

    def applied(self, network: ModalNetwork) -> ModalNetwork:
        """The network with the joints and damping ratios of these settings."""
        joints = tuple(
            replace(
                joint,
                stiffness=np.array(self.stiffness.get(joint.name, joint.stiffness)),
                damping=np.array(self.damping.get(joint.name, joint.damping)),
            )
            for joint in network.joints
        )
        return replace(network, joints=joints, modal_damping=dict(self.modal_damping))


def is_semidefinite(matrix: Matrix) -> bool:
    """Whether a symmetric matrix is positive semidefinite, in units of its own diagonal."""
    K = np.array(matrix)
    diagonal = np.diag(K)
    if not np.isfinite(K).all() or diagonal.min(initial=0.0) < 0.0:
        return False
    unit = np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    scaled = K / unit[:, None] / unit
    return bool(np.isfinite(scaled).all() and np.linalg.eigvalsh(scaled).min() >= -1e-12)
