"""Components of matrices from their tables: stiffness, mass and damping of a file in SI units, and their ports."""

from dataclasses import replace
from functools import lru_cache
from math import dist
from pathlib import Path

import numpy as np
import scipy.sparse

from ..components import DOFS, Matrices, ModalModel, modal_model, modes, split_damping
from ..components.dofs import is_rotation
from ..components.free_matrices import checked, free_matrices
from ..errors import InputError, ModelError
from ..joints.joint import Vector
from ..numerics.arrays import Real, Sparse
from .data.calculix import read_calculix
from .data.matrices import MatrixFile
from .data.matrix_market import read_matrix_market
from .data.npz import read_npz
from .data.op4 import read_op4
from .foreign_files import ENERGY, LENGTH, found_in, guarded
from .foreign_tables import MatricesTable, MatrixPortTable
from .wording import show

Stamps = tuple[tuple[int, int], ...]
_MATRIX_FORMATS = (".npz", ".op4", ".sti", ".mtx")
_BESIDE = {"modal_damping", "loss_factor", "vectors"}  # keys that change nothing about the matrices
_DENSE = 600  # coordinates up to which all modes of a sparse structure are kept
SAME_PLACE = 1e-4  # m between the place of a node in a file and that in the model: both may be rounded
_MOST = 3000  # coordinates of a structure with a damping matrix, whose modes are all computed


def build_matrices(table: MatricesTable, folder: Path, dofs: tuple[str, ...], key: str) -> Matrices | ModalModel:
    """The component of a table; with a damping matrix in its modes. Raises ModelError for data that do not fit.

    Prepared once for the same files and ports: a model is changed and checked again many times in a study.
    """
    text = table.model_dump_json(exclude_unset=True, exclude=_BESIDE)
    component = _prepared(text, folder, dofs, key, _stamps(table, folder))
    if isinstance(component, ModalModel) and table.modal_damping:
        remedy = "leave one of them out of the file and the table"
        raise ModelError(f"{key}.modal_damping", "is given beside a damping matrix", remedy)
    return _with_damping(component, table.modal_damping, table.loss_factor)


@lru_cache(maxsize=8)
def _with_damping(component: Matrices | ModalModel, ratio: float, loss_factor: float) -> Matrices | ModalModel:
    if isinstance(component, Matrices):
        return replace(component, modal_damping=ratio, loss_factor=loss_factor)
    return replace(component, loss_factor=loss_factor)


@lru_cache(maxsize=8)
def _prepared(text: str, folder: Path, dofs: tuple[str, ...], key: str, changed: Stamps) -> Matrices | ModalModel:
    """The component without modal damping and loss factor."""
    table = MatricesTable.model_validate_json(text)
    file = guarded(f"{key}.file", lambda: _matrices(table, folder, changed))
    ports = {name: _coordinates(port, file, dofs, f"{key}.ports.{name}") for name, port in table.ports.items()}
    scale = np.where(_turns(file, ports), 1.0, LENGTH[table.units])
    if file.damping is not None and len(scale) > _MOST:
        problem = f"holds a damping matrix of {len(scale)} x {len(scale)}, more than {_MOST}"
        raise ModelError(f"{key}.file", problem, "leave it out and give modal_damping or loss_factor")

    def si(matrix: Real | Sparse, dense: bool = file.damping is not None) -> Real | Sparse:
        return _si(matrix, scale, ENERGY[table.units], dense)

    given = file.damping
    damping = None if given is None else guarded(f"{key}.file", lambda: np.asarray(checked("damping", si(given))))
    loaded = [place for places in ports.values() for place in places.values()]
    loaded += [] if damping is None else np.flatnonzero(damping.any(axis=0)).tolist()
    prepared = guarded(
        f"{key}.file", lambda: free_matrices(si(file.mass), si(file.stiffness), loaded, table.rigid_motions)
    )
    component = Matrices(
        prepared.mass,
        prepared.stiffness,
        prepared.rigid_modes,
        ports,
        _places(table, file, key),
        motion=prepared.motion,
    )
    return component if damping is None else _damped(component, damping, key)


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
        return {dof: found_in(found, dof, f"{key}.node") for dof in port.supplied(dofs)}
    places = port.named
    if port.coordinates is not None:
        names = port.supplied(dofs)
        if not names:
            counts = " or ".join(str(count) for count in sorted({3, 6, len(dofs)}))
            raise ModelError(
                key, f"has {len(port.coordinates)} coordinates", f"give {counts}, or name them as ux = ..."
            )
        places = dict(zip(names, port.coordinates))
    if len(set(places.values())) < len(places):
        raise ModelError(key, f"has one coordinate for several of {', '.join(places)}", "give each its own")
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
    if scipy.sparse.issparse(matrix) and not dense and len(scale) > _DENSE:
        inverse = scipy.sparse.diags_array(1.0 / scale)
        return scipy.sparse.csc_array(energy * (inverse @ matrix @ inverse))
    full: Real = scipy.sparse.csc_array(matrix).toarray() if scipy.sparse.issparse(matrix) else matrix
    return np.asarray(energy * full / np.outer(scale, scale))


def _places(table: MatricesTable, file: MatrixFile, key: str) -> dict[str, Vector]:
    length, places = LENGTH[table.units], {}
    for name, port in table.ports.items():
        if port.node is not None and port.node in file.positions:
            x, y, z = file.positions[port.node]
            places[name] = (length * x, length * y, length * z)
        if port.at is not None and dist(port.at, places.setdefault(name, port.at)) > SAME_PLACE:
            raise ModelError(
                f"{key}.ports.{name}.at",
                f"{show(list(port.at))} is given beside node {port.node}, which the file places at "
                f"[{', '.join(f'{x:g}' for x in places[name])}] m",
                "leave one of them out",
            )
    return places


def _damped(component: Matrices, damping: Real, key: str) -> ModalModel:
    """The component in its modes, with the damping ratio of each and dashpots for what couples them."""
    structure = component.structure(DOFS, {name: name for name in component.ports})
    basis = modes(structure)
    shapes = basis.shapes if component.motion is None else component.motion @ basis.shapes
    found = guarded(f"{key}.file", lambda: split_damping(shapes.T @ damping @ shapes, basis.eigenvalues))
    w = np.sqrt(basis.eigenvalues)
    ratios = np.divide(found.own, 2.0 * w, out=np.zeros_like(w), where=w > 0.0)
    return modal_model(basis, ratios, structure.ports, component.places, component.loss_factor, found.dashpots)
