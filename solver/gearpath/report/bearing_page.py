"""The page of `gearpath bearing`: matrix, load distribution and stiffness over load of each bearing."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from ..study.bearings import Case
from .bearing_figures import curve_figure, polar_figure
from .bearings import (
    curve_table,
    element_table,
    load_table,
    matrix_table,
    phase_table,
    summary_table,
)
from .page import figure_data, renderer
from .wording import listed


def bearing_page(target: Path) -> Callable[[Sequence[Case]], Path]:
    """Check what can go wrong before the work; what comes back writes the cases as one HTML file.

    Raises MissingExtraError without plotly or jinja2, InputError where the file cannot be written.
    """
    render = renderer(target)

    def write(cases: Sequence[Case]) -> Path:
        parts = [_part(k, case) for k, case in enumerate(cases)]
        content = {
            "title": listed([case.name for case in cases]),
            "summary": summary_table(cases),
            "loads": load_table(cases),
            "parts": parts,
            "contents": [("summary", "Summary"), *((p["key"], p["name"]) for p in parts), ("method", "Method")],
            "data": figure_data([figure for part in parts for figure in part["figures"]]),
        }
        render("bearing.html.j2", content)
        return target

    return write


def _part(k: int, case: Case) -> dict[str, Any]:
    drawn = [polar_figure([case], f"loads-{k}")]
    tables = [element_table(case)]
    if case.curve is not None:
        drawn.append(curve_figure(case, f"curve-{k}"))
        tables.append(curve_table(case))
    if case.phases is not None:
        average = matrix_table(case.name, case.phases.average, "Stiffness K, average over the positions of the cage")
        tables += [phase_table(case), average]
    return {
        "key": f"bearing-{k}",
        "name": case.name,
        "source": case.source,
        "notes": case.state.notes,
        "iterations": case.state.iterations,
        "matrix": matrix_table(case.name, case.state.stiffness),
        "figures": drawn,
        "tables": tables,
    }
