"""All checks of one FMU, in order of cost."""

from __future__ import annotations

import tempfile
import zipfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ...components import Measured
from ...errors import GearpathError, InputError, MissingExtraError
from ...network.measured import fit_of
from ...network.modal import ModalNetwork
from ...network.natural import natural_frequencies
from ...network.records import Load, Schedule
from ...network.system import System
from ...network.time_twin import time_twin
from ...numerics.arrays import Real
from ...statespace.reduced import Certificate
from ..binary import scheduled_torques
from ..checks import Check, Comparison, ValidationReport
from ..conformance import Finding, Severity, check_conformance
from ..export import export, prepared, started
from ..native_table import native_table
from ..python_bearings import decided_by_design
from ..reduction import certificate_of, reduced_for, request_of, worst_error
from ..simulation import running
from ..variables import variable_table
from . import chirp, measure, schedule, source, spectrum, tones
from .exchange import exchanged, start_check

Message = Callable[[str], None]
_FREE = 1e-7  # of the highest natural frequency: below, rounding cannot tell it from 0
_LONGEST = 2.5  # s, that the sine test waits for transients to die


@dataclass(frozen=True)
class Limits:
    """What a check may deviate."""

    chirp: float = 1e-10
    spectrum: float = 1e-9
    kinds: float = 1e-9
    schedule: float = 1e-9
    steady: float = 1e-6
    energy: float = 1e-6


def validate(
    path: Path,
    system: System,
    band: tuple[float, float],
    *,
    scheduled: Schedule | None = None,
    message: Message = lambda _: None,
    advance: Callable[[float], None] = lambda _: None,
) -> ValidationReport:
    """Check the FMU at `path` against the model that it was made from, over the band (Hz).

    `scheduled`: the matrices over the torque that the FMU must follow.

    `message` is told what begins, `advance` the part of the whole work that was done. Raises InputError where the
    file is no FMU.
    """
    kind, certificate = kind_of(path), certificate_of(path)
    complete = network = prepared(system, scheduled)
    if certificate is not None:
        message("reduction of the model to the order of the FMU")
        network = reduced_for(complete, request_of(certificate)).network
    system = started(system, scheduled)  # for the other kind, which has no schedule
    if kind == "python":
        network = replace(network, decided=decided_by_design(system))
    message("standard: the rules that validators miss")
    findings = check_conformance(path)
    message("standard: fmpy's validator")
    checks = [standard_check(path), conformance_check(findings)]
    advance(0.05)
    comparisons: list[Comparison] = []
    conforms = not any(finding.severity == Severity.ERROR for finding in findings)
    try:
        checks.append(same_model(path, network, kind, band[0]))
        if checks[-1].passed:
            if certificate is not None:
                checks.append(_reduction_check(complete, network, certificate))
            checks += _physics(path, system, network, kind, band, comparisons, message, advance)
    except MissingExtraError:
        raise
    except Exception as error:
        # of a file that breaks the standard anything can be expected; of another a refused call
        if conforms and not _is_refusal(error):
            raise
        checks.append(Check("running the FMU", np.nan, 0.0, f"stopped: {type(error).__name__}: {error}"))
    # an FMU is that of the fit of what was measured: how good that is stands beside the checks
    notes = {name: str(fit_of(item)) for name, item in system.components.items() if isinstance(item, Measured)}
    return ValidationReport(path, network.name, kind, tuple(checks), tuple(comparisons), notes, findings=findings)


def _is_refusal(error: Exception) -> bool:
    """Whether the FMU refused a call, rather than that we failed."""
    from fmpy.fmi1 import FMICallException

    return isinstance(error, (FMICallException, GearpathError))


