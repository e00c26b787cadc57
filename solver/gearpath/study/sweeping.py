"""The frequency sweep of a model: bands in the terminal, all lines in a file, a check against the reference."""

from __future__ import annotations

import io
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from rich.markup import escape
from rich.table import Table
from scipy.sparse import issparse

from .. import api, console
from ..components import Measured
from ..errors import InputError
from ..files import write_text
from ..fmu.checks import Check
from ..modelfile import Model
from ..network.assemble import assemble
from ..network.foreign import described
from ..network.modal import ModalNetwork
from ..network.power import power_flow, ratio
from ..network.reference import reference_solution
from ..network.response import frequency_response
from ..network.synthesis import Synthesis
from ..network.time_twin import time_twin
from ..numerics.arrays import Real

BANDS = (0.0, 1000.0, 2000.0, 3000.0, 5000.0, np.inf)  # Hz; the lower edge belongs to the band
_CHECKED_LINES, _REDUCED_LINES = 40, 8  # the latter cost a large sparse solution each
_GIVEN_OFF = 1e-3  # of the input power: less does not count
_REDUCED = 1e4  # reduced plates and frames are exact to 1e-5 or so up to the last frequency, not to rounding


def run(model: Model, output: Path | None, check: bool, json: bool) -> bool:
    """Sweep the model, print or write the result; whether the check (if wanted) passed."""
    if output is not None and output.suffix != ".csv":
        raise InputError(f"{output}: is not a .csv file; name it so, or use --json for other formats")
    with console.notes(console.err):
        with console.progress("power flow", model.frequency.points, quiet=json) as bar:
            flow = api.power_flow(model, progress=bar.advance)
        checks = reference_checks(model, quiet=json) if check else []
    if output is not None:
        write_text(output, csv_text(flow))
    if json:
        console.print_json(as_dict(flow, checks))
    else:
        _print(flow, checks)
        for name, words in described(model.system).items():
            console.out.print(escape(f"{name}: {words}"), highlight=False)
        for text in _active(model, flow):
            console.out.print(f"note: {escape(text)}")
        if output is not None:
            console.out.print(f"wrote {escape(str(output))}")
    return all(item.passed for item in checks)


def _active(model: Model, flow: xr.Dataset) -> list[str]:
    """Measured components that give off power: their data are not passive, by noise, signs or order of channels."""
    found = []
    for name, item in model.system.components.items():
        if isinstance(item, Measured):
            own = flow.dissipated_power.sel(element=name).values
            part = float(np.mean(own < -_GIVEN_OFF * abs(flow.input_power.values)))
            if part:
                found.append(
                    f"{name} gives off power on {100.0 * part:.2g} % of the lines, as nothing passive does: noise or "
                    "mistakes of its data; power ratios there are not to be trusted"
                )
    return found


