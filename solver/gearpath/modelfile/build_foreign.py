"""Components from elsewhere: matrices and modes of files as components in SI units."""

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import TypeVar

import numpy as np
import scipy.sparse

from ..components import DOFS, Matrices, ModalModel, modal_model, modes, split_damping
from ..components.dofs import is_rotation
from ..components.free_matrices import checked, free_matrices
from ..errors import InputError, ModelError
from ..numerics.arrays import Real, Sparse
from .data.calculix import read_calculix
from .data.matrices import MatrixFile
from .data.matrix_market import read_matrix_market
from .data.modes import ModeFile, read_modes_npz, read_modes_uff
from .data.npz import read_npz
from .data.op4 import read_op4
from .foreign_tables import MatricesTable, MatrixPortTable, ModalTable
from .hints import hint
from .wording import show

T = TypeVar("T")
Stamps = tuple[tuple[int, int], ...]
_MATRIX_FORMATS = (".npz", ".op4", ".sti", ".mtx")
_MODE_FORMATS = {".npz": read_modes_npz, ".unv": read_modes_uff, ".uff": read_modes_uff}
_LENGTH = {"SI": 1.0, "mm-t-s": 1e-3}  # m
_ENERGY = {"SI": 1.0, "mm-t-s": 1e-3}  # J: N mm, and t mm^2 / s^2
_DENSE = 600  # coordinates up to which all modes of a sparse structure are kept
_MOST = 3000  # coordinates of a structure with a damping matrix, whose modes are all computed


def build_matrices(table: MatricesTable, folder: Path, dofs: tuple[str, ...], key: str) -> Matrices | ModalModel:
    """The component of a table; with a damping matrix in its modes. Raises ModelError for data that do not fit.

    Built once for the same table and files: a model is changed and checked again many times in a study.
    """
    return _built(table.model_dump_json(exclude_unset=True), folder, dofs, key, _stamps(table, folder))


@lru_cache(maxsize=8)
def _built(text: str, folder: Path, dofs: tuple[str, ...], key: str, changed: Stamps) -> Matrices | ModalModel:
    table = MatricesTable.model_validate_json(text)
    file = _guarded(f"{key}.file", lambda: _matrices(table, folder, changed))
    ports = {name: _coordinates(port, file, dofs, f"{key}.ports.{name}") for name, port in table.ports.items()}
    scale = np.where(_turns(file, ports), 1.0, _LENGTH[table.units])
    if file.damping is not None:
        _check_damping(table, len(scale), key)

    def si(matrix: Real | Sparse, dense: bool = file.damping is not None) -> Real | Sparse:
        return _si(matrix, scale, _ENERGY[table.units], dense)

    seen = [place for places in ports.values() for place in places.values()]
    prepared = _guarded(
        f"{key}.file", lambda: free_matrices(si(file.mass), si(file.stiffness), seen, table.rigid_motions)
    )
    component = Matrices(
        prepared.mass,
        prepared.stiffness,
        prepared.rigid_modes,
        ports,
        _places(table, file),
        table.modal_damping,
        table.loss_factor,
    )
    if file.damping is None:
        return component
    given = file.damping
    return _damped(component, _guarded(f"{key}.file", lambda: checked("damping", si(given))), key)


def _check_damping(table: MatricesTable, size: int, key: str) -> None:
    """A damping matrix needs all modes, and no other damping beside it."""
    if table.modal_damping or size > _MOST:
        problem = (
            "is given beside a damping matrix"
            if table.modal_damping
            else f"replaces a damping matrix of {size} x {size}"
        )
        raise ModelError(f"{key}.modal_damping", problem, "leave one of them out of the file and the table")


def _guarded(key: str, work: Callable[[], T]) -> T:
    """The result of `work`, whose refusals name the key."""
    try:
        return work()
    except InputError as error:
        if isinstance(error, ModelError):
            raise
        problem, _, remedy = str(error).partition("; ")
        raise ModelError(key, problem, remedy) from None


def _matrices(table: MatricesTable, folder: Path, changed: Stamps) -> MatrixFile:
    path = folder / table.file
    suffix = path.suffix.lower()
    if suffix not in _MATRIX_FORMATS:
        raise InputError(f"{show(table.file)} is no file of matrices; give a .npz, .op4, .sti (CalculiX) or .mtx")
    if suffix != ".mtx" and (table.mass_file or table.damping_file):
        raise InputError(f"{show(table.file)} holds all matrices; leave mass_file and damping_file out")
    mass, damping = (folder / name if name else None for name in (table.mass_file, table.damping_file))
    return _remembered(path, mass, damping, changed)


def _stamps(table: MatricesTable, folder: Path) -> Stamps:
    """Time and size of every file of a table, 0 where there is none; of CalculiX there are three."""
    path = folder / table.file
    beside = [path.with_suffix(suffix) for suffix in (".mas", ".dof")] if path.suffix.lower() == ".sti" else []
    others = [folder / name for name in (table.mass_file, table.damping_file) if name]
    found = [item.stat() if item.is_file() else None for item in (path, *beside, *others)]
    return tuple((0, 0) if item is None else (item.st_mtime_ns, item.st_size) for item in found)


