"""The figures of the power flow: ratio and its parts, every path, ranking of the bearings."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

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
