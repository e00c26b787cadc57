"""The page: template, style and figures put together into one HTML file that needs nothing else."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .._version import __version__
from ..errors import InputError, MissingExtraError
from ..files import write_text
from ..fmu.checks import ValidationReport
from . import figures, findings, tables
from .balance import balance_figure, shares_figure
from .bearings import bearing_section
from .bode import bode_figures
from .layout import Figure
from .model_tables import excitation_words, model_tables
from .results import Results, compute

if TYPE_CHECKING:
    from ..modelfile import Model

_HERE = Path(__file__).parent


def write_report(
    model: Model,
    path: str | Path,
    *,
    validations: Sequence[ValidationReport] = (),
    progress: Callable[[str], None] = lambda _: None,
) -> Path:
    """Write the report of a model, with the validations of its FMUs, as one HTML file; return its path.

    The page opens offline and is the same for the same model, validations and versions. An existing file is replaced
    once the new one is complete. Raises MissingExtraError without plotly or jinja2, InputError where the file cannot
    be written.
    """
    target = Path(path)
    render = renderer(target)
    results = compute(model, progress)
    progress("report: page")
    render("template.html.j2", _content(model, results, validations))
    progress(f"report: {target}")
    return target


def renderer(target: Path) -> Callable[[str, Mapping[str, Any]], None]:
    """Check libraries and target before the work; what comes back writes the page of a template and its content."""
    plotly_js, environment = _libraries()
    _writable(target)

    def render(template: str, content: Mapping[str, Any]) -> None:
        html: str = environment.get_template(template).render(
            **content,
            version=__version__,
            plotly_js=plotly_js,
            style=(_HERE / "style.css").read_text(encoding="utf-8"),
            script=(_HERE / "plots.js").read_text(encoding="utf-8"),
        )
        write_text(target, html)

    return render


def figure_data(drawn: Sequence[Figure]) -> str:
    """All figures as JSON that is safe inside a script element; equal abscissae are stored once."""
    grids: dict[str, int] = {}
    book: dict[str, Any] = {}
    for figure in drawn:
        traces = []
        for trace in figure.data:
            if "x" not in trace:  # polar
                traces.append(trace)
                continue
            key = json.dumps(trace["x"], separators=(",", ":"))
            traces.append({**trace, "x": grids.setdefault(key, len(grids))})
        book[figure.key] = {"data": traces, "layout": figure.layout}
    text = json.dumps(book, separators=(",", ":"), allow_nan=False, ensure_ascii=False)
    content = f'{{"grids":[{",".join(grids)}],"figures":{text}}}'
    return content.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def _content(model: Model, results: Results, validations: Sequence[ValidationReport]) -> dict[str, Any]:
    carried = [figures.ratio_figure(results)] if results.paths else []
    paths = [figures.path_figure(results), figures.ranking_figure(results)] if results.paths else []
    balance = [balance_figure(results), shares_figure(results)]
    bode = bode_figures(validations, results.network)
    rolling = bearing_section(model)
    return {
        "title": model.name,
        "computed": findings.computed(results),
        "findings": findings.findings(results, validations),
        "key_figures": findings.key_figures(results, validations),
        "results": results,
        "tables": tables,
        "model_tables": model_tables(model.system),
        "excitation": excitation_words(model.system),
        "figures": {figure.key: figure for figure in carried + paths + balance},
        "bode": bode,
        "bearings": rolling,
        "validations": validations,
        "file": Path(model.file).name if model.file else None,
        "content": json.dumps(model.to_dict(), indent=2, ensure_ascii=False, default=str),
        "data": figure_data([*carried, *paths, *balance, *bode, *(rolling.figures if rolling else ())]),
    }


def _libraries() -> tuple[str, Any]:
    """plotly.js and a template environment."""
    try:
        from plotly.offline import get_plotlyjs
    except ImportError as error:
        raise MissingExtraError("plotly", "report") from error
    try:
        from jinja2 import Environment, FileSystemLoader, StrictUndefined
    except ImportError as error:
        raise MissingExtraError("jinja2", "report") from error
    loader = FileSystemLoader(_HERE)
    environment = Environment(
        loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=StrictUndefined
    )
    return str(get_plotlyjs()), environment


def _writable(target: Path) -> None:
    """Refuse before the work what cannot be written after it."""
    if target.is_dir():
        raise InputError(f"{target}: cannot be written (it is a directory); give a file name")
    parent = next(folder for folder in target.absolute().parents if folder.exists())
    if not parent.is_dir():
        raise InputError(f"{target}: cannot be written ({parent} is not a directory); choose another place")
