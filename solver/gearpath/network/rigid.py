"""Rigid joints: two ports held together exactly, P q = 0, and which components so move as one."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ..components import DOFS
from ..errors import InputError
from ..joints import RIGID, Joint
from ..numerics.arrays import Real
from .channels import joint_motion
from .ports import Ports
from .system import System


@dataclass(frozen=True)
class RigidRows:
    """What a rigid joint holds: rows @ q = 0."""

    name: str
    components: tuple[str, ...]  # both ends; one where the other is the ground
    rows: Real  # (d, n): motion of the first port less that of the second


@dataclass(frozen=True)
class Group:
    """Components that move as one, in the order of the system, or one that is alone."""

    components: tuple[str, ...]
    joints: tuple[str, ...]  # that hold them; none where nothing does
    rows: Real  # (c, n)

    @property
    def name(self) -> str:
        """Such as "casing+frame"."""
        return "+".join(self.components)


def rigid_rows(ports: Ports, system: System) -> tuple[RigidRows, ...]:
    """The rows of all rigid joints. Raises InputError for a degree of freedom that one of the ends does not have."""
    return tuple(_rows(ports, name, joint) for name, joint in system.joints.items() if joint.kind == RIGID)


def _rows(ports: Ports, name: str, joint: Joint) -> RigidRows:
    ends = [port.component for port in joint.between if not port.is_ground]
    motions = joint_motion(ports, joint)[: len(ends)]
    both = [dof for k, dof in enumerate(DOFS) if all(motion[k].any() for motion in motions)]
    wanted = joint.dofs or tuple(dof for dof in ports.system.dofs if dof in both)
    lacking = [dof for dof in wanted if dof not in both]
    if lacking:
        remedy = f"name some of: {', '.join(both)}" if both else "choose other places"
        raise InputError(f"joints.{name}.dofs: {', '.join(lacking)} is no motion of both ends; {remedy}")
    if not wanted:
        raise InputError(f"joints.{name}.between: the ends have no degree of freedom in common; choose other places")
    picked = [DOFS.index(dof) for dof in wanted]
    rows = motions[0][picked] - motions[1][picked] if len(ends) == 2 else motions[0][picked]
    return RigidRows(name, tuple(ends), rows)


def groups(held: Sequence[RigidRows], components: Iterable[str]) -> tuple[Group, ...]:
    """All components, put together where rigid joints hold them, each group where its first member stands."""
    members = {name: [name] for name in components}
    order = list(members)
    for item in held:
        first, other = members[item.components[0]], members[item.components[-1]]
        if first is not other:
            first += other
            members |= dict.fromkeys(other, first)
    found = {id(group): sorted(group, key=order.index) for group in members.values()}
    return tuple(_group(tuple(group), held) for group in sorted(found.values(), key=lambda g: order.index(g[0])))


def _group(components: tuple[str, ...], held: Sequence[RigidRows]) -> Group:
    own = [item for item in held if item.components[0] in components]
    rows = np.vstack([item.rows for item in own]) if own else np.zeros((0, 0))
    return Group(components, tuple(item.name for item in own), rows)
