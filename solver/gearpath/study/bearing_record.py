"""Bearings as one document for machines."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..joints.bearings.checks import DOFS
from .bearing_text import UNITS
from .bearings import Case, elements, geometry, rows_of


def as_dict(cases: Sequence[Case]) -> dict[str, Any]:
    """All cases for machines, SI units, angles in rad but where the name says deg."""
    return {"units": UNITS, "dofs": DOFS, "bearings": [_case_dict(case) for case in cases]}


def _case_dict(case: Case) -> dict[str, Any]:
    state = case.state
    rows = [{"position": z, **geometry(row)} for row, z in rows_of(case.bearing)]
    found: dict[str, Any] = {"name": case.name, "source": case.source, "rows": rows, "decided_by": case.over}
    found |= {
        "given": dict(case.given),
        "preload": case.preload,
        "displacement": dict(zip(DOFS, state.displacement)),
        "load": dict(zip(DOFS, state.load)),
        "stiffness": state.stiffness,
        "elements": [
            {
                "row": item.row,
                "number": item.number,
                "position_deg": float(np.degrees(item.position)),
                "load": item.load,
                "contact_angle_deg": float(np.degrees(item.contact_angle)),
            }
            for item in elements(case.bearing, state)
        ],
        "loaded": state.loaded,
        "iterations": state.iterations,
        "residual": state.residual,
        "notes": state.notes,
    }
    if case.curve is not None:
        curve = case.curve
        some = {"over": curve.over, "unit": curve.unit, "factors": curve.factors, "values": curve.values}
        found["stiffness_against"] = {**some, "stiffness": curve.stiffness}
    if case.phases is not None:
        low, high = case.phases.diagonal
        spread = {"samples": len(case.phases.stiffness), "average": case.phases.average}
        found["phases"] = {**spread, "smallest_diagonal": low, "largest_diagonal": high}
    return found
