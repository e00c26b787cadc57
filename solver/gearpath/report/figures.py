"""The figures of the power flow: ratio and its parts, every path, ranking of the bearings, power balance."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..numerics.arrays import Real
from .layout import (
    COLOURS,
    DASHES,
    INK,
    LEGEND,
    RETURNED,
    SHAPES,
    Figure,
    Trace,
    axis,
    frequency_axis,
    line,
    page,
    panel_title,
    signed,
    stacked,
    suffix,
)
from .ranking import bands, receiver_names, share, total
from .results import Results
from .wording import decibel, level, listed, number, percent

_PATTERN = {"fillmode": "overlay", "fgcolor": "#ffffff", "fgopacity": 0.8, "solidity": 0.22, "size": 7}
PANEL, GAP = 250, 42  # px, height of one panel and what of it lies between two


def ratio_figure(results: Results) -> Figure:
    """alpha and its force and moment parts, with the natural frequencies as ticks."""
    f = results.frequency
    data = [
        *signed(f, results.alpha, "all paths, α", INK, width=2.4),
        *signed(f, results.alpha_force, "force paths", COLOURS[0], "longdash"),
        *signed(f, results.alpha_moment, "moment paths", COLOURS[1]),
    ]
    if len(results.natural_in_band):
        data.append(_ticks(results))
    layout = page(
        470,
        xaxis=frequency_axis(f),
        yaxis=axis("power ratio 10 lg |P/P<sub>in</sub>|, dB"),
        yaxis2={"overlaying": "y", "range": [0, 1], "visible": False, "fixedrange": True},
    )
    return Figure("ratio", _ratio_caption(results), _ratio_words(results), data, layout)


def path_figure(results: Results) -> Figure:
    """The power ratio of every path: one panel a degree of freedom, one colour a bearing."""
    dofs = list(dict.fromkeys(path.rsplit(".", 1)[1] for path in results.paths))
    domains = stacked(len(dofs), gap=GAP / (PANEL * len(dofs)))
    data: list[Trace] = []
    layout = page(PANEL * len(dofs) + 90, annotations=[])
    layout["legend"] = {**LEGEND, "y": 1.0 + 24.0 / (PANEL * len(dofs))}  # above the heading of the first panel
    for k, (dof, domain) in enumerate(zip(dofs, domains)):
        layout[f"yaxis{suffix(k)}"] = axis("10 lg |P/P<sub>in</sub>|, dB", domain=domain)
        kind = "moment" if dof.startswith("r") else "force"
        layout["annotations"].append(panel_title(f"{dof} ({kind} paths)", domain))
        for b, bearing in enumerate(results.bearings):
            if f"{bearing}.{dof}" in results.paths:
                ratio = results.path_alpha[results.paths.index(f"{bearing}.{dof}")]
                style = COLOURS[b % len(COLOURS)], DASHES[b % len(DASHES)]
                data += signed(results.frequency, ratio, bearing, *style, yaxis=f"y{suffix(k)}", legendgroup=bearing)
    layout["xaxis"] = frequency_axis(results.frequency, anchor=f"y{suffix(len(dofs) - 1)}")
    layout["hovermode"] = "closest"
    _one_entry_each(data, results.bearings)
    caption = (
        "Power through every bearing degree of freedom relative to the input power. Dotted: the path carries power "
        "back into the source. Single paths may exceed 0 dB where others return power; only the net ratio is bounded."
    )
    words = f"Power ratio over frequency of {len(results.paths)} paths, one panel for each of {listed(dofs)}."
    return Figure("paths", caption, words, data, layout)


def ranking_figure(results: Results) -> Figure:
    """Share of every bearing in the power that enters the receivers, by band."""
    found = bands(results.frequency)
    receivers = receiver_names(results)
    data: list[Trace] = []
    for b, bearing in enumerate(results.bearings):
        shares = [100.0 * share(results, band, bearing, results.of_bearing(bearing)).share for band in found]
        data.append(
            {
                "type": "bar",
                "name": bearing,
                "x": [band.label for band in found],
                "y": [None if np.isnan(value) else float(f"{value:.6g}") for value in shares],
                "hovertemplate": "%{y:.1f} %",
                "marker": {
                    "color": COLOURS[b % len(COLOURS)],
                    "pattern": {**_PATTERN, "shape": SHAPES[b % len(SHAPES)]},
                },
            }
        )
    layout = page(
        330,
        barmode="group",
        bargap=0.25,
        xaxis=axis("band", type="category", showgrid=False),
        yaxis=axis("share of the entering power, %", zeroline=True, zerolinecolor=INK),
    )
    caption = (
        "Net power through every bearing, summed over the lines of each band, relative to the power that enters "
        f"{receivers} in that band: the bars above zero add up to 100 %; a bar below zero is the part of it that the "
        "bearing returns to the source."
    )
    words = f"Bars: shares of {listed(list(results.bearings))} in {len(found)} bands; the table below has the numbers."
    return Figure("ranking", caption, words, data, layout)


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


def _ticks(results: Results) -> Trace:
    f = results.natural_in_band
    return {
        **line(f, np.full(len(f), 0.025), "natural frequencies", INK),
        "mode": "markers",
        "yaxis": "y2",
        "marker": {"symbol": "line-ns-open", "size": 11, "color": INK, "line": {"width": 1.4}},
        "hovertemplate": "natural frequency",
    }


def _ratio_caption(results: Results) -> str:
    text = (
        "Power through all bearings relative to the input power (Eq. 5a), and its force and moment parts, which add "
        "up to it with their signs. Dotted parts are negative: there the paths carry power back into the source. "
        "Ticks: undamped natural frequencies of the assembly."
    )
    for name, part in ("force", results.alpha_force), ("moment", results.alpha_moment):
        if not part.any():
            text += f" The {name} paths carry no power (nothing above rounding)."
    return text


def _ratio_words(results: Results) -> str:
    peak = int(np.argmax(results.alpha))
    whole = [
        f"{band.label} {decibel(level(total(results, band).ratio))}"
        for band in bands(results.frequency)
        if results.paths and total(results, band).ratio > 0.0
    ]
    return (
        f"Power ratio over frequency; largest {percent(results.alpha[peak])} at "
        f"{number(results.frequency[peak], 4)} Hz." + (f" Ratio of band powers: {listed(whole)}." if whole else "")
    )


def _one_entry_each(data: list[Trace], names: Sequence[str]) -> None:
    """One legend entry for a name that stands in several panels, and one for all dotted lines."""
    seen = set()
    for trace in data:
        name = trace["legendgroup"]
        trace["showlegend"] = name not in seen and trace["mode"] == "lines" and trace["line"]["dash"] != RETURNED
        seen |= {name} if trace["showlegend"] else set()
    for trace in data:  # a bearing that only returns power
        if trace["legendgroup"] in set(names) - seen:
            trace["showlegend"] = True
            seen.add(trace["legendgroup"])
    if any(trace["line"]["dash"] == RETURNED for trace in data):
        data.append(line([np.nan], [np.nan], "returned to the source", INK, RETURNED))


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
