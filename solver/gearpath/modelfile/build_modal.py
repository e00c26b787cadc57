"""Components of modes from their tables: frequencies, damping and shapes of a table or a file in SI units."""

from pathlib import Path

import numpy as np

from ..components import DOFS, ModalModel
from ..components.dofs import is_rotation
from ..errors import InputError, ModelError
from ..numerics.arrays import Real
from .data.modes import ModeFile, read_modes_npz, read_modes_uff
from .foreign_files import ENERGY, LENGTH, found_in, guarded
from .foreign_tables import ModalTable
from .hints import hint
from .wording import show

_MODE_FORMATS = {".npz": read_modes_npz, ".unv": read_modes_uff, ".uff": read_modes_uff}


def build_modal(table: ModalTable, folder: Path, key: str) -> ModalModel:
    """The component of a table. Raises ModelError for data that do not fit."""
    file = guarded(f"{key}.file", lambda: _modes(table, folder)) if table.file else None
    if file is None and table.frequencies is None:
        raise ModelError(f"{key}.frequencies", "is missing", "give the frequencies of the modes in Hz, or a file")
    if file is not None and (table.frequencies is not None or table.modal_masses is not None):
        raise ModelError(f"{key}.frequencies", "is given beside a file that has it", "leave one of them out")
    frequencies = np.array(table.frequencies) if file is None else file.frequencies
    size = len(frequencies)
    damping = table.damping if table.damping is not None else (0.0,) if file is None or file.damping is None else None
    ratios = _each(damping, size, f"{key}.damping") if damping is not None else np.asarray(file.damping)  # type: ignore[union-attr]
    masses = _each(table.modal_masses or (1.0,), size, f"{key}.modal_masses") if file is None else file.modal_masses
    order = np.argsort(frequencies, kind="stable")
    length, energy = LENGTH[table.units], ENERGY[table.units]
    factor = 1.0 / np.sqrt(masses * energy)  # to modal masses of 1 kg m^2 per unit of the coordinate squared
    ports = {}
    for name, port in table.ports.items():
        here = f"{key}.ports.{name}"
        shapes = port.named if port.node is None else _of_file(port.node, port.supplied(()), file, here)
        if not shapes:
            raise ModelError(here, "has no shape", "give one at least, such as uy = [...], or a node of the file")
        ports[name] = {
            dof: tuple(
                float(v)
                for v in (_row(shape, size, f"{here}.{dof}") * factor * (1.0 if is_rotation(dof) else length))[order]
            )
            for dof, shape in shapes.items()
        }
    return ModalModel(
        tuple(float(v) for v in (2.0 * np.pi * frequencies[order]) ** 2),
        tuple(float(v) for v in ratios[order]),
        ports,
        {name: port.at for name, port in table.ports.items() if port.at is not None},
        table.loss_factor,
    )


def _modes(table: ModalTable, folder: Path) -> ModeFile:
    path = folder / table.file
    if path.suffix.lower() not in _MODE_FORMATS:
        raise InputError(f"{show(table.file)} is no file of modes; give a .npz, .unv or .uff")
    return _MODE_FORMATS[path.suffix.lower()](path)


def _each(values: tuple[float, ...], size: int, key: str) -> Real:
    if len(values) not in (1, size):
        raise ModelError(key, f"has {len(values)} numbers for {size} modes", "give one, or one a mode")
    return np.full(size, values[0]) if len(values) == 1 else np.array(values)


def _row(shape: object, size: int, key: str) -> Real:
    row = np.atleast_1d(np.asarray(shape, float))
    if row.shape != (size,):
        raise ModelError(key, f"has {row.size} numbers for {size} modes", "give one a mode")
    return row


def _of_file(node: int, dofs: tuple[str, ...], file: ModeFile | None, key: str) -> dict[str, Real]:
    if file is None:
        raise ModelError(f"{key}.node", "there is no file that has nodes", "give shapes, such as uy = [...]")
    found = {dof: file.shapes[f"{node}:{dof}"] for dof in DOFS if f"{node}:{dof}" in file.shapes}
    if not found:
        nodes = list(dict.fromkeys(name.split(":")[0] for name in file.shapes))
        raise ModelError(f"{key}.node", f"the file has no node {node}", hint(str(node), nodes))
    return {dof: found_in(found, dof, f"{key}.node") for dof in dofs}
