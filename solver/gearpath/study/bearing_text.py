"""Bearings in words and numbers, for a terminal."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..joints.bearings.checks import DOFS
from ..numerics.arrays import Real
from .bearings import (
    Case,
    Curve,
    Phases,
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

BAR = 32  # characters of the heaviest element
_MOTION = ("m", "m", "m", "rad", "rad", "rad")
_LOAD = ("N", "N", "N", "N m", "N m", "N m")
_WORDS = {"torque": "torque through the gears"}
UNITS = {
    "displacement": dict(zip(DOFS, _MOTION)),
    "load": dict(zip(DOFS, _LOAD)),
    "stiffness": [[unit(i, j) for j in range(6)] for i in range(6)],
}


def text(case: Case) -> list[tuple[str, list[str]]]:
    """Sections of a case: heading and lines."""
    state = case.state
    numbers = [f"iterations {state.iterations}, residual {state.residual:.1e} of the load"]
    sections = [
        (f"{case.name}: {given_words(case)}", geometry_lines(case)),
        ("Displacement of the inner ring and load on it", _state_lines(case)),
        ("Stiffness K (entries that are zero stand as 0)", matrix_lines(state.stiffness)),
        (f"Load distribution ({state.loaded} of {len(state.element_loads)} elements loaded)", _element_lines(case)),
        ("Equilibrium", numbers),
    ]
    if case.curve is not None:
        sections.append((f"Stiffness against {_WORDS.get(case.curve.over, case.curve.over)}", curve_lines(case.curve)))
    if case.phases is not None:
        sections.append(("Positions of the cage", phase_lines(case.phases)))
    if state.notes:
        sections.append(("Notes", [f"note: {note}" for note in state.notes]))
    return sections


def given_words(case: Case) -> str:
    """What decides the state, with units."""
    if case.over == "preload":
        force = case.given.get("uz", 0.0)
        return f"preload {force:g} N" if force else "its own preload"
    if case.over == "torque":
        return f"at the operating point of the machine, torque {case.given['torque']:g} N m"
    units = UNITS[case.over]
    assert isinstance(units, dict)
    words = f"{case.over} " + ", ".join(f"{name} = {value:g} {units[name]}" for name, value in case.given.items())
    return words + (f", preload {case.preload:g} N" if case.preload else "")


def geometry_lines(case: Case) -> list[str]:
    """One line a row of elements, in mm, um and degrees, and the source of the numbers."""
    rows = list(rows_of(case.bearing))
    lines = [row_words(geometry(row), z if len(rows) > 1 else None) for row, z in rows]
    return lines + ([f"source: {case.source}"] if case.source else [])


def row_words(data: Mapping[str, Any], place: float | None = None) -> str:
    """Geometry of a row of elements."""
    if data["type"] == "ball":
        body = (
            f"{data['balls']} balls of {1e3 * data['ball_diameter']:g} mm on {1e3 * data['pitch_diameter']:g} mm, "
            f"conformities {data['inner_conformity']:g} and {data['outer_conformity']:g}"
        )
    else:
        body = (
            f"{data['rollers']} rollers of length {1e3 * data['roller_length']:g} mm on the radius "
            f"{1e3 * data['pitch_radius']:g} mm, {data['slices']} slice{'s' if data['slices'] > 1 else ''}"
        )
    parts = [body, f"contact angle {np.degrees(data['contact_angle']):.4g} deg"]
    if data["radial_clearance"]:
        parts.append(f"radial clearance {1e6 * data['radial_clearance']:g} um")
    power = "1.5" if data["type"] == "ball" else "(10/9)"
    parts.append(f"Kn {data['contact_stiffness']:.4g} N/m^{power}")
    parts.append(f"first element at {np.degrees(data['phase']):.4g} deg")
    return ("" if place is None else f"row at z = {1e3 * place:g} mm: ") + ", ".join(parts)


def _state_lines(case: Case) -> list[str]:
    state = case.state
    held = case.over == "load"
    load = carried(case)
    lines = [f"{'':4}{'displacement':>14}{'':6}{'load':>13}"]
    for k, dof in enumerate(DOFS[:5]):
        how = "" if not held else ("  free" if dof in case.free else "  held")
        line = f"{dof:4}{state.displacement[k]:14.5e} {_MOTION[k]:5}{load[k]:13.5g} {_LOAD[k]:4}{how}"
        lines.append(line.rstrip())
    return [*lines, "rz  turns freely"]


def matrix_lines(stiffness: Real) -> list[str]:
    """The 6x6 matrix with the unit of every block beside its rows."""
    K = shown(stiffness)
    head = "".join(f"{name:>11}" for name in DOFS[:3]) + " " * 8 + "".join(f"{name:>11}" for name in DOFS[3:])
    lines = [f"{'':3}{head}"]
    for i, name in enumerate(DOFS):
        cells = [f"{'0':>11}" if K[i, j] == 0.0 else f"{K[i, j]:11.3e}" for j in range(6)]
        lines.append(f"{name:3}{''.join(cells[:3])} {unit(i, 0):7}{''.join(cells[3:])} {unit(i, 3)}")
    return [*lines, "(N/rad = N m/m)"]


def _element_lines(case: Case) -> list[str]:
    found = elements(case.bearing, case.state)
    most = max(item.load for item in found) or 1.0
    many = found[-1].row > 1
    lines = [f"{'row ' if many else ''}{'element':>7}{'position, deg':>15}{'load, N':>12}{'contact angle, deg':>20}"]
    for item in found:
        bar = "#" * int(np.ceil(BAR * item.load / most))
        row = f"{item.row:3} " if many else ""
        place, angle = np.degrees(item.position), np.degrees(item.contact_angle)
        lines.append(f"{row}{item.number:7}{place:15.2f}{item.load:12.5g}{angle:20.3f}  {bar}".rstrip())
    return lines


def curve_lines(curve: Curve) -> list[str]:
    """Diagonal and strongest coupling entries at the factors of the table."""
    pairs = [(k, k) for k in diagonal(curve.stiffness)] + couplings(curve.stiffness)[:3]
    size = "" if curve.unit == "1" else f"{f'{curve.over}, {curve.unit}':>17}"
    lines = [f"{'factor':>6}{size}" + "".join(f"{entry(*pair):>11}" for pair in pairs)]
    lines.append(" " * (6 + len(size)) + "".join(f"{unit(*pair):>11}" for pair in pairs))
    for k in curve.rows():
        K = curve.stiffness[k]
        value = "" if curve.unit == "1" else f"{curve.values[k]:17.5g}"
        if np.isnan(K).any():
            lines.append(f"{curve.factors[k]:6g}{value}  cannot be carried")
            continue
        K = shown(K)
        cells = [f"{'0':>11}" if K[pair] == 0.0 else f"{K[pair]:11.3e}" for pair in pairs]
        lines.append(f"{curve.factors[k]:6g}{value}{''.join(cells)}")
    return lines


def phase_lines(phases: Phases) -> list[str]:
    """The average over the cage's positions, and how far every diagonal entry spreads about it."""
    low, high = phases.diagonal
    mean = phases.average
    lines = [f"average over {len(phases.stiffness)} positions:", *matrix_lines(mean), "spread of the diagonal:"]
    lines.append(f"{'':4}{'smallest':>12}{'largest':>12}{'spread / average':>18}")
    for k in range(5):
        spread = f"{100.0 * (high[k] - low[k]) / mean[k, k]:15.3g} %" if mean[k, k] > 0.0 else f"{'0':>15}"
        lines.append(f"{DOFS[k]:4}{low[k]:12.4e}{high[k]:12.4e}{spread:>18} {unit(k, k)}")
    return lines
