"""The page of the paper's studies: every figure, its table, and what became of the paper's statements."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .page import figure_data, renderer

if TYPE_CHECKING:
    from ..study.paper.record import Study

OUTCOMES = {"holds": "✓ holds", "in part": "◐ in part", "fails": "✗ does not hold"}


def gallery_page(target: Path) -> Callable[[Sequence[Study]], Path]:
    """Check what can go wrong before the work; what comes back writes the studies as one HTML file.

    Raises MissingExtraError without plotly or jinja2, InputError where the file cannot be written.
    """
    render = renderer(target)

    def write(studies: Sequence[Study]) -> Path:
        content = {
            "studies": studies,
            "contents": [*(("summary", "Summary"),), *((s.key, short(s)) for s in studies), ("method", "Method")],
            "outcomes": OUTCOMES,
            "counts": {outcome: count(studies, outcome) for outcome in OUTCOMES},
            "short": short,
            "data": figure_data([figure for study in studies for figure in study.figures]),
        }
        render("gallery.html.j2", content)
        return target

    return write


def count(studies: Sequence[Study], outcome: str) -> int:
    """How many of the paper's statements came out so."""
    return sum(claim.outcome == outcome for study in studies for claim in study.claims)


def short(study: Study) -> str:
    """The title up to its colon."""
    return study.title.split(":")[0]
