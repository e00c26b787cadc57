"""Fig. 6: the experimental set-up, its input mobility and the paths of its upper joint."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ... import api
from ...fmu.checks import Check
from ...modelfile import Model
from ...network.assemble import assemble
from ...network.reference import reference_solution
from ...numerics.arrays import Real
from ...report.layout import Figure
from ...report.table import Table, table
from ...report.wording import number, percent
from .claims import Claim, Item
from .drawing import panel_figure
from .machine import shipped
from .record import Study

DIRECTIONS = {"ux": "in-plane, x", "uy": "in-plane, y", "uz": "out-of-plane, z"}
HIGH = 1000.0  # Hz, above which the moment path is said to dominate
MOST = 0.9  # part of the lines that counts as dominance
_CHECKED = np.array([61.0, 400.0, 1500.0])  # Hz


def study(model: Model | None = None) -> Study:
    """Input mobility, and force against moment path of the upper joint, for a force in each direction."""
    model = model or shipped("test_rig")
    f = model.frequencies()
    driven = {dof: model.replace({"excitation.dof": dof}) for dof in DIRECTIONS}
    flows = {dof: api.power_flow(changed, f) for dof, changed in driven.items()}
    mobility = {DIRECTIONS[dof]: _decibels(_input_mobility(changed, dof, f)) for dof, changed in driven.items()}
    shares = {dof: upper_joint(flow) for dof, flow in flows.items()}
    return Study(
        key="fig06",
        title="Fig. 6: the experimental set-up (Sec. 5)",
        done="Two plates, two shafts and bolted joints as short beams (Eq. 18 to 22); a force on the edge of the small "
        "plate in each direction. The paper gives no material, positions or joint size, so that its measured curve "
        "cannot be laid over this one.",
        figures=(_mobility_figure(f, mobility), *(_path_figure(f, dof, shares[dof]) for dof in ("ux", "uz"))),
        claims=(_dominance(f, shares),),
        tables=(_share_table(f, shares), _frequency_table(model)),
        own_checks=(_check(driven["uz"]), _balance(flows)),
    )


def upper_joint(flow: xr.Dataset) -> dict[str, Real]:
    """Power ratio of the force and the moment paths of the upper joint, (F,) each."""
    paths = [str(path) for path in flow.path.values if str(path).startswith("upper.")]
    chosen = {kind: [p for p in paths if p.rsplit(".", 1)[1][0] == letter] for kind, letter in _KINDS.items()}
    return {kind: np.asarray(flow.path_alpha.sel(path=names).sum("path").values) for kind, names in chosen.items()}


_KINDS = {"force path": "u", "moment path": "r"}


def _input_mobility(model: Model, dof: str, f: Real) -> Real:
    H = api.frequency_response(model, f, f"sensors.drive_{dof[1]}", "excitation.force")
    return np.asarray(abs(H.values[:, 0, 0]))


def _decibels(values: Real, factor: float = 20.0) -> Real:
    return np.asarray(factor * np.log10(abs(values)))


def _mobility_figure(f: Real, mobility: dict[str, Real]) -> Figure:
    level = {name: f"{number(float(values.mean()))} dB" for name, values in mobility.items()}
    caption = "Mean level: " + ", ".join(f"{name} {value}" for name, value in level.items()) + "."
    return panel_figure(
        "fig06a",
        f,
        {"input mobility": mobility},
        list(mobility),
        ["input mobility, dB re 1 m/(N s)"],
        caption,
        "(a) Input mobility",
    )


def _path_figure(f: Real, dof: str, share: dict[str, Real]) -> Figure:
    part = percent(moment_dominates(f, share))
    caption = f"Force {DIRECTIONS[dof]}. Above 1 kHz the moment path is the larger one on {part} of the lines."
    curves = {name: _decibels(values, 10.0) for name, values in share.items()}
    heading = f"(b) Upper joint, force {DIRECTIONS[dof]}"
    quantity = "power ratio 10 lg |P/P<sub>in</sub>|, dB"
    return panel_figure(f"fig06b-{dof}", f, {"upper joint": curves}, list(curves), [quantity], caption, heading)


def moment_dominates(f: Real, share: dict[str, Real]) -> float:
    """Part of the lines above 1 kHz on which more goes through the moment path."""
    high = f > HIGH
    return float(np.mean(abs(share["moment path"][high]) > abs(share["force path"][high])))


def _dominance(f: Real, shares: dict[str, dict[str, Real]]) -> Claim:
    found = {DIRECTIONS[dof]: moment_dominates(f, share) for dof, share in shares.items()}
    return Claim(
        "The moment path dominates, especially at higher frequencies.",
        f"part of the lines above 1 kHz on which the moment path is the larger one, at least {percent(MOST)}",
        tuple(Item(where, (100.0 * part,), part >= MOST) for where, part in found.items()),
        unit="%",
    )


def _share_table(f: Real, shares: dict[str, dict[str, Real]]) -> Table:
    bands = [(0.0, 500.0), (500.0, 1000.0), (1000.0, 1500.0), (1500.0, float(f[-1]) + 1.0)]
    rows = []
    for dof, share in shares.items():
        ratio = _decibels(share["moment path"] / share["force path"], 10.0)
        rows.append([DIRECTIONS[dof], *(number(float(ratio[(f >= low) & (f < high)].mean())) for low, high in bands)])
    head = ["force", "0–0.5 kHz", "0.5–1 kHz", "1–1.5 kHz", "1.5–2 kHz"]
    return table("Upper joint: moment against force path, mean of 10 lg |moment/force|, dB", head, rows)


def _frequency_table(model: Model) -> Table:
    network = assemble(model.system)
    whole = api.natural_frequencies(model)
    rows = [[name, *(number(v, 4) for v in modes.frequencies[6:14])] for name, modes in network.bases.items()]
    rows.append(["assembly", *(number(v, 4) for v in whole[6:14])])
    return table("Natural frequencies, free, Hz", ["", *(str(k) for k in range(1, 9))], rows)


def _check(model: Model) -> Check:
    """Forces in the joints against the finite element solution of the whole, without synthesis or reduction."""
    omega = 2.0 * np.pi * _CHECKED
    reference = reference_solution(assemble(model.system), omega)
    flow = api.power_flow(model, _CHECKED)
    worst = float(np.max(abs(flow.alpha.values / reference.alpha - 1.0)))
    return Check("alpha against the finite element solution of the whole", worst, 1e-5, f"on {len(omega)} lines")


def _balance(flows: dict[str, xr.Dataset]) -> Check:
    worst = max(
        float(abs(flow.dissipated_power.sum("element") / flow.input_power - 1.0).max()) for flow in flows.values()
    )
    return Check("input power against the sum of dissipated powers", worst, 1e-8, f"{len(flows)} forces, all lines")
