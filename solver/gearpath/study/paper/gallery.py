"""All studies of the paper: computed with progress, printed, and drawn on one page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from rich.markup import escape
from rich.table import Table as RichTable

from ... import console
from ...report.gallery import gallery_page
from ...report.table import Table
from . import asymmetry, completeness, design, fig05, fig06, fig07, fig08, fig09, fig11, fig12, fig13, fig14, fig15
from .record import Study

_FIGURES = (fig05, fig06, fig07, fig08, fig09, fig11, fig12, fig13, fig14, fig15)
STUDIES: tuple[Callable[[], Study], ...] = tuple(
    module.study for module in (completeness, *_FIGURES, asymmetry, design)
)
_PLAIN = str.maketrans({"–": "-", "−": "-", "×": "x", "α": "alpha", "→": "->", "∞": "infinite", "µ": "u"})


def run(
    output: Path, json: bool = False, studies: Sequence[Callable[[], Study]] = STUDIES, tables: bool = False
) -> bool:
    """Compute the studies, write their page and print what was found; whether every check of them passed."""
    write = gallery_page(output)
    found: list[Study] = []
    with console.progress("the paper's studies", len(studies), quiet=json) as bar:
        for study in studies:
            bar.describe(_key(study))
            found.append(study())
            bar.advance(1.0)
    write(found)
    checks = [check for study in found for check in study.checks]
    if json:
        console.print_json({"page": output, "studies": [study.as_dict() for study in found]})
    else:
        for item in found:
            _print(item, tables)
        console.out.print(f"wrote {escape(str(output))}: open it in a browser")
    return all(check.passed for check in checks)


def show(study: Callable[[], Study]) -> None:
    """Print one study with its tables and write its page to build/paper/."""
    run(Path("build") / "paper" / f"{_key(study)}.html", studies=[study], tables=True)


def _key(study: Callable[[], Study]) -> str:
    return study.__module__.rpartition(".")[2]


def _print(study: Study, tables: bool) -> None:
    _say(f"\n[bold]{escape(study.title)}[/]\n{escape(study.done)}")
    for item in study.every_table if tables else ():
        console.out.print(_as_text(item))
    for claim in study.claims:
        colour = {"holds": "green", "fails": "red"}.get(claim.outcome, "yellow")
        _say(f"[{colour}]{claim.verdict}[/]: {escape(claim.says)}")
        _say(f"    {escape(claim.criterion)}: {escape(claim.found)}")
    for remark in study.remarks:
        _say(escape(remark))
    for check in study.checks:
        verdict = "[green]passed[/]" if check.passed else "[red]FAILED[/]"
        _say(f"{verdict} {escape(check.name)}: {check.figure:.2g} (limit {check.limit:.2g})")


def _as_text(item: Table) -> RichTable:
    table = RichTable(title=_printable(escape(item.caption)), title_justify="left", show_edge=False)
    for k, name in enumerate(item.head):
        table.add_column(_printable(escape(name)), justify="left" if k < item.text_columns else "right")
    for group in item.groups:
        if group.label:
            table.add_row(f"[bold]{_printable(escape(group.label))}[/]")
        for row in group.rows:
            table.add_row(*(_printable(escape(str(cell))) for cell in row))
    return table


def _say(text: str) -> None:
    console.out.print(_printable(text))


def _printable(text: str) -> str:
    """The text, in plainer signs where the terminal's encoding lacks some (old Windows consoles)."""
    encoding = console.out.encoding
    if text.encode(encoding, "ignore").decode(encoding) == text:
        return text
    return text.translate(_PLAIN).encode(encoding, "replace").decode(encoding)
