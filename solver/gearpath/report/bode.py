"""Bode plots: the steady state of the simulated FMUs as markers over the solver's line."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Any

import numpy as np

from ..fmu.checks import Comparison, ValidationReport
from ..network.modal import ModalNetwork
from ..numerics.arrays import Complex, Real
from .layout import COLOURS, INK, SYMBOLS, Figure, Trace, axis, line, page, rounded
from .transfers import Transfers
from .wording import number, plural, spaced


def fmu_label(report: ValidationReport) -> str:
    """File name and kind of an FMU, as a label in a figure."""
    return escape(f"{report.fmu.name} ({report.kind})", quote=False)  # plotly reads simple HTML in its labels


def bode_figures(validations: Sequence[ValidationReport], network: ModalNetwork) -> list[Figure]:
    """One figure for each compared transfer, all FMUs in it; the solver's curve between the points from the network."""
    every = [(fmu_label(report), item) for report in validations for item in report.comparisons if len(item.frequency)]
    transfers = Transfers(network, [item for _, item in every])
    curves: dict[tuple[str, str, str | None], list[tuple[str, Comparison]]] = {}
    for label, item in every:
        curves.setdefault((item.name, item.unit, transfers.load(item)), []).append((label, item))
    return [_bode(k, *key, found, transfers) for k, (key, found) in enumerate(curves.items())]


def deviation(item: Comparison) -> float:
    """Largest distance of the simulated points from the solver, relative to the solver's largest value there."""
    at = solver_at(item)
    scale = abs(at).max() if len(at) else 0.0
    return float(abs(item.simulated - at).max() / scale) if scale else float("nan")


def solver_at(item: Comparison) -> Complex:
    """The solver's transfer at the simulated frequencies, interpolated between its lines where they differ."""
    if not len(item.solver_frequency):
        return np.full(len(item.frequency), np.nan, complex)
    real, imaginary = (
        np.interp(item.frequency, item.solver_frequency, part) for part in (item.solver.real, item.solver.imag)
    )
    return np.asarray(real + 1j * imaginary)


def _bode(
    k: int, name: str, unit: str, load: str | None, found: list[tuple[str, Comparison]], transfers: Transfers
) -> Figure:
    first = found[0][1]
    f, solver = first.solver_frequency, first.solver
    if load is not None:
        f, solver = transfers.frequency, transfers.curve(name, load)
    data = [line(f, _decibels(solver), "solver", INK, width=1.6, legendgroup="solver")]
    x, y = _broken(f, np.degrees(np.angle(solver)))
    data.append(line(x, y, "solver", INK, width=1.6, yaxis="y2", showlegend=False, legendgroup="solver"))
    for i, (label, item) in enumerate(found):
        data += _points(item, label, COLOURS[i % len(COLOURS)], SYMBOLS[i % len(SYMBOLS)])
    every = np.concatenate([f, *(item.frequency for _, item in found)])
    span = [float(np.log10(every.min() / 1.1)), float(np.log10(every.max() * 1.1))]
    layout = page(
        460,
        xaxis=axis("frequency, Hz", type="log", range=span, anchor="y2", **_ticks(*span)),
        yaxis=axis(f"|H|, dB re 1 {spaced(unit)}", domain=[0.4, 1.0]),
        yaxis2=axis("phase, °", domain=[0.0, 0.33], range=[-200, 200], tickvals=[-180, -90, 0, 90, 180]),
    )
    worst = max(deviation(item) for _, item in found)
    caption = (
        f"{name} per {f'unit of {load}' if load else 'unit of the input'}. Line: solver (mobility synthesis), "
        f"{'on a fine grid' if load else 'straight between its points'}; markers: steady state of the simulated FMU. "
        f"Largest deviation of a marker, relative to the largest value of the solver there: {number(worst, 2)}. "
        "It includes the images of the sampled input, which the validation accounts for."
    )
    words = f"Bode plot of {name}: {plural(len(found), 'simulated FMU')} over the solver's curve."
    return Figure(f"bode-{k}", caption, words, data, layout, heading=name)


def _ticks(low: float, high: float) -> dict[str, Any]:
    """Ticks of a logarithmic axis from 10^low to 10^high: 1, 2, 5, 10 ... over a few decades, else the decades."""
    steps = (1, 2, 5) if high - low < 3.2 else (1,)
    values = [step * 10.0**k for k in range(int(np.floor(low)), int(np.ceil(high)) + 1) for step in steps]
    shown = [value for value in values if low <= np.log10(value) <= high]
    return {"tickvals": shown, "ticktext": [f"{value:g}" for value in shown]} if len(shown) > 1 else {}


def _points(item: Comparison, label: str, colour: str, symbol: str) -> list[Trace]:
    """Magnitude and phase of the simulated points; phases on the branch next to the solver's."""
    at = solver_at(item)
    near = np.degrees(np.angle(at))
    phase = near + np.degrees(np.angle(item.simulated * np.conj(at)))
    style: dict[str, Any] = {
        "type": "scatter",
        "mode": "markers",
        "name": label,
        "x": rounded(item.frequency, 9),
        "legendgroup": label,
        "marker": {"color": colour, "symbol": symbol, "size": 9, "line": {"width": 1.8, "color": colour}},
    }
    return [
        {**style, "y": rounded(_decibels(item.simulated))},
        {**style, "y": rounded(phase), "yaxis": "y2", "showlegend": False},
    ]


def _decibels(values: Complex) -> Real:
    """20 lg |H|; a gap for zero."""
    size = abs(values)
    return np.asarray(20.0 * np.log10(np.where(size > 0.0, size, np.nan)))


def _broken(f: Real, phase: Real) -> tuple[Real, Real]:
    """A wrapped phase with a gap in every jump from one branch to the other."""
    jumps = np.flatnonzero(abs(np.diff(phase)) > 180.0) + 1
    return np.insert(f, jumps, f[jumps]), np.insert(phase, jumps, np.nan)
