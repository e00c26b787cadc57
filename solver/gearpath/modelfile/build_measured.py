"""Measured components from their tables: FRFs of a file as mobilities between the freedoms of the ports, SI units."""

import warnings
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

import numpy as np

from ..components import Measured
from ..components.dofs import is_rotation
from ..components.driving_points import active_part, complaint
from ..errors import InputError, ModelError
from ..fitting import as_mobility
from ..numerics.arrays import Complex, Real
from .data.frf import FrfFile
from .data.frf_csv import read_csv
from .data.frf_npz import read_npz
from .data.frf_uff import read_uff
from .hints import hint
from .measured_tables import FORCES, MOTIONS, MeasuredTable
from .wording import show

_SAME = 1e-4  # relative difference of two statements of one unit
_OFTEN = 0.05  # of the driving-point values, that noise does not make active
READERS = {".npz": read_npz, ".csv": read_csv, ".unv": read_uff, ".uff": read_uff, ".uf": read_uff}


def build_measured(table: MeasuredTable, folder: Path, key: str) -> Measured:
    """The component of a table of a model file in `folder`; raises ModelError for data that do not fit it."""
    file = _read(table, folder, key)
    quantity = _quantity(table, file, key)
    places = [(port, dof, item) for port, one in table.ports.items() for dof, item in one.channels.items()]
    picked = _picked(file, places, key)
    frf = _reciprocal(file.frf[:, picked][:, :, picked], places, key)
    omega = 2.0 * np.pi * file.frequencies
    mobility = as_mobility(omega, frf * _scale(table, file, quantity, [dof for _, dof, _ in places], key), quantity)
    _check_driving_points(omega, mobility, quantity, [f"{port}.{dof}" for port, dof, _ in places], key)
    ports: dict[str, dict[str, int]] = {name: {} for name in table.ports}
    for k, (port, dof, _) in enumerate(places):
        ports[port][dof] = k
    where = {name: port.at for name, port in table.ports.items() if port.at is not None}
    return Measured(omega, mobility, ports, where, table.tolerance, table.modes)


def _read(table: MeasuredTable, folder: Path, key: str) -> FrfFile:
    path = folder / table.file
    suffix = path.suffix.lower()
    if suffix not in READERS:
        raise ModelError(f"{key}.file", f"{show(table.file)} is no file of FRFs", "give a .unv, .uff, .npz or .csv")
    if not path.is_file():
        remedy = "give the path of a file of FRFs, from the folder of the model file"
        raise ModelError(f"{key}.file", f"{show(table.file)}: there is no such file", remedy)
    stamp = path.stat()
    try:
        return _remembered(suffix, path, stamp.st_mtime_ns, stamp.st_size)
    except InputError as error:
        problem, _, remedy = str(error).partition("; ")
        raise ModelError(f"{key}.file", problem, remedy) from None


@lru_cache(maxsize=8)
def _remembered(suffix: str, path: Path, changed: int, size: int) -> FrfFile:  # noqa: ARG001
    """The file, read once: a model is changed and checked again many times in a study."""
    return READERS[suffix](path)


def _quantity(table: MeasuredTable, file: FrfFile, key: str) -> str:
    if table.quantity and file.quantity and table.quantity != file.quantity:
        raise ModelError(
            f"{key}.quantity",
            f"{show(table.quantity)} is given for a file that holds {file.quantity}",
            "leave quantity out",
        )
    if not (table.quantity or file.quantity):
        raise ModelError(f"{key}.quantity", "is missing, and the file does not say it", 'give "accelerance", ...')
    return table.quantity or file.quantity


def _picked(file: FrfFile, places: list[tuple[str, str, int | str]], key: str) -> list[int]:
    """Where the channels of the ports' freedoms stand in the file."""
    picked: list[int] = []
    for port, dof, item in places:
        here = f"{key}.ports.{port}.{dof}"
        if isinstance(item, int) and item >= len(file.channels):
            raise ModelError(
                here, f"there is no channel {item} among {len(file.channels)}", f"give 0 to {len(file.channels) - 1}"
            )
        if isinstance(item, str) and item not in file.channels:
            raise ModelError(here, f"there is no channel {show(item)}", hint(item, file.channels))
        place = item if isinstance(item, int) else file.channels.index(item)
        if place in picked:
            port_2, dof_2, _ = places[picked.index(place)]
            raise ModelError(here, f"{show(item)} is already the channel of {port_2}.{dof_2}", "give another one")
        picked.append(place)
    return picked