@lru_cache(maxsize=8)
def _remembered(path: Path, mass: Path | None, damping: Path | None, changed: Stamps) -> MatrixFile:  # noqa: ARG001
    """The file, read once: a model is changed and checked again many times in a study."""
    suffix = path.suffix.lower()
    if suffix == ".mtx":
        return read_matrix_market(path, mass, damping)
    return {".npz": read_npz, ".op4": read_op4, ".sti": read_calculix}[suffix](path)


def _coordinates(port: MatrixPortTable, file: MatrixFile, dofs: tuple[str, ...], key: str) -> dict[str, int]:
    """Coordinate by degree of freedom of a port."""
    ways = [port.coordinates is not None, port.node is not None, bool(port.named)]
    if sum(ways) != 1:
        raise ModelError(key, "is given in no way or in several", "give a list of coordinates, a node, or ux = ...")
    if port.node is not None:
        found = _of_node(port.node, file, key)
        return {dof: _found(found, dof, f"{key}.node") for dof in port.supplied(dofs)}
    places = port.named
    if port.coordinates is not None:
        names = port.supplied(dofs)
        if not names:
            counts = " or ".join(str(count) for count in sorted({3, 6, len(dofs)}))
            raise ModelError(
                key, f"has {len(port.coordinates)} coordinates", f"give {counts}, or name them as ux = ..."
            )
        places = dict(zip(names, port.coordinates))
    size = int(file.stiffness.shape[0])
    for dof, place in places.items():
        if place >= size:
            raise ModelError(
                f"{key}.{dof}", f"{place} is beyond the {size} coordinates of the file", f"give 0 to {size - 1}"
            )
    return places


def _of_node(node: int, file: MatrixFile, key: str) -> dict[str, int]:
    if file.nodes is None or file.directions is None:
        raise ModelError(f"{key}.node", "the file does not say which coordinates its nodes have", "give coordinates")
    here = np.flatnonzero(file.nodes == node)
    if not here.size:
        raise ModelError(
            f"{key}.node", f"the file has no node {node}", f"give one from {file.nodes.min()} to {file.nodes.max()}"
        )
    return {DOFS[int(file.directions[place]) - 1]: int(place) for place in here}


def _found(found: dict[str, T], dof: str, key: str) -> T:
    """What a node has for a degree of freedom."""
    if dof not in found:
        raise ModelError(key, f"the node has no {dof} in the file", f"name what it has: {', '.join(found)}")
    return found[dof]


def _turns(file: MatrixFile, ports: dict[str, dict[str, int]]) -> "np.ndarray[tuple[int], np.dtype[np.bool_]]":
    """Which coordinates are rotations: as the file says, else as the ports say."""
    if file.directions is not None:
        return np.asarray(file.directions > 3)
    turns = np.zeros(int(file.stiffness.shape[0]), bool)
    for places in ports.values():
        for dof, place in places.items():
            turns[place] |= is_rotation(dof)
    return turns


def _si(matrix: Real | Sparse, scale: Real, energy: float, dense: bool) -> Real | Sparse:
    """The matrix of q_SI = scale q from that of q, whose quadratic form is an energy (of damping, per s)."""
    if matrix.shape != (len(scale), len(scale)):
        raise InputError(f"a matrix has shape {tuple(matrix.shape)} beside {len(scale)} coordinates; give equal sizes")
    if scipy.sparse.issparse(matrix) and not dense and len(scale) > _DENSE:
        inverse = scipy.sparse.diags_array(1.0 / scale)
        return scipy.sparse.csc_array(energy * (inverse @ matrix @ inverse))
    full: Real = scipy.sparse.csc_array(matrix).toarray() if scipy.sparse.issparse(matrix) else matrix
    return np.asarray(energy * full / np.outer(scale, scale))


def _places(table: MatricesTable, file: MatrixFile) -> dict[str, tuple[float, float, float]]:
    length, places = _LENGTH[table.units], {}
    for name, port in table.ports.items():
        if port.at is not None:
            places[name] = port.at
        elif port.node is not None and port.node in file.positions:
            x, y, z = file.positions[port.node]
            places[name] = (length * x, length * y, length * z)
    return places


def _damped(component: Matrices, damping: Real, key: str) -> ModalModel:
    """The component in its modes, with the damping ratio of each and dashpots for what couples them."""
    structure = component.structure(DOFS, {name: name for name in component.ports})
    basis = modes(structure)
    found = _guarded(f"{key}.file", lambda: split_damping(basis.shapes.T @ damping @ basis.shapes, basis.eigenvalues))
    w = np.sqrt(basis.eigenvalues)
    ratios = np.divide(found.own, 2.0 * w, out=np.zeros_like(w), where=w > 0.0)
    return modal_model(basis, ratios, structure.ports, component.places, component.loss_factor, found.dashpots)


def build_modal(table: ModalTable, folder: Path, key: str) -> ModalModel:
    """The component of a table. Raises ModelError for data that do not fit."""
    file = _guarded(f"{key}.file", lambda: _modes(table, folder)) if table.file else None
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
    length, energy = _LENGTH[table.units], _ENERGY[table.units]
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
    return {dof: _found(found, dof, f"{key}.node") for dof in dofs}
