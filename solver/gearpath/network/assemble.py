"""From the system to the network: in physical coordinates, and in the modes of the components."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg
from scipy.sparse import issparse

from ..components import Measured, Modes, Structure
from ..joints import RIGID
from ..numerics.arrays import Real
from .channels import joint_rows, load_columns, output_rows
from .joined import joined
from .modal import ModalNetwork
from .ports import Ports
from .records import JointRows, Load, Output
from .rigid import RigidRows, groups, rigid_rows
from .system import System

_PATHS = ("bearing", "beam_joint")


@dataclass(frozen=True)
class Network:
    """The network in physical coordinates: the structures, and rows on all their coordinates together."""

    system: System
    structures: Mapping[str, Structure]
    bases: Mapping[str, Modes]  # all free-free modes of each structure
    blocks: Mapping[str, slice]  # component -> its coordinates
    joints: tuple[JointRows, ...]
    loads: tuple[Load, ...]
    outputs: tuple[Output, ...]
    excitation: str
    rigid: tuple[RigidRows, ...] = ()  # what rigid joints hold; they are not among `joints`

    @property
    def band(self) -> float:
        """Highest frequency (Hz) that the bases are good for: infinite unless a component was reduced to its band."""
        chosen = self.system.vectors
        reduced = [name for name, item in self.structures.items() if issparse(item.mass) and name not in chosen]
        return self.system.band if reduced else np.inf

    @property
    def paths(self) -> tuple[str, ...]:
        """The joints that count as power flow paths: bearings and bolted joints, of those in series the last one.

        A bearing into a component that is itself the first of `between` of another bearing (shaft to quill, quill to
        casing) is not counted: its power is counted where it goes on. Nothing goes on into the ground.
        Rigidly joined components count as one: a bearing within them leads nowhere.
        """
        found = groups(self.rigid, self.system.components)
        body = {name: group.name for group in found for name in group.components} | {"ground": "ground"}
        ends = {
            name: [body[port.component] for port in joint.between]
            for name, joint in self.system.joints.items()
            if joint.kind in _PATHS
        }
        onward = {source for source, receiver in ends.values() if receiver not in (source, "ground")}
        return tuple(name for name, (source, receiver) in ends.items() if receiver not in {source, *onward})

    def modal(self) -> ModalNetwork:
        """The same network in all free-free modes of its components (no truncation)."""
        return to_modes(self, self.bases)


def assemble(system: System) -> Network:
    """Assemble the components and express every port, load and output on their coordinates."""
    ports = Ports(system)
    joints = tuple(joint_rows(ports, name, joint) for name, joint in system.joints.items() if joint.kind != RIGID)
    excitation, loads = load_columns(ports, system)
    outputs = output_rows(ports, system, joints)
    rigid = rigid_rows(ports, system)
    _warn_of_lost_paths(system, rigid)
    return Network(system, ports.structures, ports.bases, ports.blocks, joints, loads, outputs, excitation, rigid)


def _warn_of_lost_paths(system: System, rigid: Sequence[RigidRows]) -> None:
    """Bearings within components that a rigid joint makes one are no paths: no one who ranks them should miss that."""
    for group in groups(rigid, system.components):
        lost = [
            name
            for name, joint in system.joints.items()
            if joint.kind in _PATHS and {port.component for port in joint.between} <= set(group.components)
        ]
        if group.joints and lost:
            warnings.warn(
                f"{', '.join(f'joints.{name}' for name in group.joints)}: {' and '.join(group.components)} move as "
                f"one, so that no power flow path leads through {', '.join(lost)} inside; give a stiff bearing in "
                "place of a rigid joint beside them to see all paths",
                stacklevel=3,
            )


def _shares(network: Network, slices: Mapping[str, slice]) -> dict[str, Real]:
    """What the modes of components with ratios of their own take of the mean ratio."""
    size = max((block.stop for block in slices.values()), default=0)
    shares = {}
    for name, structure in network.structures.items():
        if structure.damping_ratios is not None and structure.modal_damping > 0.0:
            shares[name] = np.zeros(size)
            shares[name][slices[name]] = structure.damping_ratios / structure.modal_damping
    return shares


def _dashpots(network: Network, basis: Mapping[str, Modes], slices: Mapping[str, slice]) -> dict[str, Real]:
    """D of the components that have dashpots, on all modes."""
    size = max((block.stop for block in slices.values()), default=0)
    found = {}
    for name, structure in network.structures.items():
        if structure.dashpots is not None:
            found[name] = np.zeros((len(structure.dashpots), size))
            found[name][:, slices[name]] = structure.dashpots @ basis[name].shapes
    return found


def to_modes(network: Network, basis: Mapping[str, Modes]) -> ModalNetwork:
    """Project the network on a basis of mass-normalised modes of each component (Eq. 11)."""
    shapes = scipy.linalg.block_diag(*(basis[name].shapes for name in network.structures))
    ends = np.cumsum([len(basis[name].eigenvalues) for name in network.structures])
    slices = {
        name: slice(int(end) - len(basis[name].eigenvalues), int(end)) for name, end in zip(network.structures, ends)
    }

    def project(motion: Real) -> Real:
        """Phi^T M d."""
        momentum = [s.mass @ motion[network.blocks[name]] for name, s in network.structures.items()]
        return np.asarray(np.concatenate(momentum) @ shapes)

    def load(item: Load) -> Load:
        d = None if item.mesh_displacement is None else project(item.mesh_displacement)
        return replace(item, column=item.column @ shapes, mesh_displacement=d)

    modal = ModalNetwork(
        name=network.system.name,
        components=slices,
        modal_damping={
            name: structure.modal_damping
            for name, structure in network.structures.items()
            if len(basis[name].eigenvalues) > structure.rigid_modes.shape[1]
        },
        eigenvalues=np.concatenate([basis[name].eigenvalues for name in network.structures]),
        joints=tuple(
            replace(joint, source=joint.source @ shapes, receiver=joint.receiver @ shapes) for joint in network.joints
        ),
        loads=tuple(load(item) for item in network.loads),
        outputs=tuple(
            replace(output, row=None if output.row is None else output.row @ shapes) for output in network.outputs
        ),
        excitation=network.excitation,
        paths=network.paths,
        loss_factors={name: s.loss_factor for name, s in network.structures.items() if s.loss_factor},
        damping_shares=_shares(network, slices),
        dashpots=_dashpots(network, basis, slices),
        measured={n: item for n, item in network.system.components.items() if isinstance(item, Measured)},
        band=network.band,
        loss_frequency=network.system.loss_frequency,
        source=network.system.source,
    )
    return joined(modal, [replace(item, rows=item.rows @ shapes) for item in network.rigid])