def _reciprocal(frf: Complex, places: list[tuple[str, str, int | str]], key: str) -> Complex:
    """The FRFs with every missing one taken from its transpose; raises ModelError where both are missing."""
    given = np.isfinite(frf)
    frf = np.where(given, frf, frf.swapaxes(1, 2))
    lacking = np.argwhere(~np.isfinite(frf).all(axis=0))
    if len(lacking):
        (port, dof, _), (port_2, dof_2, _) = (places[k] for k in lacking[0])
        raise ModelError(
            f"{key}.ports",
            f"the file has no complete FRF between {port}.{dof} and {port_2}.{dof_2}, either way",
            "measure it, or leave one of them out",
        )
    return np.asarray(frf)


def _scale(table: MeasuredTable, file: FrfFile, quantity: str, dofs: list[str], key: str) -> Real:
    """SI units per unit of the file, (m, m); rotations are in rad, moments in units of force times length."""
    if isinstance(table.unit_motion, str) and table.unit_motion not in MOTIONS[quantity]:
        raise ModelError(
            f"{key}.unit_motion", f"{show(table.unit_motion)} is no unit of {quantity}", hint("", MOTIONS[quantity])
        )
    length = 1.0 if table.unit_motion is not None or file.length is None else file.length
    motion = _unit(table.unit_motion, file.motion_label, file.length, MOTIONS[quantity], f"{key}.unit_motion")
    force = _unit(table.unit_force, file.force_label, file.force, FORCES, f"{key}.unit_force")
    turns = np.array([is_rotation(dof) for dof in dofs])
    return np.where(turns, 1.0, motion)[:, None] / np.where(turns, force * length, force)


def _unit(given: str | float | None, label: str, stated: float | None, known: Mapping[str, float], key: str) -> float:
    """A unit in SI: as the table gives it, else as the file does, by its dataset of units or on its axis."""
    written = {_plain(name): name for name in known}.get(_plain(label))
    if given is not None:
        chosen = known[given] if isinstance(given, str) else given
        if written and _differ(known[written], chosen):
            warnings.warn(f"{key}: {show(given)} counts, though the file says {label} on an axis", stacklevel=2)
        return chosen
    if label and written is None and (stated is None or _plain(label) in _UNITS):
        raise ModelError(
            key,
            f"is missing; the file says {show(label)} on an axis, which is none of the units {', '.join(known)}",
            "check the quantity, and give one of these or a number of SI units",
        )
    if written and stated is not None and _differ(known[written], stated):
        raise ModelError(
            key,
            f"is missing; the file says {label} on an axis, and {stated:g} of SI units by its dataset 164",
            f"give it as {show(written)} or as that number",
        )
    return known[written] if written else stated or 1.0


def _differ(one: float, other: float) -> bool:
    return abs(one / other - 1.0) > _SAME


def _plain(label: str) -> str:
    """A unit as it is compared: "m/s^2", "(m/s**2)", "m/s/s" and "M/S2" are one."""
    return label.lower().translate(str.maketrans("", "", " ()[]^*")).replace("/s/s", "/s2")


_UNITS = {_plain(name) for words in (FORCES, *MOTIONS.values()) for name in words}


def _check_driving_points(omega: Real, mobility: Complex, quantity: str, channels: list[str], key: str) -> None:
    """Refuses data that cannot be what they are said to be, and warns of such as are active for another reason."""
    found = complaint(omega, mobility, quantity, channels)
    if found:
        raise ModelError(
            f"{key}.quantity", f"is {quantity}, but {found}", "check quantity, signs and units of the file"
        )
    active = active_part(mobility)
    if active > _OFTEN:
        warnings.warn(
            f"{key}: {100.0 * active:.0f} % of the driving-point values give off power, as nothing passive does; "
            "power ratios there are not to be trusted",
            stacklevel=2,
        )