def reference_checks(model: Model, quiet: bool = False) -> list[Check]:
    """Synthesis against the unsynthesised solution, power balance and passivity, and the time twin.

    Without the time twin of measured components: their fit is another machine, which `validate` holds its FMU against.
    """
    f = model.frequencies()
    network = assemble(model.system)
    modal = network.modal()
    reduced = any(issparse(structure.mass) for structure in network.structures.values())
    tolerance = _REDUCED if reduced else 1.0
    omega = 2 * np.pi * f[:: max(len(f) // (_REDUCED_LINES if reduced else _CHECKED_LINES), 1)]
    load = next(item for item in modal.loads if item.name == modal.excitation)
    solved = Synthesis(modal, [load]).solve(omega)
    with console.progress("reference solution", 1.0, quiet=quiet):
        reference = reference_solution(network, omega)
        lines = 2 * np.pi * np.linspace(f[0], f[-1], 40 if reduced else 400)
        twins = [] if modal.measured else _twin_checks(modal, lines)
    flow, every = power_flow(modal, omega), power_flow(modal, 2 * np.pi * f)
    balance = abs(every.dissipated_power.sum(axis=0) - every.input_power) / abs(every.input_power)
    gross = abs(every.path_power).sum(axis=0)
    returned = ratio(-every.transmitted_power, gross)
    forces = _force_deviation(modal, solved.force[: len(reference.force), 0], reference.force)
    alpha = ratio(abs(flow.share() - reference.alpha), abs(reference.alpha))
    on = f"on {len(omega)} lines" + (", plates and frames reduced" if reduced else "")
    return [
        Check("interface forces against the unsynthesised solution", forces, 1e-9 * tolerance, on),
        Check("alpha against the unsynthesised solution", float(alpha.max()), 1e-8 * tolerance, on),
        Check("input power against the sum of dissipated powers", float(balance.max()), 1e-8, "on all lines"),
        Check("net power returned to the source", float(np.max(returned)), 1e-10, "part of what flows; negative: none"),
        Check("alpha above 1", float(every.share().max() - 1.0), 1e-10, "negative: below 1 on all lines"),
        *twins,
    ]


def _twin_checks(network: ModalNetwork, omega: Real) -> list[Check]:
    """Time twin against frequency twin, all outputs and inputs; and its stability."""
    twin = time_twin(network)
    identity = np.eye(len(twin.A))
    time = np.array([twin.C @ np.linalg.solve(1j * w * identity - twin.A, twin.B) + twin.D for w in omega])
    frequency = frequency_response(network.viscous(), omega, twin.outputs, twin.loads)
    largest = abs(frequency).max(axis=0)
    deviation = abs(time - frequency)
    # what nearly vanishes by symmetry is judged by 1e-7 of the output's largest value: below, it is rounding
    near = np.max(deviation / np.maximum(abs(frequency), 1e-7 * np.where(largest > 0, largest, 1.0)))
    poles, lines = np.linalg.eigvals(twin.A), f"{len(omega)} lines, all outputs"
    return [
        Check(
            "time twin against frequency twin, of the largest",
            float(np.max(ratio(deviation.max(axis=0), largest))),
            1e-8,
            lines,
        ),
        Check("time twin against frequency twin, pointwise above 1e-7 of the largest", float(near), 1e-6, lines),
        Check("growth rate of the least stable mode", float(poles.real.max()), 1e-6 * float(abs(poles).max()), "1/s"),
    ]


def _force_deviation(network: Any, found: Any, expected: Any) -> float:
    rotation = np.array([dof[0] == "r" for joint in network.joints for dof in joint.dofs])
    worst = 0.0
    for rows in (rotation, ~rotation):
        if rows.any():
            size = abs(expected[rows]).max(axis=0)
            worst = max(worst, float(np.max(abs(found - expected)[rows].max(axis=0) / size)))
    return worst


def band_means(values: Real, f: Real) -> list[tuple[str, float]]:
    """Mean over the lines of each band that holds lines."""
    means = []
    for low, high in pairwise(BANDS):
        if low > 0.0 and low == f[-1]:
            break  # the last line belongs to the band below it
        inside = (f >= low) & ((f < high) | ((f == high) & (high in (5000.0, f[-1]))))
        if high == np.inf:
            inside &= f > 5000.0
        if inside.any():
            top = f"{high / 1e3:g}" if np.isfinite(high) else "..."
            means.append((f"{low / 1e3:g}-{top} kHz", float(np.mean(values[inside]))))
    return means


def csv_text(flow: xr.Dataset) -> str:
    """All lines of a sweep as a table, one column a quantity, complex ones as _re and _im."""
    columns: dict[str, Real] = {"frequency_Hz": flow.frequency.values}
    for name in ("input_power", "transmitted_power", "alpha", "alpha_force", "alpha_moment"):
        columns[name + ("_W" if name.endswith("power") else "")] = flow[name].values
    for element in flow.element.values:
        columns[f"dissipated_power.{element}_W"] = flow.dissipated_power.sel(element=element).values
    for path in flow.path.values:
        columns[f"path_alpha.{path}"] = flow.path_alpha.sel(path=path).values
        for name in ("force", "velocity_source", "velocity_receiver"):
            values = flow[name].sel(path=path).values
            columns[f"{name}.{path}_re"], columns[f"{name}.{path}_im"] = values.real, values.imag
    text = io.StringIO()
    np.savetxt(text, np.column_stack(list(columns.values())), "%.17g", ",", header=",".join(columns), comments="")
    return text.getvalue()


def as_dict(flow: xr.Dataset, checks: list[Check]) -> dict[str, Any]:
    """A sweep for machines: arrays over frequency, by path and by element."""
    data: dict[str, Any] = {"model": flow.attrs["model"], "excitation": flow.attrs["excitation"]}
    data["frequency"] = flow.frequency.values
    for name in ("input_power", "transmitted_power", "alpha", "alpha_force", "alpha_moment"):
        data[name] = flow[name].values
    data["path_alpha"] = {p: flow.path_alpha.sel(path=p).values for p in flow.path.values}
    data["dissipated_power"] = {e: flow.dissipated_power.sel(element=e).values for e in flow.element.values}
    if checks:
        data["checks"] = [{"name": c.name, "figure": c.figure, "limit": c.limit, "passed": c.passed} for c in checks]
    return data


def _print(flow: xr.Dataset, checks: list[Check]) -> None:
    f = flow.frequency.values
    table = Table(title="Power ratio, band means", title_justify="left", show_edge=False)
    table.add_column("path")
    rows = {
        "alpha (all)": flow.alpha.values,
        "force paths": flow.alpha_force.values,
        "moment paths": flow.alpha_moment.values,
    }
    rows |= {str(path): flow.path_alpha.sel(path=path).values for path in flow.path.values}
    for name, _ in band_means(f, f):
        table.add_column(name, justify="right")
    for name, values in rows.items():
        table.add_row(name, *(f"{mean:.4g}" for _, mean in band_means(values, f)))
    console.out.print(table if flow.path.size else "no joint is a power flow path, so that there is no power ratio")
    for check in checks:
        verdict = "[green]passed[/]" if check.passed else "[red]FAILED[/]"
        console.out.print(f"{verdict} {escape(check.name)}: {check.figure:.2g} (limit {check.limit:.2g})")
