"""Mean load of a gear train: tooth forces and shaft speeds that follow from the torque and speed of one shaft."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos

from ..errors import InputError
from .gear_mesh import Mesh


@dataclass(frozen=True)
class MeanLoad:
    """What a steady torque does: `force` along the line of action of each mesh, N, and `speed` of each shaft."""

    force: dict[str, float]
    speed: dict[str, float]  # of each shaft that a mesh reaches, over that of the driving shaft


def mean_load(meshes: Mapping[str, Mesh], torque: float, shaft: str | None = None) -> MeanLoad:
    """Tooth forces F = T / (r cos beta_b) of a chain of meshes that `torque` (N m) drives at one end.

    `shaft` is where the torque enters, None for the first gear's of the first mesh; it leaves at the other end of the
    chain, and every shaft between passes on what it takes. Raises InputError where the meshes form no chain.
    """
    driving = _driving(meshes) if shaft is None else shaft
    forces, speeds = {}, {driving: 1.0}
    here, carried, remaining = driving, torque, dict(meshes)
    while remaining:
        met = [name for name, mesh in remaining.items() if here in (mesh.between[0][0], mesh.between[1][0])]
        if len(met) != 1:
            found = "no further mesh" if not met else "several meshes at once: " + ", ".join(met)
            raise InputError(
                f"operation.torque: the torque that enters at {driving!r} finds {found} on {here!r}; a mean torque "
                "needs a chain of meshes with an end at the shaft where it enters (operation.shaft)"
            )
        mesh = remaining.pop(met[0])
        first = mesh.between[0][0] == here
        own, other = mesh.base_radii if first else mesh.base_radii[::-1]
        forces[met[0]] = carried / (own * cos(mesh.helix_angle))
        there = mesh.between[1 if first else 0][0]
        carried, speeds[there], here = carried * other / own, speeds[here] * own / other, there
    return MeanLoad(forces, speeds)


def _driving(meshes: Mapping[str, Mesh]) -> str:
    if not meshes:
        raise InputError("operation.torque: the gear train has no mesh that could carry it; leave operation out")
    return next(iter(meshes.values())).between[0][0]
