"""Statements of the paper, each judged by computed figures against a stated limit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from ...report.wording import listed, number
from .effect import BANDS, EDGES, Effect, Part

NOTICEABLE = 1.0  # dB, about the smallest change of a level that a listener notices
DOUBLED = 3.0  # dB, twice the power
EVERYWHERE, LOWER, HIGHER = slice(None), slice(0, 2), slice(2, None)  # of the bands: below 2 kHz, from 2 kHz


@dataclass(frozen=True)
class Item:
    """One band or case of a claim: its figures, and whether the claim holds there."""

    where: str
    values: tuple[float, ...]  # the figure, and what it is compared with if that was computed as well
    holds: bool


@dataclass(frozen=True)
class Claim:
    """One statement, what it is judged by, and what was found in every band or case."""

    says: str
    criterion: str
    items: tuple[Item, ...]
    unit: str = "dB"
    digits: int | None = 2  # decimals; None prints two significant digits of figures of any size

    @property
    def entries(self) -> list[tuple[str, str]]:
        """Where, and the figures there in words: (`0–1 kHz`, `0.41 dB`)."""
        return [(item.where, self._in_words(item)) for item in self.items]

    @property
    def found(self) -> str:
        """All entries in a row: `0–1 kHz: 0.41 dB; 1–2 kHz: 1.15 dB`."""
        return "; ".join(f"{where}: {figures}".removeprefix(": ") for where, figures in self.entries)

    def _in_words(self, item: Item) -> str:
        figures = [number(v, 2) if self.digits is None else number_of(v, self.digits) for v in item.values]
        return f"{' against '.join(figures)} {self.unit}".strip()

    @property
    def outcome(self) -> str:
        """`holds`, `in part` or `fails`."""
        every = [item.holds for item in self.items]
        return "holds" if all(every) else "in part" if any(every) else "fails"

    @property
    def verdict(self) -> str:
        """`holds`, `does not hold`, or where it holds."""
        if self.outcome == "in part":
            return f"holds only {places([item.where for item in self.items if item.holds])}"
        return "holds" if self.outcome == "holds" else "does not hold"

    def as_dict(self) -> dict[str, Any]:
        """The claim for machines."""
        return {
            "says": self.says,
            "criterion": self.criterion,
            "unit": self.unit,
            "found": [{"where": item.where, "values": item.values, "holds": item.holds} for item in self.items],
            "verdict": self.verdict,
        }


def judge(
    says: str,
    criterion: str,
    values: Sequence[float | tuple[float, ...]],
    test: Callable[..., bool],
    where: Sequence[str] = BANDS,
    **more: Any,
) -> Claim:
    """A claim whose items hold where `test` of their figures is true; by band unless `where` names other cases."""
    figures = [value if isinstance(value, tuple) else (value,) for value in values]
    return Claim(says, criterion, tuple(Item(w, v, bool(test(*v))) for w, v in zip(where, figures)), **more)


def little(says: str, effect: Effect, part: Part, where: slice = EVERYWHERE) -> Claim:
    """A statement that a change leaves a part as it was, in all bands or in those at `where`."""
    criterion = f"median |D| of {NAMES[part]} below {NOTICEABLE:g} dB"
    return judge(says, criterion, effect.medians(part)[where], lambda d: d < NOTICEABLE, BANDS[where])


def noticeable(says: str, effect: Effect, part: Part, where: slice = EVERYWHERE) -> Claim:
    """A statement that a change is seen in a part, in all bands or in those at `where`."""
    criterion = f"median |D| of {NAMES[part]} at least {NOTICEABLE:g} dB"
    return judge(says, criterion, effect.medians(part)[where], lambda d: d >= NOTICEABLE, BANDS[where])


def increased(says: str, effect: Effect, part: Part) -> Claim:
    """A statement that a change raises a part significantly."""
    criterion = f"mean D of {NAMES[part]} at least {DOUBLED:g} dB (twice the power)"
    return judge(says, criterion, effect.means(part), lambda d: d >= DOUBLED)


NAMES: dict[Part, str] = {"alpha": "α", "force": "the force path", "moment": "the moment path"}


def number_of(value: float, digits: int = 2) -> str:
    """A figure to so many decimals; minus infinity is power that vanished, NaN that there never was any."""
    if value != value:
        return "–"
    if abs(value) == float("inf"):
        return "vanishes" if value < 0.0 else "∞"
    return f"{round(value, digits) + 0.0:.{digits}f}".replace("-", "\u2212")


def places(where: Sequence[str]) -> str:
    """`at 0–2 and 3–5 kHz` for bands that may be adjacent, `for a and b` for other cases."""
    if not set(where) <= set(BANDS):
        return f"for {listed(list(where))}"
    spans: list[list[float]] = []
    for band, (low, high) in zip(BANDS, pairwise(EDGES)):
        if band in where and spans and spans[-1][1] == low:
            spans[-1][1] = high
        elif band in where:
            spans.append([low, high])
    return f"at {listed([f'{low / 1e3:g}–{high / 1e3:g}' for low, high in spans])} kHz"
