"""Figures as plain plotly.js data: palette, axes, signed levels. Nothing here needs plotly itself."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..numerics.arrays import Real

Trace = dict[str, Any]
INK, GRID = "#1f2933", "#e3e7eb"
# Okabe and Ito's palette, safe for the common kinds of colour blindness, darkest first; each with a dash of its own.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#a3527e", "#8a6a00", "#3f97c9", "#555555", "#7b3294")
DASHES = ("solid", "dash", "longdashdot", "longdash", "dashdot", "solid", "dash", "longdash")
SYMBOLS = ("circle-open", "x-thin-open", "square-open", "diamond-open", "triangle-up-open", "cross-thin-open")
SHAPES = ("", "/", ".", "x", "\\", "-", "+", "|")
LEGEND = {"orientation": "h", "x": 0, "xanchor": "left", "yanchor": "bottom", "traceorder": "normal", "itemwidth": 42}
RETURNED = "dot"  # the dash of power that flows back into the source


@dataclass(frozen=True)
class Figure:
    """A plot with what a reader needs beside it: `described` says in words what the picture shows."""

    key: str
    caption: str
    described: str
    data: list[Trace] = field(default_factory=list)
    layout: dict[str, Any] = field(default_factory=dict)
    heading: str = ""  # above the plot, where several figures share a section

    @property
    def height(self) -> int:
        """Pixels."""
        return int(self.layout["height"])


def rounded(values: Iterable[float] | Real, digits: int = 6) -> list[float | None]:
    """Values to so many significant digits; None (a gap) for what is not finite."""
    return [float(f"{v:.{digits}g}") if np.isfinite(v) else None for v in np.asarray(values, float)]


def line(
    x: Iterable[float] | Real, y: Iterable[float] | Real, name: str, colour: str, dash: str = "solid", **more: Any
) -> Trace:
    """A line without markers; x to nine digits, y to six."""
    style = {"color": colour, "dash": dash, "width": more.pop("width", 1.8)}
    return {
        "type": "scatter",
        "mode": "lines",
        "name": name,
        "x": rounded(x, 9),
        "y": rounded(y),
        "line": style,
        "connectgaps": False,
        **more,
    }


def signed(f: Real, ratio: Real, name: str, colour: str, dash: str = "solid", **more: Any) -> list[Trace]:
    """10 lg |ratio| as a line where the power flows into the receiver and a dotted one where it returns.

    No trace for a part that is zero everywhere; a single line between gaps becomes a dot, so that nothing is lost.
    """
    with np.errstate(divide="ignore"):
        level = 10.0 * np.log10(abs(ratio))
    traces = []
    for mask, label, style in (ratio > 0.0, name, dash), (ratio < 0.0, f"{name} (returned)", RETURNED):
        if not mask.any():
            continue
        shown = np.where(mask, level, np.nan)
        entry = {"legendgroup": label, **more}
        traces.append(line(f, shown, label, colour, style, **entry))
        alone = mask & ~np.append(False, mask[:-1]) & ~np.append(mask[1:], False)
        if alone.any():
            dots = line(f[alone], shown[alone], label, colour, **{**entry, "showlegend": False})
            traces.append({**dots, "mode": "markers", "marker": {"color": colour, "size": 4}})
    return traces


def axis(title: str, **more: Any) -> dict[str, Any]:
    """An axis with its title, unit included."""
    return {
        "title": {"text": title, "standoff": 8},
        "automargin": True,
        "gridcolor": GRID,
        "linecolor": INK,
        "linewidth": 1,
        "showline": True,
        "ticks": "outside",
        "tickcolor": INK,
        "tickfont": {"size": 11},
        "ticklen": 4,
        "zeroline": False,
        **more,
    }


def frequency_axis(f: Real, **more: Any) -> dict[str, Any]:
    """Frequency from the first line to the last, linear."""
    return axis("frequency, Hz", range=[0.0 if f.min() < 0.1 * f.max() else float(f.min()), float(f.max())], **more)


def stacked(rows: int, gap: float = 0.09) -> list[list[float]]:
    """Vertical domains of so many panels, the first on top."""
    height = (1.0 - gap * (rows - 1)) / rows
    return [
        [max(0.0, round((rows - 1 - k) * (height + gap), 4)), round((rows - 1 - k) * (height + gap) + height, 4)]
        for k in range(rows)
    ]


def suffix(k: int) -> str:
    """plotly's number of the k-th axis, from zero: "", "2", "3"."""
    return "" if k == 0 else str(k + 1)


def panel_title(text: str, domain: list[float]) -> dict[str, Any]:
    """A heading at the upper left of a panel."""
    return {
        "text": f"<b>{text}</b>",
        "xref": "paper",
        "yref": "paper",
        "x": 0.0,
        "y": domain[1],
        "xanchor": "left",
        "yanchor": "bottom",
        "showarrow": False,
        "font": {"size": 12},
    }


def page(height: int, **more: Any) -> dict[str, Any]:
    """The layout common to all figures."""
    return {
        "height": height,
        "autosize": True,
        "font": {"family": "system-ui, 'Segoe UI', 'Helvetica Neue', Arial, sans-serif", "size": 12, "color": INK},
        "paper_bgcolor": "#ffffff",
        "plot_bgcolor": "#ffffff",
        "margin": {"l": 56, "r": 26, "t": 20, "b": 44},
        "modebar": {"orientation": "v", "bgcolor": "rgba(255,255,255,0.7)", "color": "#9aa5b1", "activecolor": INK},
        "legend": {**LEGEND, "y": 1.02},
        "hovermode": "x unified",
        "hoverlabel": {"namelength": -1},
        **more,
    }
