"""Rules inside one component."""

import numpy as np

from ...errors import ModelError
from ..foreign_tables import MatricesTable, ModalTable
from ..measured_tables import MeasuredTable
from ..references import SAME, find, length
from ..structure_tables import FrameTable, PlateTable
from ..tables import FileTable, InertiaTable, RigidBodyTable
from ..train_tables import DiskTable, ShaftTable
from ..wording import show
from .meshes import check_meshes
from .structures import check_frame, check_plate

ROUNDED = 1e-3  # printed numbers are rounded: inertias may miss their conditions by this part


def check_components(file: FileTable) -> None:
    """Check every component."""
    if not file.components:
        raise ModelError("components", "there is no component", "give at least one, such as a gear_train")
    for name, component in file.components.items():
        key = f"components.{name}"
        if isinstance(component, (MatricesTable, ModalTable, MeasuredTable)):  # see checks.foreign, checks.measured
            continue
        if isinstance(component, RigidBodyTable):
            _check_inertia(component.inertia, f"{key}.inertia")
            continue
        if isinstance(component, PlateTable):
            check_plate(file, component, key)
            continue
        if isinstance(component, FrameTable):
            check_frame(file, component, key)
            continue
        if not component.shafts:
            raise ModelError(f"{key}.shafts", "there is no shaft", "give at least one shaft")
        for shaft_name, shaft in component.shafts.items():
            _check_shaft(file, shaft, f"{key}.shafts.{shaft_name}")
        check_meshes(file, component, f"{key}.meshes")


def _check_inertia(table: InertiaTable, key: str) -> None:
    tensor = np.array([[table.xx, table.xy, table.xz], [table.xy, table.yy, table.yz], [table.xz, table.yz, table.zz]])
    scale = float(abs(tensor).max())
    low, middle, high = (float(value) * scale for value in np.linalg.eigvalsh(tensor / scale))
    if not low > 0.0:
        raise ModelError(
            key,
            f"the tensor is not positive definite (smallest principal moment {low:.4g} kg m^2)",
            "check the off-diagonal elements, each below the square root of the product of its moments",
        )
    if high > (1.0 + ROUNDED) * (low + middle):
        raise ModelError(
            key,
            f"no body has the principal moments {low:.4g}, {middle:.4g} and {high:.4g} kg m^2",
            "give them about the centre of gravity in kg m^2, each at most the sum of the other two",
        )


def _check_shaft(file: FileTable, shaft: ShaftTable, key: str) -> None:
    find("material", shaft.material, file.materials, f"{key}.material")
    if shaft.sections:
        for part in ("length", "diameter"):
            if getattr(shaft, part) is not None:
                raise ModelError(
                    f"{key}.{part}",
                    f"{getattr(shaft, part):g} m is given beside sections",
                    "give either length and diameter or sections",
                )
    for part in () if shaft.sections else ("length", "diameter"):
        if getattr(shaft, part) is None:
            raise ModelError(f"{key}.{part}", "is missing", "give length and diameter in m, or sections")
    for k, section in enumerate(shaft.sections):
        for outer, inner in zip(*section.diameters()):
            if inner >= outer:
                raise ModelError(
                    f"{key}.sections.{k}.inner",
                    f"{inner:g} m is not below the outer diameter, {outer:g} m",
                    "give an inner diameter below the outer one, 0 for a solid shaft",
                )
    seen: set[str] = set()
    for disk in shaft.disks:
        if disk.name in seen:
            raise ModelError(f"{key}.disks", f"{show(disk.name)} is the name of two disks", "choose another name")
        seen.add(disk.name)
        _check_disk(disk, length(shaft), f"{key}.disks.{disk.name}")


def _check_disk(disk: DiskTable, end: float, key: str) -> None:
    if disk.z > (1.0 + SAME) * end:
        raise ModelError(f"{key}.z", f"{disk.z:g} m lies off the shaft", f"give a place from 0 to {end:.9g} m")
    if disk.polar_inertia > (1.0 + ROUNDED) * 2.0 * disk.diametral_inertia:
        raise ModelError(
            f"{key}.polar_inertia",
            f"{disk.polar_inertia:g} kg m^2 is above twice the diametral inertia, {disk.diametral_inertia:g}",
            "no body has such inertias: a thin disk has m r^2/2 about its axis and m r^2/4 about a diameter",
        )
