"""What the commands share: settings given as key=value, progress, and one sentence for every mistake."""

from __future__ import annotations

import json
import sys
import tomllib
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

from .errors import GearpathError, InputError

if TYPE_CHECKING:  # the models and the solver behind them are loaded when they are used: --help answers at once
    from .fmu.checks import ValidationReport
    from .fmu.conformance import Finding
    from .modelfile import Model

DONE, CHECK_FAILED, BAD_INPUT = 0, 1, 2
out = Console(highlight=False, soft_wrap=True)
err = Console(stderr=True, highlight=False, soft_wrap=True)


@contextmanager
def notes(to: Console = out) -> Iterator[None]:
    """Print warnings as notes, each once, without the line of the program that they come from."""
    with warnings.catch_warnings(record=True) as noted:
        warnings.simplefilter("always", UserWarning)
        yield
    for text in dict.fromkeys(str(note.message) for note in noted):
        to.print(f"note: {escape(text)}")


@contextmanager
def mistakes_explained() -> Iterator[None]:
    """Turn every error on purpose into its sentence on stderr and exit code 2."""
    try:
        yield
    except GearpathError as error:
        _stop(str(error))
    except KeyboardInterrupt:
        _stop("interrupted; nothing was left half-written")


def _stop(sentence: str) -> NoReturn:
    err.print(f"[red]error[/]: {escape(sentence)}")
    sys.exit(BAD_INPUT)


def load_with(path: Path, settings: Sequence[str], *, noted: bool = True) -> Model:
    """The model of a file with `key=value` settings applied, values in TOML; notes on it go to stderr."""
    from .modelfile import load

    changes: dict[str, Any] = {}
    for setting in settings:
        key, separator, text = setting.partition("=")
        if not separator or not key.strip():
            raise InputError(f"--set {setting}: is not KEY=VALUE; write for example --set components.casing.mass=14")
        changes[key.strip()] = _toml_value(text.strip())
    with notes(err) if noted else nullcontext():
        model = load(path).replace(changes) if changes else load(path)
        if noted:
            _ = model.system  # the operating point of its bearings
    return model


def _toml_value(text: str) -> Any:
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text  # a bare word is a string: --set components.casing.kind=rigid_body


@dataclass(frozen=True)
class Bar:
    """A running progress bar."""

    advance: Callable[[float], None]  # by an amount
    describe: Callable[[str], None]  # what is being done


@contextmanager
def progress(title: str, total: float, quiet: bool = False) -> Iterator[Bar]:
    """A progress bar on stderr that says how much of `total` is done."""
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:>3.0f} %"),
        TimeElapsedColumn(),
    )
    with Progress(*columns, console=err, transient=True, disable=quiet) as bar:
        task = bar.add_task(title, total=total)
        yield Bar(
            lambda amount: bar.advance(task, amount),
            lambda what: bar.update(task, description=f"{title}: {what}"),
        )


@contextmanager
def working(title: str, quiet: bool = False) -> Iterator[None]:
    """A sign on stderr that work of unknown length goes on."""
    with nullcontext() if quiet else err.status(escape(title)):
        yield


def print_json(data: Any) -> None:
    """One JSON document on stdout; NaN and infinity, which JSON does not have, become null."""
    sys.stdout.write(json.dumps(_plain(data), indent=1, allow_nan=False) + "\n")


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, complex):
        return {"re": _plain(value.real), "im": _plain(value.imag)}
    if isinstance(value, (float, np.floating)):
        return float(value) if np.isfinite(value) else None
    if isinstance(value, (np.integer, np.bool_)):
        return value.item()
    return str(value) if isinstance(value, Path) else value


def report_as_dict(report: ValidationReport) -> dict[str, Any]:
    """A validation for machines."""
    return {
        "fmu": report.fmu,
        "kind": report.kind,
        "passed": report.passed,
        "checks": [
            {"name": c.name, "figure": c.figure, "limit": c.limit, "passed": c.passed, "what": c.what}
            for c in report.checks
        ],
        "findings": findings_as_list(report.findings),
    }


def findings_as_list(findings: Sequence[Finding]) -> list[dict[str, str]]:
    """Findings of the conformance check for machines."""
    return [asdict(finding) for finding in findings]


def counted(findings: Sequence[Finding]) -> str:
    """How many findings of each severity there are, in words."""
    from .fmu.conformance import Severity

    counts = [(sum(f.severity == kind for f in findings), kind.value) for kind in Severity]
    return ", ".join(f"{n} {name}{'s' if n > 1 else ''}" for n, name in counts if n) or "conforms to the standard"


def print_findings(findings: Sequence[Finding]) -> None:
    """Findings of the conformance check, one a line with the clause of the standard."""
    from .fmu.conformance import Severity

    colours = {Severity.ERROR: "red", Severity.WARNING: "yellow", Severity.NOTE: "cyan"}
    for finding in findings:
        head = f"[{colours[finding.severity]}]{finding.severity}[/] {finding.rule}"
        out.print(f"  {head}: {escape(finding.message)} ({escape(finding.clause)})")


def print_report(report: ValidationReport) -> None:
    """A validation as a table: every check with its figure and its limit."""
    table = Table(title=f"{report.fmu.name} ({report.kind} kind)", title_justify="left", show_edge=False)
    table.add_column("check")
    table.add_column("figure", justify="right")
    table.add_column("limit", justify="right")
    table.add_column("")
    for check in report.checks:
        verdict = "[green]passed[/]" if check.passed else "[red]FAILED[/]"
        table.add_row(escape(check.name), f"{check.figure:.2g}", f"{check.limit:.2g}", verdict)
    out.print(table)
    for check in report.checks:
        if not check.passed:
            out.print(f"  {escape(check.name)}: {escape(check.what)}")
    for name, note in report.notes.items():
        out.print(f"{escape(name)}: {escape(note)}")
    print_findings(report.findings)
