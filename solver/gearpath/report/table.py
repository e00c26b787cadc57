"""A table as data: what the page draws, and what a test can read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class MatrixCell:
    """A matrix within a cell: its rows and columns have the names in `head`, every entry is a number and its unit."""

    head: Sequence[str]
    rows: Sequence[Sequence[tuple[str, str]]]


Cell = str | MatrixCell


@dataclass(frozen=True)
class Group:
    """Rows that belong together, under a heading of their own if they have one."""

    rows: Sequence[Sequence[Cell]]
    label: str = ""


@dataclass(frozen=True)
class Table:
    """Caption, column headings (those of numbers are right-aligned) and rows."""

    caption: str
    head: Sequence[str]
    groups: Sequence[Group]
    text_columns: int = 1  # so many columns at the left hold text; the others numbers
    note: str = ""


def table(caption: str, head: Sequence[str], rows: Sequence[Sequence[Cell]], text: int = 1, note: str = "") -> Table:
    """A table of one group."""
    return Table(caption, head, (Group(rows),), text, note)