def _physics(
    path: Path,
    system: System,
    network: ModalNetwork,
    kind: str,
    band: tuple[float, float],
    comparisons: list[Comparison],
    message: Message,
    advance: Callable[[float], None],
) -> list[Check]:
    """What the FMU computes, against the solver; adds the curves that were compared to `comparisons`."""
    limits, changed = Limits(), exchanged(network)
    with running(path) as fmu:
        checks = [start_check(fmu.description, network)]
        fmu.start(source.silenced(network, kind))
        message("frequency-domain outputs against the power flow")
        checks += spectrum.checks(fmu, network, changed, band, limits.spectrum)
        advance(0.05)
        message("swept sine against python-control")
        signals = chirp.sweep(network, *band)
        compared, found = chirp.checks(
            fmu, network, changed, signals, limits.chirp, lambda n: advance(0.1 * n / chirp.STEPS)
        )
        checks += compared
    if network.source is not None and kind == "native":
        message("gear mesh source against python-control")
        with running(path) as fmu:
            checks += source.checks(fmu, network, network.source, limits.chirp, limits.spectrum)
    if network.schedule is not None:
        message("stiffness over the torque against python-control")
        with running(path) as fmu:
            fmu.start(source.silenced(network, kind))
            checks += schedule.checks(fmu, network, network.schedule, band, limits.spectrum, limits.schedule)
    other = "python" if kind == "native" else "native"
    if certificate_of(path) is None:  # the other kind is never reduced
        message(f"{kind} against {other} kind")
        checks.append(_kinds_check(system, network, band, signals, found, other, limits.kinds))
    advance(0.15)
    if is_free(network):  # it drifts for ever
        message("no sine steady state: the machine is not held to the ground")
        advance(0.65)
        return checks
    message("sine steady state against the mobility synthesis")
    steady, compared_curves = _steady_checks(path, network, band, limits, lambda part: advance(0.65 * part))
    comparisons += compared_curves
    return checks + steady


def is_free(network: ModalNetwork) -> bool:
    """Whether nothing holds the machine, so that it has rigid-body motions of its own."""
    found = natural_frequencies(network)
    return bool(found[0] <= _FREE * found[-1])


def kind_of(path: Path) -> str:
    """ "native" or "python"; raises InputError where the file is not an FMU of Gearpath."""
    try:
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); give the path of an FMU") from error
    except zipfile.BadZipFile as error:
        raise InputError(f"{path}: is not an FMU (not a zip archive); export one with gearpath fmu") from error
    if "modelDescription.xml" not in names:
        raise InputError(f"{path}: is not an FMU (no modelDescription.xml); export one with gearpath fmu")
    return "native" if "resources/model.bin" in names else "python"


def torques_of(path: Path) -> list[float]:
    """Torques (N m) of the schedule that an FMU holds; none where it has none. Raises InputError as `kind_of`."""
    if kind_of(path) != "native":
        return []
    with zipfile.ZipFile(path) as archive:
        try:
            return [float(torque) for torque in scheduled_torques(archive.read("resources/model.bin"))]
        except (InputError, zipfile.BadZipFile):
            return []  # the checks of the file say what is wrong


def _reduction_check(complete: ModalNetwork, network: ModalNetwork, certificate: Certificate) -> Check:
    """The error of the reduction over a fresh grid, against the one that the FMU carries."""
    found = worst_error(complete, network, certificate)
    return Check(
        "reduction against the complete model",
        found,
        certificate.error,
        f"relative error at order {certificate.order} of {certificate.complete}, limit as certified",
    )


def standard_check(path: Path) -> Check:
    """fmpy's validation of the modelDescription: number of problems."""
    try:
        from fmpy.validation import validate_fmu
    except ImportError as error:
        raise MissingExtraError("fmpy", "fmu") from error
    try:
        problems = validate_fmu(str(path))
    except Exception as error:  # of a damaged file
        problems = [f"{type(error).__name__}: {error}"]
    what = "problems found by fmpy's validator" + (": " + "; ".join(map(str, problems)) if problems else "")
    return Check("conformance to FMI, fmpy's validator", float(len(problems)), 0.0, what)


def conformance_check(findings: Sequence[Finding]) -> Check:
    """Number of errors among the findings of the conformance check."""
    errors = sum(finding.severity == Severity.ERROR for finding in findings)
    warnings = sum(finding.severity == Severity.WARNING for finding in findings)
    what = f"errors by Gearpath's own rules, and {warnings} warnings"
    return Check("conformance to FMI, own rules", float(errors), 0.0, what)


