"""A study: one figure of the paper computed again, and what became of the statements about it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...fmu.checks import Check
from ...report.layout import Figure
from ...report.table import Group, Table
from .claims import Claim, number_of
from .effect import BANDS, PARTS, Effect, Ratios, band_means

_ROWS = {"alpha": "all paths, α", "force": "force paths", "moment": "moment paths"}


@dataclass(frozen=True)
class Study:
    """What was done, drawn and found."""

    key: str  # "fig09"
    title: str
    done: str  # what is compared, with the numbers of the change
    figures: tuple[Figure, ...]
    claims: tuple[Claim, ...]
    effects: tuple[Effect, ...] = ()
    tables: tuple[Table, ...] = ()
    remarks: tuple[str, ...] = ()  # found beside the statements
    own_checks: tuple[Check, ...] = ()

    @property
    def every_table(self) -> tuple[Table, ...]:
        """The table of the effects first, if there are any."""
        return (effect_table(self.effects), *self.tables) if self.effects else self.tables

    @property
    def checks(self) -> tuple[Check, ...]:
        """Its own checks, and the power balance of every machine in it."""
        machines = [effect.changed for effect in self.effects] + [effect.original for effect in self.effects[:1]]
        if not machines:
            return self.own_checks
        worst = max(machine.imbalance for machine in machines)
        what = f"{len(machines)} machines, all lines"
        return (*self.own_checks, Check("input power against the sum of dissipated powers", worst, 1e-8, what))

    def as_dict(self) -> dict[str, Any]:
        """The study for machines."""
        return {
            "key": self.key,
            "title": self.title,
            "done": self.done,
            "bands": BANDS,
            "effects": [effect.as_dict() for effect in self.effects],
            "claims": [claim.as_dict() for claim in self.claims],
            "remarks": self.remarks,
            "checks": [{"name": c.name, "figure": c.figure, "limit": c.limit, "passed": c.passed} for c in self.checks],
        }


def effect_table(effects: tuple[Effect, ...]) -> Table:
    """Mean of D by band, over all lines, and the median of |D|; the original's own mean levels above."""
    groups = [Group(_levels(effects[0].original), "original, mean level")]
    groups += [Group(_differences(effect), effect.name) for effect in effects]
    head = ["", *BANDS, "all lines", "median |D|"]
    caption = "Mean of D = 10 lg |changed| − 10 lg |original| by band, dB"
    return Table(caption, head, groups, 1, "Casing side of the bearings; 500 lines from 10 Hz to 5 kHz.")


def _levels(original: Ratios) -> list[list[str]]:
    rows = []
    for part in PARTS:
        level = original.level(part)
        means = (*band_means(level, original.frequency), float(level.mean()))
        rows.append([_ROWS[part], *(number_of(value) for value in means), ""])
    return rows


def _differences(effect: Effect) -> list[list[str]]:
    rows = []
    for part in PARTS:
        median = effect.median(part)
        means = [number_of(value) for value in (*effect.means(part), effect.mean(part))]
        rows.append([_ROWS[part], *means, number_of(median) if median < float("inf") else "–"])
    return rows
