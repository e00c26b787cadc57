"""The paper's kind of figure: levels of power ratios over frequency, one panel a part, original against changed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ...numerics.arrays import Real
from ...report.layout import (
    COLOURS,
    INK,
    LEGEND,
    Figure,
    Trace,
    axis,
    frequency_axis,
    line,
    page,
    panel_title,
    stacked,
    suffix,
)
from ...report.wording import percent
from .claims import number_of
from .effect import PARTS, Effect, Part, Ratios

STYLES = ((INK, "solid", 2.0), (COLOURS[1], "dash", 1.7), (COLOURS[0], "longdashdot", 1.7), (COLOURS[2], "dot", 1.9))
PANEL, GAP = 290, 44  # px, height of a panel and what of it lies between two
_TITLES = {"alpha": "all paths, α", "force": "(a) force paths", "moment": "(b) moment paths"}
_DEEPEST = 90.0  # dB below the largest level of a panel; deeper lines at the lowest frequencies are cut off


def ratio_figure(
    key: str, curves: Mapping[str, Ratios], parts: Sequence[Part], caption: str, heading: str = ""
) -> Figure:
    """Levels 10 lg |ratio| of every machine, the original first; a part without power is left out and named."""
    panels = {
        _TITLES[part]: {name: level for name, curve in curves.items() if np.isfinite(level := curve.level(part)).any()}
        for part in parts
    }
    for part in parts:
        absent = [name for name in curves if name not in panels[_TITLES[part]]]
        if absent:
            caption += f" In {_TITLES[part]} no power flows, and there is no curve, for: {', '.join(absent)}."
    caption += _returned(curves, parts)
    f = next(iter(curves.values())).frequency
    quantities = ["power ratio 10 lg |P/P<sub>in</sub>|, dB"] * len(panels)
    return panel_figure(key, f, panels, list(curves), quantities, caption, heading)


def panel_figure(
    key: str,
    f: Real,
    panels: Mapping[str, Mapping[str, Real]],
    names: Sequence[str],
    quantities: Sequence[str],
    caption: str,
    heading: str = "",
) -> Figure:
    """Curves over frequency in panels, the first on top; every name keeps its colour and dash in all of them."""
    domains = stacked(len(panels), gap=GAP / (PANEL * len(panels)))
    data: list[Trace] = []
    layout = page(PANEL * len(panels) + 90, annotations=[])
    layout["legend"] = {**LEGEND, "y": 1.0 + 24.0 / (PANEL * len(panels))}
    named: set[str] = set()
    for k, ((title, curves), domain) in enumerate(zip(panels.items(), domains)):
        layout[f"yaxis{suffix(k)}"] = axis(quantities[k], domain=domain, **_range(curves))
        if len(panels) > 1:
            layout["annotations"].append(panel_title(title, domain))
        for name, values in curves.items():
            colour, dash, width = STYLES[names.index(name) % len(STYLES)]
            show = name not in named
            data.append(
                line(
                    f, values, name, colour, dash, width=width, yaxis=f"y{suffix(k)}", legendgroup=name, showlegend=show
                )
            )
            named.add(name)
    layout["xaxis"] = frequency_axis(f, anchor=f"y{suffix(len(panels) - 1)}")
    layout["hovermode"] = "x unified" if len(panels) == 1 else "closest"
    return Figure(key, caption, f"Over frequency, {len(panels)} panels: {', '.join(names)}.", data, layout, heading)


def _range(curves: Mapping[str, Real]) -> dict[str, list[float]]:
    finite = np.concatenate([values[np.isfinite(values)] for values in curves.values()] or [np.zeros(0)])
    if not finite.size or finite.max() - finite.min() < _DEEPEST:
        return {}
    top = float(finite.max())
    return {"range": [round(top - _DEEPEST, 1), round(top + 4.0, 1)]}


def _returned(curves: Mapping[str, Ratios], parts: Sequence[Part]) -> str:
    """Where power goes back into the source; the figure shows magnitudes."""
    told = []
    for part in parts:
        shares = {name: float(np.mean(curve.ratio(part) < 0.0)) for name, curve in curves.items()}
        back = [f"{name} {percent(share)}" for name, share in shares.items() if share > 0.0]
        if back:
            told.append(f" The {part} paths return power to the source on part of the lines: {', '.join(back)}.")
    if told:
        told.append(" Magnitudes are drawn; a dip is where the direction changes.")
    return "".join(told)


def changes_seen(effects: Sequence[Effect], parts: Sequence[Part] = PARTS) -> str:
    """What a figure shows, in numbers: the median change of each part by each change."""
    short = {"alpha": "α", "force": "force paths", "moment": "moment paths"}
    told = []
    for effect in effects:
        medians = [
            f"{short[part]} {number_of(effect.median(part))} dB" for part in parts if np.isfinite(effect.median(part))
        ]
        if medians:
            told.append(f"{effect.name}: {', '.join(medians)}")
    return f"Median change |D| over all lines: {'; '.join(told)}."
