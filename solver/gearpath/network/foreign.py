"""Components of files in a line each: a mistake in units or supports shows in mass and frequencies at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..components import DOFS, TRANSLATIONS, Matrices, Measured, ModalModel, Modes
from ..numerics.arrays import Real
from .ports import Ports
from .system import System

_EXACT = 1e-6  # m beside motions of 1 m: the ports follow a rigid translation


def described(system: System) -> dict[str, str]:
    """Kind, size, rigid motions, first elastic frequency and mass of every component that comes from a file.

    Ports that lack an active degree of freedom follow: nothing resists it there.
    """
    chosen = (Matrices, ModalModel, Measured)
    if not any(isinstance(item, chosen) for item in system.components.values()):
        return {}
    ports = Ports(system)
    return {
        name: ", ".join(_measured(item) if isinstance(item, Measured) else _modal(item, ports.bases[name]))
        + _lacking(item, system.dofs)
        for name, item in system.components.items()
        if isinstance(item, chosen)
    }


def _lacking(item: Matrices | ModalModel | Measured, dofs: Sequence[str]) -> str:
    without: dict[str, list[str]] = {}
    for port, own in item.ports.items():
        lacking = " ".join(dof for dof in dofs if dof not in own)
        if lacking:
            without.setdefault(lacking, []).append(port)
    return "".join(f"; without {lacking}: {', '.join(ports)}" for lacking, ports in without.items())


def _measured(item: Measured) -> list[str]:
    low, high = item.band
    return [
        "measured",
        f"{item.channels} channels",
        f"{len(item.omega)} lines from {low:g} to {high:g} Hz",
        *_at_first_line(item),
    ]


def _at_first_line(item: Measured) -> list[str]:
    """Masses 1 / (w |Y|) and stiffnesses w / |Y| that the driving points of translations move like there."""
    rows = [k for channels in item.ports.values() for dof, k in channels.items() if dof in TRANSLATIONS]
    own = item.mobility[0][rows, rows]
    w, own = item.omega[0], own[own != 0.0]
    like = {"kg": 1.0 / (w * abs(own[own.imag < 0.0])), "N/m": w / abs(own[own.imag >= 0.0])}
    return [
        f"at the first like {values.min():.3g} to {values.max():.3g} {unit}"
        for unit, values in like.items()
        if values.size
    ]


def _modal(item: Matrices | ModalModel, basis: Modes) -> list[str]:
    rigid = int(np.count_nonzero(basis.eigenvalues == 0.0))
    words = ["matrices" if isinstance(item, Matrices) else "modal"]
    words.append(f"{len(basis.eigenvalues)} modes, {rigid} rigid")
    if rigid < len(basis.eigenvalues):
        words.append(f"first elastic one {basis.frequencies[rigid]:.4g} Hz")
    shapes = item.structure(DOFS, {name: name for name in item.ports}).ports
    masses = _masses({name: rows @ basis.shapes[:, :rigid] for name, rows in shapes.items()})
    if masses:
        words.append("mass " + ", ".join(f"{mass:.4g} kg along {dof}" for dof, mass in masses.items()))
    return words


def _masses(ports: dict[str, Real]) -> dict[str, float]:
    """Mass along each translation that the rigid modes, mass-normalised, hold as all ports see it; all in one if equal.

    The rigid motion R c with a unit translation of all ports has the kinetic energy c^T c / 2 of the mass.
    """
    rows = np.vstack(list(ports.values()))
    dof_of = np.tile(np.arange(6), len(ports))
    seen = rows.any(axis=1)
    found = {}
    for dof in TRANSLATIONS:
        wanted = np.where(dof_of == DOFS.index(dof), 1.0, 0.0)[seen]
        if not wanted.any():
            continue
        c, _, rank, _ = np.linalg.lstsq(rows[seen], wanted, rcond=1e-9)
        if rank == rows.shape[1] and abs(rows[seen] @ c - wanted).max() < _EXACT:
            found[dof] = float(c @ c)
    values = list(found.values())
    if len(values) > 1 and max(values) - min(values) < 1e-6 * max(values):
        return {" ".join(found): values[0]}
    return found
