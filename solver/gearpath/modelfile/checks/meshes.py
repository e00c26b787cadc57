"""Rules of the gear meshes of one gear train: gears, geometry, active degrees of freedom, loops."""

from math import cos, hypot

import numpy as np

from ...errors import ModelError
from ...numerics.arrays import Real
from ..build import build_mesh
from ..references import find_gear
from ..tables import FileTable
from ..train_tables import GearTrainTable, MeshTable
from ..wording import show

ROUNDED = 1e-3  # printed numbers are rounded: base radii may miss their condition by this part
_SAME_PLANE = 1e-6  # m
Place = tuple[float, float, float]


def check_meshes(file: FileTable, train: GearTrainTable, key: str) -> None:
    """Refuse meshes within one shaft or of other shafts, impossible geometry, and loops without a spin of their own."""
    freely = "rz" not in file.dofs  # disks spin about their shafts, otherwise whole shafts turn
    wheels = [f"{s}.{d.name}" for s, shaft in train.shafts.items() for d in shaft.disks]
    columns = {wheel: k if freely else list(train.shafts).index(wheel.split(".")[0]) for k, wheel in enumerate(wheels)}
    levers: list[Real] = []
    for name, mesh in train.meshes.items():
        gears = [find_gear(train, text, f"{key}.{name}.between") for text in mesh.between]
        if gears[0][0] == gears[1][0]:
            raise ModelError(
                f"{key}.{name}.between",
                f"{show(list(mesh.between))} lie on one shaft",
                "mesh gears of two shafts",
            )
        row = np.zeros(len(wheels))
        for text, radius in zip(mesh.between, mesh.base_radii):
            row[columns[text]] += radius / sum(mesh.base_radii)
        levers.append(row)
        if np.linalg.matrix_rank(np.array(levers), tol=1e-9) < len(levers):
            raise ModelError(
                f"{key}.{name}",
                f"{show(list(mesh.between))} closes a loop of meshes that has no spin of its own",
                "leave one mesh of the loop out and add its stiffness to another",
            )
        _check_geometry(file, train, mesh, f"{key}.{name}")


def _check_geometry(file: FileTable, train: GearTrainTable, mesh: MeshTable, key: str) -> None:
    first, second = (_place(train, text) for text in mesh.between)
    if mesh.pressure_angle is None:
        _check_along_y(mesh.base_radii, abs(second[0] - first[0]), f"{key}.base_radii")
        if mesh.driving_torque:
            raise ModelError(
                f"{key}.driving_torque",
                f"{show(mesh.driving_torque)} is given without pressure_angle, and the line of action is y",
                "give pressure_angle too, or leave driving_torque out",
            )
    else:
        distance = hypot(second[0] - first[0], second[1] - first[1])
        _check_base_radii(mesh.base_radii, distance, mesh.pressure_angle, f"{key}.base_radii")
    angles = [part for part in ("pressure_angle", "helix_angle") if getattr(mesh, part)]
    apart = second[2] - first[2]
    if angles and mesh.contact_offset is None and abs(apart) > _SAME_PLANE:
        raise ModelError(
            f"{key}.between",
            f"the middle planes of {show(list(mesh.between))} are {abs(apart):g} m apart along z",
            "move a disk, or say with contact_offset how far along z from the first gear the teeth press",
        )
    n = build_mesh(train, mesh).line_of_action(first, second)
    for dof, part, needed in zip(("ux", "uy", "uz"), n, (True, mesh.pressure_angle is not None, True)):
        if part and needed and dof not in file.dofs:
            raise ModelError(
                f"{key}.{'helix_angle' if dof == 'uz' else 'pressure_angle'}",
                f"the teeth press along {dof}, which is not among dofs, so that no joint holds the shafts there",
                f"add {dof} to dofs, or leave the angle out",
            )


def _place(train: GearTrainTable, gear: str) -> Place:
    shaft, name = gear.split(".")
    table = train.shafts[shaft]
    x, y, z = table.origin
    return (x, y, z + next(disk.z for disk in table.disks if disk.name == name))


def _check_along_y(radii: tuple[float, float], distance: float, key: str) -> None:
    """The line of action along y touches both base circles of an external pair: their radii add up to |x2 - x1|."""
    total = sum(radii)
    if abs(total - distance) > ROUNDED * max(total, distance):
        raise ModelError(
            key,
            f"the sum {total:.6g} m is not the distance {distance:.6g} m of the two shafts along x",
            "give the base radii of both gears, or origins whose x differ by their sum (the line of action is along y)",
        )


def _check_base_radii(radii: tuple[float, float], distance: float, pressure_angle: float, key: str) -> None:
    """The line of action touches both base circles: r1 + r2 = a cos(alpha)."""
    total, wanted = sum(radii), distance * cos(pressure_angle)
    if abs(total - wanted) > ROUNDED * max(total, wanted):
        raise ModelError(
            key,
            f"the sum {total:.6g} m is not {wanted:.6g} m, the distance {distance:.6g} m of the two axes times the "
            f"cosine of pressure_angle",
            "give the pitch radius of each gear times that cosine, or move an origin",
        )