def same_model(path: Path, network: ModalNetwork, kind: str, frequency: float) -> Check:
    """Whether the FMU has the variables of this very model: how many it lacks or has besides."""
    import fmpy

    description = fmpy.read_model_description(str(path), validate=False)
    found = {variable.name for variable in description.modelVariables}
    if kind == "native":
        wanted = {variable.name for variable in native_table(network, frequency, description.fmiVersion)}
    else:  # without the source, and with design parameters of its own
        wanted = {variable.name for variable in variable_table(replace(network, source=None), frequency)}
        found &= wanted
    lacking, besides = sorted(wanted - found), sorted(found - wanted)
    words = [
        f"{what} {', '.join(names[:3])}{', ...' if len(names) > 3 else ''}"
        for what, names in (("it lacks", lacking), ("it has, and the model has not,", besides))
        if names
    ]
    told = "; ".join(["variables that differ", *words]) + (": it was exported from another model" if words else "")
    return Check("exported from this model", float(len(lacking) + len(besides)), 0.0, told)


def _kinds_check(
    system: System,
    network: ModalNetwork,
    band: tuple[float, float],
    signals: chirp.Sweep,
    found: dict[str, Real],
    other: str,
    limit: float,
) -> Check:
    """The other kind of FMU, exported from the same model, simulated and compared."""
    steps = 1000
    with tempfile.TemporaryDirectory(prefix="gearpath-") as folder:
        twin = export(system, Path(folder) / "twin.fmu", kind=other, frequency=band[0], documentation=False)
        with running(twin) as fmu:
            fmu.start(source.silenced(network, other))
            histories = chirp.run(fmu, network, signals.part(0, steps))
            expected = {name: values[: steps + 1] for name, values in found.items()}
            moved = measure.largest_deviation(network.outputs, histories, expected, signals.drive)
            ratios = spectrum.deviation(fmu, network, np.geomspace(*band, 10))
    return Check(
        f"agreement with the {other} kind",
        float(np.max([moved, ratios])),
        limit,
        f"all outputs over {steps} steps and the frequency-domain outputs",
    )


def _steady_checks(
    path: Path,
    network: ModalNetwork,
    band: tuple[float, float],
    limits: Limits,
    advance: Callable[[float], None],
) -> tuple[list[Check], list[Comparison]]:
    """Steady state and energy balance; two runs, one with each kind of excitation that the model has."""
    loads = _driven(network)
    poles = np.asarray(np.linalg.eigvals(time_twin(network).A), complex)
    base = tones.base_frequency(*band)
    frequency = tones.tones(*band, poles)
    step = 1.0 / (base * np.ceil(max(40.0 * frequency[-1], 1e5) / base))
    slowest = -float(poles.real.max())
    settle = float(np.clip(18.0 / slowest, 0.5, _LONGEST)) if slowest > 0 else _LONGEST
    settle = step * np.ceil(settle / step)
    total = len(loads) * (settle + 1.0 / base) / step
    outputs = tuple(o.name for o in network.outputs)
    checks: list[Check] = []
    comparisons: list[Comparison] = []
    for load in loads:
        with running(path) as fmu:
            fmu.start(source.silenced(network, kind_of(path)))
            steady = tones.run_tones(fmu, load, frequency, outputs, base, step, settle, lambda n: advance(n / total))
            check, compared = tones.steady_state_check(network, load, steady, fmu.interpolates, limits.steady)
            checks.append(check)
            if load.name == network.excitation:
                comparisons = compared
            if f"{load.name.removesuffix('.force')}.velocity" in outputs:
                checks += tones.energy_checks(network, load, steady, fmu.interpolates, limits.energy)
    return checks, comparisons


def _driven(network: ModalNetwork) -> list[Load]:
    """The excitation of the model, and the force of the first mesh, whose velocity is an output."""
    loads = [load for load in network.loads if load.name == network.excitation]
    velocities = {o.name for o in network.outputs}
    meshes = [load for load in network.loads if load.name.removesuffix(".force") + ".velocity" in velocities]
    return loads + [load for load in meshes[:1] if load not in loads]
