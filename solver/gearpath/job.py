"""The main job: a model file becomes FMUs, their validation, and a report."""

from __future__ import annotations

from pathlib import Path

from rich.markup import escape

from . import api, console
from .errors import InputError
from .fmu.checks import ValidationReport
from .fmu.conformance import Finding, check_conformance
from .modelfile import Model


def export_one(model: Model, path: Path, kind: str, fmi: str) -> Path:
    """Write one FMU and say so."""
    with console.notes(), console.working(f"exporting {path.name}"):
        api.export_fmu(model, path, fmi=fmi, kind=kind)
    console.out.print(f"wrote {escape(str(path))} ({kind} kind, FMI {fmi}, {path.stat().st_size / 1e3:.0f} kB)")
    return path


def validate_one(path: Path, model: Model, quiet: bool = False) -> ValidationReport:
    """Validate one FMU with progress."""
    with console.progress(f"validating {path.name}", 1.0, quiet) as bar:
        return api.validate_fmu(path, model, message=bar.describe, advance=bar.advance)


def conformance_of(path: Path) -> tuple[Finding, ...]:
    """What the conformance check finds in any FMU; raises InputError where there is no file."""
    if not path.is_file():
        raise InputError(f"{path}: cannot be read (no such file); give the path of an FMU")
    return check_conformance(path)


def build(model: Model, folder: Path) -> bool:
    """Write the FMUs of all kinds and the report into `folder`; whether every check passed."""
    from .report import write_report

    console.out.print(f"model {escape(model.name)}: {_contents(model)}")
    with console.progress("power flow", model.frequency.points) as bar:
        flow = api.power_flow(model, progress=bar.advance)
    residual = abs(flow.dissipated_power.sum("element") / flow.input_power - 1.0).max().item()
    with console.working("natural frequencies"):
        first = ", ".join(f"{f:.1f}" for f in api.natural_frequencies(model)[:6])
    console.out.print(f"natural frequencies {first} ... Hz; power balance holds to {residual:.1g}")
    reports = []
    for ending, kind, fmi in (("", "native", "2.0"), ("-fmi3", "native", "3.0"), ("-python", "python", "2.0")):
        path = export_one(model, folder / f"{folder.name}{ending}.fmu", kind, fmi)
        reports.append(validate_one(path, model))
        console.print_report(reports[-1])
    written = write_report(model, folder / "report.html", validations=reports)
    console.out.print(f"wrote {escape(str(written))}: open it in a browser")
    return all(report.passed for report in reports)


def _contents(model: Model) -> str:
    system = model.system
    kinds: dict[str, int] = {}
    for joint in system.joints.values():
        kinds[joint.kind] = kinds.get(joint.kind, 0) + 1
    joints = ", ".join(f"{count} {kind}{'s' if count > 1 else ''}" for kind, count in kinds.items())
    f = model.frequency
    return f"{len(system.components)} components, {joints}; {f.points} lines from {f.start:g} to {f.stop:g} Hz"
