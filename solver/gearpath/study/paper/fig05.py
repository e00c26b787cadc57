"""Fig. 5: the synthesis against the direct solution, with complete bases and with a Guyan-reduced source."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from ... import api
from ...fmu.checks import Check
from ...modelfile import Model
from ...network.assemble import Network, assemble, to_modes
from ...network.reference import reference_solution
from ...numerics.arrays import Real
from ...reduction import guyan, reduced_modes
from ...report.table import Table, table
from ...report.wording import number
from ...results.labelled import labelled_power_flow
from .claims import judge
from .drawing import panel_figure
from .effect import BANDS, GRID, Ratios, by_band
from .machine import mounts, shipped
from .record import Study

EQUAL = 1e-6  # dB, what counts as the same result
EXCELLENT = 0.1  # dB, less than the width of a curve
_TRAIN = "gear_train"


def study(model: Model | None = None) -> Study:
    """alpha by the synthesis and by the direct solution of the assembled machine."""
    model = model or shipped()
    network = assemble(_with_masters(model).system)
    kept = masters(network)
    structure = network.structures[_TRAIN]
    reduced = to_modes(network, {**network.bases, _TRAIN: reduced_modes(structure, guyan(structure, kept))})
    direct = 10.0 * np.log10(reference_solution(network, 2.0 * np.pi * GRID).alpha)
    amplitude = api.amplitude(model)
    full, guyans = (Ratios(labelled_power_flow(n, GRID, amplitude)) for n in (network.modal(), reduced))
    size, rest = len(network.bases[_TRAIN].eigenvalues), len(kept)
    names = ["direct (unsynthesised)", "synthesis, complete basis", f"synthesis, Guyan ({size} → {rest})"]
    deviations = {name: abs(curve.level("alpha") - direct) for name, curve in zip(names[1:], (full, guyans))}
    excellent, close = (by_band(deviation, GRID) for deviation in deviations.values())
    return Study(
        key="fig05",
        title="Fig. 5: synthesis against the direct solution",
        done=f"α from the mobility synthesis with all {size} modes of the source, and with {rest} of a source that is "
        f"reduced after Guyan (by a factor of {number(size / rest, 2)}; kept: the bearings' uy and rx, the gears' uy, "
        "rx and spin, uy half-way between), against the whole machine solved directly in physical coordinates, without "
        "modes and mobilities.",
        figures=(
            panel_figure(
                "fig05",
                GRID,
                {
                    "power ratio": dict(zip(names, (direct, full.level("alpha"), guyans.level("alpha")))),
                    "distance of the Guyan-reduced synthesis from the direct solution": {
                        names[2]: deviations[names[2]]
                    },
                },
                names,
                ["power ratio 10 lg α, dB", "|difference|, dB"],
                f"The synthesis with complete bases lies on the direct solution: largest difference "
                f"{number(float(deviations[names[1]].max()), 2)} dB. With Guyan's reduction it departs with frequency: "
                f"largest difference {number(float(deviations[names[2]].max()), 2)} dB.",
            ),
        ),
        claims=(
            judge(
                "The synthesis is exact when the complete modal basis of each structure is used.",
                f"largest |difference| of α from the direct solution below {number(EQUAL, 1)} dB",
                [float(part.max()) for part in excellent],
                lambda d: d < EQUAL,
                digits=None,
            ),
            judge(
                "With a Guyan reduction by a factor of about four an excellent match is still achieved.",
                f"median |difference| of α from the direct solution below {EXCELLENT:g} dB",
                [float(np.median(part)) for part in close],
                lambda d: d < EXCELLENT,
                digits=3,
            ),
        ),
        tables=(_table(deviations),),
        own_checks=_checks(model, full, deviations[names[1]]),
    )


def masters(network: Network) -> list[int]:
    """Coordinates of the gear train that its ports and sensors read, and those that a transmission error moves."""
    block = network.blocks[_TRAIN]
    rows = [row[block] for joint in network.joints for row in joint.source]
    rows += [output.row[block] for output in network.outputs if output.row is not None and _is_sensor(output.name)]
    rows += [mesh.displacement for mesh in network.structures[_TRAIN].meshes.values()]
    return sorted({int(k) for row in rows for k in np.flatnonzero(row)})


def _is_sensor(name: str) -> bool:
    return name.startswith("sensors.")


def _with_masters(model: Model) -> Model:
    """The model with sensors at the gears (uy, rx) and half-way between gears and shaft ends (uy)."""
    data = model.to_dict()
    sensors: dict[str, Any] = dict(data.get("sensors", {}))
    for shaft, entry in data["components"][_TRAIN]["shafts"].items():
        gears = [disk["z"] for disk in entry["disks"]]
        stations = [0.0, *sorted(gears), entry["length"]]
        wanted = [(z, dof) for z in gears for dof in ("uy", "rx")]
        wanted += [((a + b) / 2.0, "uy") for a, b in pairwise(stations)]
        for k, (z, dof) in enumerate(wanted):
            sensors[f"master_{shaft}_{k}"] = {"component": _TRAIN, "point": f"{shaft}@{z!r}", "dof": dof}
    return Model.from_dict({**data, "sensors": sensors}, model.file)


def _checks(model: Model, full: Ratios, deviation: Real) -> tuple[Check, ...]:
    """Synthesis against the direct solution, and the power into the casing against what the mounts dissipate."""
    relative = float(np.max(10.0 ** (deviation / 10.0) - 1.0))
    lost = full.flow.dissipated_power.sel(element=mounts(model)).sum("element")
    beside = float(abs(lost / full.flow.transmitted_power - 1.0).max())
    return (
        Check("alpha of the synthesis against the direct solution", relative, 1e-8, f"{len(GRID)} lines"),
        Check("power through the bearings against the power lost in the mounts", beside, 1e-8, f"{len(GRID)} lines"),
        Check("input power against the sum of dissipated powers", full.imbalance, 1e-8, f"{len(GRID)} lines"),
    )


def _table(deviations: dict[str, Real]) -> Table:
    rows = []
    for name, deviation in deviations.items():
        parts = by_band(deviation, GRID)
        rows.append([f"{name}: median", *(number(float(np.median(part)), 2) for part in parts)])
        rows.append([f"{name}: largest", *(number(float(part.max()), 2) for part in parts)])
    return table("|Difference| of α from the direct solution, dB", ["", *BANDS], rows)
