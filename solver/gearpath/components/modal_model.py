"""A structure known by its modes: frequencies, damping ratios and mass-normalised shapes at its ports."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..errors import InputError
from ..numerics.arrays import Real
from .dofs import DOFS
from .modes import Modes
from .rigid_body import Vector
from .structure import Structure


@dataclass(frozen=True)
class ModalModel:
    """q'' + (diag(2 zeta w) + D^T D) q' + (1 + i eta) diag(w^2) q = Phi^T f at the ports.

    Modes that it leaves out are missing: their static response too. Equal to any other of the same numbers. Plain
    tuples, so that `repr` builds it.
    """

    eigenvalues: tuple[float, ...]  # w^2, (rad/s)^2, ascending; 0 for rigid-body modes, which come first
    damping_ratios: tuple[float, ...]  # zeta of every mode; those of rigid-body modes count for nothing
    ports: Mapping[str, Mapping[str, tuple[float, ...]]]  # port -> degree of freedom -> its mass-normalised shape
    places: Mapping[str, Vector] = field(default_factory=dict)  # m, of ports whose place is known
    loss_factor: float = 0.0
    dashpots: tuple[tuple[float, ...], ...] = ()  # rows of D: viscous damping that couples the modes

    def __hash__(self) -> int:
        shapes = tuple((name, *dofs.items()) for name, dofs in self.ports.items())
        damping = (self.damping_ratios, self.loss_factor, self.dashpots)
        return hash((self.eigenvalues, damping, shapes, *self.places.items()))

    def position(self, port: str) -> Vector | None:
        """Place of a port, m; None where it is not known."""
        return self.places.get(port)

    def modes(self) -> Modes:
        """Its modes are its coordinates."""
        return Modes(np.array(self.eigenvalues), np.eye(len(self.eigenvalues)))

    def structure(
        self, dofs: Sequence[str], ports: Mapping[str, str | Vector], probes: Mapping[str, str | Vector] | None = None
    ) -> Structure:
        """Unit mass, diagonal stiffness, and the rows of each of ports and probes, which name ports.

        `modal_damping` is the mean ratio of the elastic modes, or the least of them where stiff modes that are damped
        beyond critical make the mean so; `damping_ratios` are those of all modes, None where all are one ratio: then
        rigid joints treat it as that of any structure (`network.joined_damping`).
        """
        L = np.array(self.eigenvalues)
        elastic = L > 0.0
        ratios = np.where(elastic, self.damping_ratios, 0.0)
        one = len(set(ratios[elastic].tolist())) < 2 and not self.dashpots
        mean = float(ratios[elastic].mean() if elastic.any() and not one else ratios.max(initial=0.0))
        if mean >= 1.0:
            mean = float(ratios[ratios > 0.0].min())
        rows = {key: named_rows(self.ports, port, dofs, len(L)) for key, port in {**ports, **(probes or {})}.items()}
        return Structure(
            mass=np.eye(len(L)),
            stiffness=np.diag(L),
            rigid_modes=np.eye(len(L))[:, ~elastic],
            modal_damping=mean,
            ports=rows,
            loss_factor=self.loss_factor,
            damping_ratios=None if one else ratios,
            dashpots=np.array(self.dashpots) if self.dashpots else None,
        )


def modal_model(
    basis: Modes,
    ratios: Sequence[float] | Real,
    ports: Mapping[str, Real],
    places: Mapping[str, Vector],
    loss_factor: float,
    dashpots: Real | None = None,
) -> ModalModel:
    """The modes of a structure, shapes (n, N), as they are seen by the rows (6, n) of its ports; those without motion
    are left out of a port. `dashpots` (k, N) act on the modes.
    """
    seen = {name: np.asarray(rows @ basis.shapes) for name, rows in ports.items()}
    return ModalModel(
        tuple(basis.eigenvalues.tolist()),
        tuple(np.asarray(ratios, float).tolist()),
        {name: {dof: tuple(row.tolist()) for dof, row in zip(DOFS, rows) if row.any()} for name, rows in seen.items()},
        dict(places),
        loss_factor,
        () if dashpots is None else tuple(tuple(row) for row in dashpots.tolist()),
    )


def named_rows(
    ports: Mapping[str, Mapping[str, Sequence[float] | Real]], port: str | Vector, dofs: Sequence[str], size: int
) -> Real:
    """Rows (6, size) of a port by its name; zero where it has no such degree of freedom or `dofs` leaves it out."""
    if not isinstance(port, str) or port not in ports:
        raise InputError(f"a component has no port {port!r}; name one of: {', '.join(ports)}")
    rows = np.zeros((6, size))
    for dof, shape in ports[port].items():
        if dof in dofs:
            rows[DOFS.index(dof)] = shape
    return rows
