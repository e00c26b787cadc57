"""Fig. 7: beam elements for the shafts."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from ...modelfile import Model
from ...network.assemble import assemble
from ...numerics.arrays import Real
from ...report.table import Table, table
from ...report.wording import number
from .claims import Claim, judge, number_of
from .drawing import ratio_figure
from .effect import BANDS, EDGES, Effect, Ratios, ratios
from .machine import changed_shafts, shipped
from .record import Study

KINDS = {
    "TI": ("timoshenko", "TI, Timoshenko"),
    "EU": ("euler", "EU, Euler"),
    "MR": ("mindlin_reduced", "MR, Mindlin, reduced integration"),
    "MF": ("mindlin_full", "MF, Mindlin, full integration"),
}
WRONG = 1.0  # %, deviation of a natural frequency from Timoshenko's that counts as incorrect
Distances = dict[frozenset[str], Effect]


def study(model: Model | None = None) -> Study:
    """alpha with four kinds of beam elements, every kind against every other."""
    model = model or shipped()
    machines = {short: model.replace(changed_shafts(model, beam=kind)) for short, (kind, _) in KINDS.items()}
    curves = {short: ratios(machine) for short, machine in machines.items()}
    pairs = {frozenset(pair): _pair(curves, *pair) for pair in combinations(KINDS, 2)}
    natural = _natural(machines)
    closest = min(pairs, key=lambda pair: pairs[pair].median("alpha"))
    farthest = max(pairs, key=lambda pair: pairs[pair].median("alpha"))
    caption = (
        f"Closest to each other over all lines: {' and '.join(sorted(closest))}, median |D| "
        f"{number_of(pairs[closest].median('alpha'))} dB; farthest apart: {' and '.join(sorted(farthest))}, "
        f"{number_of(pairs[farthest].median('alpha'))} dB. The table below has every pair."
    )
    claims = (_alike(pairs, "MR", "EU", "TI", _NEARLY), _alike(pairs, "MF", "TI", "EU", _SIMILAR))
    swapped = (_alike(pairs, "MF", "EU", "TI", _NEARLY), _alike(pairs, "MR", "TI", "EU", _SIMILAR))
    return Study(
        key="fig07",
        title="Fig. 7: beam elements of the shafts",
        done="The shafts of the gearbox with 8 + 8 elements each, of four kinds; Timoshenko's is the benchmark.",
        figures=(ratio_figure("fig07", {KINDS[short][1]: curves[short] for short in KINDS}, ("alpha",), caption),),
        claims=(*claims, _frequencies_wrong(natural)),
        effects=tuple(Effect(KINDS[short][1], curves["TI"], curves[short]) for short in ("EU", "MR", "MF")),
        tables=(_pair_table(pairs), _natural_table(natural)),
        remarks=(
            "With the labels of the two Mindlin elements exchanged, the first statement "
            f"{swapped[0].verdict} and the second {swapped[1].verdict}.",
        ),
    )


_NEARLY = "Mindlin elements with reduced integration (MR) give nearly the results of Euler elements."
_SIMILAR = "Mindlin elements with full integration (MF) give results similar to Timoshenko elements."


def _pair(curves: dict[str, Ratios], one: str, other: str) -> Effect:
    return Effect(f"{one} and {other}", curves[one], curves[other])


def _alike(pairs: Distances, one: str, near: str, far: str, says: str) -> Claim:
    figures = zip(pairs[frozenset((one, near))].medians("alpha"), pairs[frozenset((one, far))].medians("alpha"))
    criterion = f"median |D| of α, {one} from {near} smaller than {one} from {far}"
    return judge(says, criterion, list(figures), np.less)


def _natural(machines: dict[str, Model]) -> dict[str, Real]:
    """Elastic free-free natural frequencies of the gear train, Hz: as many as the benchmark has in the band."""
    every = {short: assemble(machine.system).bases["gear_train"].frequencies for short, machine in machines.items()}
    rigid = int((every["TI"] == 0.0).sum())
    inside = int((every["TI"] <= EDGES[-1]).sum())
    return {short: frequencies[rigid:inside] for short, frequencies in every.items()}


def _deviation(natural: dict[str, Real], short: str) -> Real:
    return np.asarray(100.0 * (natural[short] / natural["TI"] - 1.0))


def _frequencies_wrong(natural: dict[str, Real]) -> Claim:
    return judge(
        "Euler elements, and Mindlin elements with reduced integration, predict the natural frequencies incorrectly.",
        f"largest deviation of the source's natural frequencies up to 5 kHz from Timoshenko's above {WRONG:g} %",
        [float(abs(_deviation(natural, short)).max()) for short in ("EU", "MR")],
        lambda percent: percent > WRONG,
        ("EU", "MR"),
        unit="%",
    )


def _pair_table(pairs: Distances) -> Table:
    rows = [
        [pair.name, *(number_of(value) for value in pair.medians("alpha")), number_of(pair.median("alpha"))]
        for pair in pairs.values()
    ]
    return table("Median |D| of α between two kinds, dB", ["", *BANDS, "all lines"], rows)


def _natural_table(natural: dict[str, Real]) -> Table:
    rows = [
        [KINDS[short][1], *(f"{number(f, 5)} ({number_of(d)} %)" for f, d in zip(natural[short], deviations))]
        for short in KINDS
        for deviations in [_deviation(natural, short)]
    ]
    head = ["", *(f"mode {k}" for k in range(1, len(natural["TI"]) + 1))]
    return table("Gear train, free-free: natural frequencies in Hz (deviation from Timoshenko)", head, rows)
