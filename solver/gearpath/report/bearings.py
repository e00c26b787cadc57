"""Rolling bearings in the report: tables of geometry, loads, stiffness and limits, and their figures."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..joints.bearings.checks import DOFS
from ..numerics.arrays import Real
from ..study.bearing_text import UNITS, row_words
from ..study.bearings import (
    Case,
    carried,
    couplings,
    diagonal,
    elements,
    entry,
    geometry,
    rows_of,
    shown,
    unit,
)
from ..study.mounted_bearings import rolling_joints, study_machine
from .bearing_figures import curve_figure, over_words, polar_figure
from .layout import Figure
from .table import Cell, Group, MatrixCell, Table, table
from .wording import number, plural, quantity

if TYPE_CHECKING:
    from ..modelfile import Model


@dataclass(frozen=True)
class BearingSection:
    """What the report of a model shows of its rolling bearings."""

    words: str
    tables: Sequence[Table]
    polar: Figure
    curves: Sequence[Figure]
    notes: Sequence[tuple[str, str]]  # joint, sentence

    @property
    def figures(self) -> list[Figure]:
        """All of them."""
        return [self.polar, *self.curves]


def bearing_section(model: Model) -> BearingSection | None:
    """The section of a model's rolling bearings at their operating point; None where it has none."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # they are the notes
        system = model.system
    if not rolling_joints(system):
        return None
    cases = study_machine(system)
    where = "at the loads that the model gives them"
    if system.operation is not None:
        where = (
            f"at {quantity(system.operation.torque, 'N.m')} on the driving shaft, where the machine is in static "
            "equilibrium; bearings with a load or displacement of their own are at that"
        )
    words = (
        f"{plural(len(cases), 'bearing')} given by geometry, {where}. Loads act on the inner ring. "
        "Degrees of freedom that the model leaves out are held. Where the theory stops is listed below the curves."
    )
    drawn = [case for case in cases if case.curve is not None]
    curves = [curve_figure(case, f"bearing-curve-{k}", case.name) for k, case in enumerate(drawn)]
    notes = [(case.name, note) for case in cases for note in case.state.notes]
    return BearingSection(words, [summary_table(cases), load_table(cases)], polar_figure(cases), curves, notes)


def typeset(text: str) -> str:
    """Units of the terminal as they are printed."""
    return text.replace(" deg", "°").replace(" um", "\u00a0µm").replace(" -", " −")


def geometry_words(case: Case) -> str:
    """Geometry of all rows."""
    rows = list(rows_of(case.bearing))
    return typeset("; ".join(row_words(geometry(row), z if len(rows) > 1 else None) for row, z in rows))


def summary_table(cases: Sequence[Case]) -> Table:
    """Geometry, what decides the state, loaded elements and accuracy of every bearing."""
    rows: list[list[Cell]] = []
    for case in cases:
        state = case.state
        heaviest = number(float(state.element_loads.max()))
        loaded = f"{state.loaded} of {len(state.element_loads)}"
        rows.append([case.name, geometry_words(case), given_words(case), loaded, heaviest, f"{state.residual:.0e}"])
    head = ["bearing", "geometry", "operates at", "loaded elements", "heaviest load, N", "residual / load"]
    return table("Rolling bearings", head, rows, text=3)


def given_words(case: Case) -> str:
    """What decides the state."""
    if case.over == "torque":
        return f"torque {quantity(case.given['torque'], 'N.m')}"
    if case.over == "preload":
        return f"preload {quantity(case.given['uz'], 'N')}" if case.given else "its own preload"
    units = UNITS[case.over]
    assert isinstance(units, dict)
    words = f"{case.over} " + ", ".join(f"{dof} {quantity(value, units[dof])}" for dof, value in case.given.items())
    return words + (f", preload {quantity(case.preload, 'N')}" if case.preload else "")


def load_table(cases: Sequence[Case]) -> Table:
    """Load on the inner ring and its displacement, five degrees of freedom each."""

    def rows(values: Sequence[Real]) -> list[list[Cell]]:
        return [[case.name, *(number(value) for value in row[:5])] for case, row in zip(cases, values)]

    loads = [carried(case) for case in cases]
    moves = [case.state.displacement for case in cases]
    groups = [Group(rows(loads), "load, N and N m"), Group(rows(moves), "displacement of the inner ring, m and rad")]
    return Table("Loads and displacements", ["bearing", *DOFS[:5]], groups)


def matrix_table(name: str, stiffness: Real, caption: str = "Stiffness K") -> Table:
    """The 6x6 matrix with the unit of every entry; entries that are zero stand as 0."""
    K = shown(stiffness)
    cell = MatrixCell(DOFS, [[(number(K[i, j], 4), unit(i, j)) for j in range(6)] for i in range(6)])
    note = "N/rad = N m/m. Force or moment on the inner ring (row) by its displacement (column)."
    return table(caption, ["bearing", "K on ux, uy, uz, rx, ry, rz"], [[name, cell]], text=2, note=note)


def element_table(case: Case) -> Table:
    """The load distribution."""
    found = elements(case.bearing, case.state)
    rows = [
        [
            f"{item.row}.{item.number}" if found[-1].row > 1 else str(item.number),
            number(float(np.degrees(item.position)), 5),
            number(item.load, 5),
            number(float(np.degrees(item.contact_angle)), 4),
        ]
        for item in found
    ]
    caption = f"Load distribution: {case.state.loaded} of {len(found)} elements loaded"
    return table(caption, ["element", "position, °", "load, N", "contact angle, °"], rows)


def curve_table(case: Case) -> Table:
    """Stiffness at the factors of the table: diagonal and couplings."""
    curve = case.curve
    assert curve is not None, "a bearing that nothing loads has no curve"
    pairs = [(k, k) for k in diagonal(curve.stiffness)] + couplings(curve.stiffness)
    rows = []
    for k in curve.rows():
        K = curve.stiffness[k]
        carried = not np.isnan(K).any()
        cells = [number(shown(K)[pair]) if carried else "not carried" for pair in pairs]
        rows.append([number(curve.values[k], 4), *cells])
    head = [over_words(curve), *(f"{entry(*pair)}, {unit(*pair)}" for pair in pairs)]
    return table(f"Stiffness against {curve.over}", head, rows)


def phase_table(case: Case) -> Table:
    """Average over the cage's positions and the spread of the diagonal."""
    phases = case.phases
    assert phases is not None, "the cage was not turned"
    low, high = phases.diagonal
    mean = phases.average
    rows = [[f"{DOFS[k]}, {unit(k, k)}", *(number(v, 4) for v in (mean[k, k], low[k], high[k]))] for k in range(5)]
    caption = f"Over {len(phases.stiffness)} positions of the cage"
    return table(caption, ["entry", "average", "smallest", "largest"], rows)
