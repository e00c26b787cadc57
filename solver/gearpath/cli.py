"""The command line: sweep, fmu, validate, report, bearing, paper, schema.

Exit codes: 0 done, 1 a check failed, 2 bad input.
"""

from __future__ import annotations

import os
import sys
import warnings
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

# set before numpy is loaded: of many small solves each is slower with several threads than with one
for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

from . import __version__, console  # noqa: E402
from .errors import InputError  # noqa: E402

app = typer.Typer(
    name="gearpath",
    help="Structure-borne noise power flow in gearboxes, and the same physics as FMUs.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)

ModelPath = Annotated[Path, typer.Argument(metavar="MODEL", help="Model file (TOML), such as models/gearbox.toml.")]
Settings = Annotated[
    list[str],
    typer.Option(
        "--set", metavar="KEY=VALUE", help="Replace a value of the model, such as joints.mount_1.damping=600."
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON document for machines instead of text.")]


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"gearpath {__version__}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Structure-borne noise power flow in gearboxes, and the same physics as FMUs."""


@app.command()
def sweep(
    model: ModelPath,
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Write all lines to this .csv file.")] = None,
    check: Annotated[bool, typer.Option("--check", help="Compare with the unsynthesised reference solution.")] = False,
    set_: Settings = [],  # noqa: B006 - typer reads the default
    json: Json = False,
) -> None:
    """Compute the power flow over the model's frequencies: ratios by path and band."""
    from .study import sweeping

    passed = sweeping.run(console.load_with(model, set_), output, check, json)
    raise typer.Exit(console.DONE if passed else console.CHECK_FAILED)


@app.command()
def fmu(
    model: ModelPath,
    output: Annotated[Path, typer.Option("--output", "-o", help="The FMU to write.")],
    kind: Annotated[
        str, typer.Option(help="native (runs without Python) or python (design parameters too).")
    ] = "native",
    fmi: Annotated[str, typer.Option(help="Version of FMI, 2.0 or 3.0.")] = "2.0",
    torques: Annotated[
        str, typer.Option(metavar="N M,...", help="Stiffness follows operation.torque between these, as 10,50,100.")
    ] = "",
    order: Annotated[
        int | None, typer.Option(help="Reduce it to this number of coordinates, half as many as states.")
    ] = None,
    tolerance: Annotated[
        float | None, typer.Option(help="Reduce it as far as this relative error over the model's frequencies allows.")
    ] = None,
    set_: Settings = [],  # noqa: B006
    json: Json = False,
) -> None:
    """Export the model as an FMU."""
    from . import api
    from .fmu.reduction import certificate_of

    fmi = {"2": "2.0", "3": "3.0"}.get(fmi, fmi)
    try:
        schedule = [float(torque) for torque in torques.split(",")] if torques else None
    except ValueError as error:
        raise InputError(f"--torques {torques}: are no numbers; write them in N m, as --torques 10,50,100") from error
    with warnings.catch_warnings() if json else console.notes():
        loaded = console.load_with(model, set_)
        with console.working(f"exporting {loaded.name}", quiet=json):
            path = api.export_fmu(
                loaded, output, fmi=fmi, kind=kind, schedule=schedule, order=order, tolerance=tolerance
            )
    found = certificate_of(path)
    if json:
        written = {"fmu": path, "kind": kind, "fmi": fmi, "bytes": path.stat().st_size}
        console.print_json(written | ({"reduction": asdict(found)} if found else {}))
    else:
        console.out.print(f"wrote {path} ({kind} kind, FMI {fmi}, {path.stat().st_size / 1e3:.0f} kB)", markup=False)
        if found:
            console.out.print(str(found), markup=False)


@app.command()
def validate(
    fmu: Annotated[Path, typer.Argument(metavar="FMU", help="The FMU to check.")],
    model: Annotated[
        Path | None, typer.Argument(metavar="[MODEL]", help="The model file that it was exported from.")
    ] = None,
    set_: Settings = [],  # noqa: B006
    json: Json = False,
) -> None:
    """Check an FMU against its model, figures with their limits; without a model any FMU against the standard."""
    from .job import conformance_of, validate_one

    if model is None:
        if set_:
            raise InputError("--set changes a model, and none is given; name the model file after the FMU")
        findings = conformance_of(fmu)
        if json:
            console.print_json({"fmu": fmu, "findings": console.findings_as_list(findings)})
        else:
            console.print_findings(findings)
            console.out.print(f"{fmu}: {console.counted(findings)}", markup=False)
        raise typer.Exit(console.CHECK_FAILED if any(f.severity == "error" for f in findings) else console.DONE)
    report = validate_one(fmu, console.load_with(model, set_), quiet=json)
    if json:
        console.print_json(console.report_as_dict(report))
    else:
        console.print_report(report)
    raise typer.Exit(console.DONE if report.passed else console.CHECK_FAILED)


@app.command()
def report(
    model: ModelPath,
    output: Annotated[Path, typer.Option("--output", "-o", help="The page to write.")] = Path("report.html"),
    fmu: Annotated[list[Path], typer.Option("--fmu", help="Validate this FMU and show the result.")] = [],  # noqa: B006
    set_: Settings = [],  # noqa: B006
    json: Json = False,
) -> None:
    """Write the report of a model as one HTML page."""
    from .job import validate_one
    from .report import write_report

    loaded = console.load_with(model, set_)
    reports = [validate_one(path, loaded, quiet=json) for path in fmu]
    with console.notes(console.err):
        written = write_report(loaded, output, validations=reports)
    passed = all(item.passed for item in reports)
    if json:
        console.print_json({"report": written, "passed": passed, "fmus": [console.report_as_dict(r) for r in reports]})
    else:
        console.out.print(f"wrote {written}", markup=False)
    raise typer.Exit(console.DONE if passed else console.CHECK_FAILED)


@app.command()
def bearing(
    target: Annotated[
        str | None,
        typer.Argument(metavar="TARGET", help="Designation of the catalogue, such as 7210B-like, or a model file."),
    ] = None,
    load: Annotated[
        list[str], typer.Option(metavar="DOF=N", help="Load, such as uz=500 (N, N m); not named: held.")
    ] = [],  # noqa: B006
    displacement: Annotated[
        list[str], typer.Option(metavar="DOF=M", help="Displacement instead, such as uz=1e-5 (m, rad).")
    ] = [],  # noqa: B006
    preload: Annotated[float | None, typer.Option(metavar="N", help="Axial force that presses it together.")] = None,
    mirrored: Annotated[bool, typer.Option("--mirrored", help="Facing the other way.")] = False,
    arrangement: Annotated[str, typer.Option(help="A pair: back_to_back, face_to_face or tandem.")] = "",
    distance: Annotated[float | None, typer.Option(metavar="M", help="Distance of the pair's rows.")] = None,
    speed: Annotated[float | None, typer.Option(metavar="REV/MIN", help="To be told of centrifugal forces.")] = None,
    phases: Annotated[bool, typer.Option("--phases", help="Average and spread over the cage's positions.")] = False,
    joint: Annotated[str | None, typer.Option(metavar="NAME", help="Only this joint of the model.")] = None,
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Write this HTML page too.")] = None,
    list_: Annotated[bool, typer.Option("--list", help="Show the catalogue with its sources.")] = False,
    catalogue_file: Annotated[Path | None, typer.Option(metavar="FILE", help="Own entries (TOML).")] = None,
    set_: Settings = [],  # noqa: B006
    json: Json = False,
) -> None:
    """Stiffness, load distribution and limits of a rolling bearing, or of those of a model at its operating point."""
    from .study.bearing_command import Order, run

    if list_ and target is not None:
        raise InputError(f"--list shows the whole catalogue; leave {target} out")
    order = Order(
        target, load, displacement, preload, mirrored, arrangement, distance, speed, phases, joint, set_, catalogue_file
    )
    run(order, output, json)


@app.command()
def paper(
    output: Annotated[Path, typer.Option("--output", "-o", help="The page to write.")] = Path("paper.html"),
    json: Json = False,
) -> None:
    """Compute the studies of Rook & Singh (1996) again: figures, tables and what holds, as one HTML page."""
    from .study.paper import gallery

    passed = gallery.run(output, json)
    raise typer.Exit(console.DONE if passed else console.CHECK_FAILED)


@app.command()
def schema(
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Write it here instead of to stdout.")] = None,
) -> None:
    """Print the JSON schema of model files, for editors."""
    from .files import write_text
    from .modelfile.schema import schema_text

    if output is None:
        sys.stdout.write(schema_text())
    else:
        write_text(output, schema_text())


@app.command()
def build(
    model: ModelPath,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Write one FMU here, instead of FMUs and report into build/.")
    ] = None,
    kind: Annotated[str, typer.Option(help="Kind of that one FMU: native or python.")] = "native",
    fmi: Annotated[str, typer.Option(help="Version of FMI of that one FMU.")] = "2.0",
    set_: Settings = [],  # noqa: B006
) -> None:
    """The main job: FMUs of both kinds, their validation and a report, into build/NAME/ of the model file NAME.toml."""
    from . import job

    loaded = console.load_with(model, set_)
    if output is not None:
        job.export_one(loaded, output, kind, fmi)
        return
    passed = job.build(loaded, Path("build") / model.stem)
    raise typer.Exit(console.DONE if passed else console.CHECK_FAILED)


def main() -> None:
    """Entry point: no tracebacks for mistakes in the input."""
    with console.mistakes_explained():
        app()
