"""The figures of the power balance: what enters, what is dissipated, and where."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..numerics.arrays import Real
from .layout import COLOURS, INK, Figure, Trace, axis, frequency_axis, line, page, panel_title
from .results import Results
from .wording import listed, number


def balance_figure(results: Results) -> Figure:
    """Input, dissipated and transmitted power, and the relative residual of the balance."""
    f = results.frequency
    top, bottom = [0.42, 1.0], [0.0, 0.3]
    dissipated = results.dissipated_power.sum(axis=0)
    data = [
        line(f, _positive(results.input_power), "input power", COLOURS[0], width=3.2),
        line(f, _positive(dissipated), "sum of dissipated powers", INK, "dash", width=1.6),
        line(f, _positive(results.path_power.sum(axis=0)), "through the bearings", COLOURS[1], "longdashdot"),
        line(f, _positive(results.residual), "relative residual", COLOURS[3], yaxis="y2", width=1.2),
    ]
    power: dict[str, Any] = {"type": "log", "exponentformat": "power", "showexponent": "all", "dtick": 1}
    span = _decades(results.input_power, dissipated)
    layout = page(
        520,
        annotations=[panel_title("residual, |input − dissipated| / input", bottom)],
        xaxis=frequency_axis(f, anchor="y2"),
        yaxis=axis("power, W", domain=top, **{**power, "dtick": max(1, round(span / 6))}),
        yaxis2=axis("residual, 1", domain=bottom, **power),
    )
    largest = results.residual.max()
    caption = (
        "Time-averaged power that the excitation puts in, and the sum of what all components and joints dissipate, "
        f"computed independently of each other. Largest relative residual: {number(largest, 2)}."
    )
    words = f"Input and dissipated power coincide; the relative residual stays below {number(largest, 2)}."
    return Figure("balance", caption, words, data, layout)


def shares_figure(results: Results) -> Figure:
    """Dissipated power by element as stacked shares; joints of one kind in shades of one colour."""
    whole = results.dissipated_power.sum(axis=0)
    kinds = {joint.name: joint.kind for joint in results.network.joints}
    groups = list(dict.fromkeys(kinds.get(name, name) for name in results.elements))
    data: list[Trace] = []
    count: dict[str, int] = {}
    for name, lost in zip(results.elements, results.dissipated_power):
        if not lost.any():
            continue
        group = kinds.get(name, name)
        count[group] = count.get(group, -1) + 1
        colour = _shade(COLOURS[groups.index(group) % len(COLOURS)], count[group])
        part = np.divide(100.0 * lost, whole, out=np.zeros_like(lost), where=whole != 0.0)
        trace = line(results.frequency, part, name, "#ffffff", width=0.6)
        data.append({**trace, "stackgroup": "all", "fillcolor": colour, "hovertemplate": "%{y:.3g} %"})
    layout = page(
        430,
        xaxis=frequency_axis(results.frequency),
        yaxis=axis("share of the dissipated power, %", range=[0, 100]),
    )
    caption = "Where the input power ends: share of every component and joint in the dissipated power, stacked."
    words = f"Stacked shares of {listed([str(trace['name']) for trace in data] or ['no element'])}, in percent."
    return Figure("shares", caption, words, data, layout)


def _positive(values: Real) -> Real:
    """For a logarithmic axis: a gap where there is nothing to draw."""
    return np.where(values > 0.0, values, np.nan)


def _decades(*powers: Real) -> float:
    values = np.concatenate([power[power > 0.0] for power in powers])
    return float(np.log10(values.max() / values.min())) if len(values) else 1.0


def _shade(colour: str, k: int) -> str:
    """The k-th tint of a colour."""
    keep = (1.0, 0.75, 0.55, 0.4)[k % 4]
    channels = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
    return "#" + "".join(f"{round(255 - keep * (255 - channel)):02x}" for channel in channels)
