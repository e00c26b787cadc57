"""Figures of rolling bearings: load distribution around the shaft, stiffness over load or torque."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Any

import numpy as np

from ..numerics.arrays import Real
from ..study.bearings import Case, Curve, Element, couplings, diagonal, elements, entry, shown, unit
from .layout import COLOURS, DASHES, GRID, INK, LEGEND, Figure, Trace, axis, line, page, panel_title, stacked, suffix
from .wording import number, plural

COLUMNS, CIRCLE, PANEL, GAP = 3, 340, 210, 46  # circles abreast; px of a circle's row, of a panel, between panels
BLOCKS = ("N/m", "N/rad", "N m/rad")
_WIDE = 0.62  # of the distance of two elements: the width of a bar


def polar_figure(cases: Sequence[Case], key: str = "bearing-loads") -> Figure:
    """Load of every rolling element at its place, one circle a bearing, one colour a row of elements."""
    columns = min(COLUMNS, len(cases))
    rows = -(-len(cases) // columns)
    data: list[Trace] = []
    layout = page(CIRCLE * rows + 40, annotations=[], hovermode="closest", showlegend=False)
    several = False
    for k, case in enumerate(cases):
        column, row = k % columns, k // columns
        domain = {"x": _part(column, columns, 0.1), "y": _part(rows - 1 - row, rows, 92.0 / (CIRCLE * rows))}
        layout[f"polar{suffix(k)}"] = _circle(case, domain)
        layout["annotations"].append(_heading(case, domain))
        found = [list(part) for _, part in groupby(elements(case.bearing, case.state), lambda item: item.row)]
        several = several or len(found) > 1
        data += [_bars(case, part, r, len(found), f"polar{suffix(k)}") for r, part in enumerate(found)]
    caption = (
        "Load on every rolling element at its place, N; the z axis points at the reader. The scale of every circle is "
        "its own."
    )
    if several:
        caption += " Of several rows the first is blue, the bars of the next stand within its own."
    words = f"Polar bar chart of the loads on the rolling elements of {plural(len(cases), 'bearing')}."
    return Figure(key, caption, words, data, layout)


def curve_figure(case: Case, key: str, heading: str = "") -> Figure:
    """Absolute entries of K over what loads the bearing, logarithmic on both axes, one panel a unit."""
    curve = case.curve
    assert curve is not None, "a bearing that nothing loads has no curve"
    panels = [(block, found) for block in BLOCKS if (found := _entries(curve, block))]
    height = PANEL * len(panels) + GAP * (len(panels) - 1)
    domains = stacked(len(panels), gap=GAP / height)
    layout = page(height + 120, annotations=[], hovermode="closest")
    layout["legend"] = {**LEGEND, "y": 1.0 + 24.0 / height}
    data: list[Trace] = []
    for k, ((block, found), domain) in enumerate(zip(panels, domains)):
        layout[f"yaxis{suffix(k)}"] = axis(f"|K|, {block}", type="log", exponentformat="power", domain=domain)
        layout["annotations"].append(panel_title(_title(block), domain))
        data += [_entry_line(curve, pair, n, f"y{suffix(k)}") for n, pair in enumerate(found)]
    shown_at = curve.rows()
    layout["xaxis"] = axis(
        over_words(curve),
        type="log",
        anchor=f"y{suffix(len(panels) - 1)}",
        tickvals=[float(f"{curve.values[i]:.9g}") for i in shown_at],
        ticktext=[number(curve.values[i]) for i in shown_at],
    )
    caption = (
        f"{case.name}: entries of the stiffness over the {over_words(curve)}; both axes logarithmic. Solid: diagonal, "
        "broken: couplings, by their size (−: negative). A gap: not carried, or no stiffness."
    )
    count = f"{plural(len(data), 'curve')} in {plural(len(panels), 'panel')}"
    words = f"Stiffness of {case.name} over its {curve.over}: {count}."
    return Figure(key, caption, words, data, layout, heading)


def over_words(curve: Curve) -> str:
    """What grows, with its unit."""
    if curve.over == "torque":
        return "torque on the driving shaft, N m"
    return f"factor of the given {curve.over}" if curve.unit == "1" else f"{curve.over}, {curve.unit}"


def _part(index: int, count: int, gap: float) -> list[float]:
    """One of so many equal intervals of 0 to 1, the gap left out at its end."""
    return [round(index / count, 4), round((index + 1) / count - gap, 4)]


def _circle(case: Case, domain: dict[str, list[float]]) -> dict[str, Any]:
    most = float(case.state.element_loads.max())
    return {
        "domain": domain,
        "bgcolor": "#ffffff",
        "barmode": "overlay",
        "angularaxis": {
            "direction": "counterclockwise",
            "rotation": 0,
            "tickvals": [0, 45, 90, 135, 180, 225, 270, 315],
            "ticktext": ["+x", "45°", "+y", "135°", "−x", "225°", "−y", "315°"],
            "gridcolor": GRID,
            "linecolor": INK,
            "tickfont": {"size": 11},
        },
        "radialaxis": {
            "range": [0.0, 1.08 * most if most > 0.0 else 1.0],
            "angle": 22.5,
            "tickangle": 0,
            "gridcolor": GRID,
            "nticks": 4,
            "tickfont": {"size": 10},
        },
    }


def _heading(case: Case, domain: dict[str, list[float]]) -> dict[str, Any]:
    state = case.state
    text = f"<b>{case.name}</b>, {state.loaded} of {len(state.element_loads)} loaded"
    (left, right), top = domain["x"], domain["y"][1]
    return {
        "text": f"{text}<br>heaviest {number(float(state.element_loads.max()))} N",
        "xref": "paper",
        "yref": "paper",
        "x": 0.5 * (left + right),
        "y": top,
        "yshift": 18,
        "xanchor": "center",
        "yanchor": "bottom",
        "showarrow": False,
        "font": {"size": 12},
    }


def _bars(case: Case, found: Sequence[Element], row: int, rows: int, subplot: str) -> Trace:
    width = 360.0 / len(found) * _WIDE * (1.0 - row / rows)
    return {
        "type": "barpolar",
        "name": case.name if rows == 1 else f"{case.name}, row {row + 1}",
        "subplot": subplot,
        "theta": [float(f"{np.degrees(item.position):.9g}") for item in found],
        "r": [float(f"{item.load:.6g}") for item in found],
        "width": [float(f"{width:.6g}")] * len(found),
        "customdata": [float(f"{np.degrees(item.contact_angle):.6g}") for item in found],
        "hovertemplate": "%{theta:.4g}°: %{r:.4g} N, contact angle %{customdata:.4g}°",
        "marker": {"color": COLOURS[row % len(COLOURS)], "line": {"color": "#ffffff", "width": 0.5}},
    }


def _entries(curve: Curve, block: str) -> list[tuple[int, int]]:
    """Diagonal and coupling entries of a unit."""
    pairs = [(k, k) for k in diagonal(curve.stiffness)] + couplings(curve.stiffness, 1e-6)
    return [pair for pair in pairs if unit(*pair) == block]


def _title(block: str) -> str:
    return {"N/m": "forces by translations", "N/rad": "forces by rotations"}.get(block, "moments by rotations")


def _entry_line(curve: Curve, pair: tuple[int, int], n: int, yaxis: str) -> Trace:
    i, j = pair
    values: Real = np.array([K[i, j] if np.isnan(K).any() else shown(K)[i, j] for K in curve.stiffness])
    signs = set(_signs(values))
    size = np.where(np.abs(values) > 0.0, np.abs(values), np.nan)
    minus = " (−)" if signs == {-1.0} else (" (±)" if len(signs) > 1 else "")
    dash = "solid" if i == j else DASHES[1 + n % (len(DASHES) - 1)]
    if dash == "solid" and i != j:
        dash = "dashdot"
    colour = COLOURS[i if i == j else (5 + n) % len(COLOURS)]  # every entry of the diagonal has its own
    return line(curve.values, size, f"K {entry(i, j)}{minus}", colour, dash, yaxis=yaxis)


def _signs(values: Real) -> Iterator[float]:
    return (float(np.sign(value)) for value in values if np.isfinite(value) and value != 0.0)
