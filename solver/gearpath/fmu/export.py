"""Export of a system as an FMU of either kind."""

import re
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

from .._version import __version__
from ..errors import InputError
from ..network.assemble import assemble
from ..network.modal import ModalNetwork
from ..network.records import Schedule
from ..network.system import System
from ..numerics.arrays import Real
from ..statespace.reduced import Certificate
from .documentation import BAND
from .native import export_native
from .python_kind import export_python
from .reduction import RECORD, ReductionRequest, record_of, reduced_for
from .scheduled import check_schedule

KINDS = ("native", "python")
VERSIONS = ("2.0", "3.0")
_PURPOSE = "Structure-borne noise power flow"
SOURCELESS = "the python kind has no gear mesh source: [source] is left out; the native kind has it"


def model_identifier(name: str) -> str:
    """A C identifier from the model's name: what is not a letter, digit or underscore becomes an underscore."""
    identifier = re.sub(r"[^A-Za-z0-9_]", "_", name)
    return identifier if re.match(r"[A-Za-z_]", identifier) else f"model_{identifier}"


def export(
    system: System,
    path: Path,
    *,
    fmi: str = "2.0",
    kind: str = "native",
    frequency: float = 1000.0,
    documentation: bool = True,
    band: tuple[float, float] = BAND,
    schedule: Schedule | None = None,
    reduction: ReductionRequest | None = None,
) -> Path:
    """Write the FMU to `path` (a temporary file is moved there at the end) and return the path.

    `frequency` (Hz) is the start value of the input of that name. `documentation` adds plots over the `band`
    (Hz) and reference results to the native kind. With a `schedule` the native kind has the input operation.torque,
    which decides the matrices of its joints; `reduction` makes it smaller. Raises InputError for an unknown kind or
    version of FMI, a schedule or a reduction that cannot be used, and a path that cannot be written.
    """
    if kind not in KINDS:
        raise InputError(f"kind: there is no kind {kind!r} of FMU; use one of: {', '.join(KINDS)}")
    if fmi not in VERSIONS:
        raise InputError(f"fmi: version {fmi!r} is not available; use one of: {', '.join(VERSIONS)}")
    if kind == "python" and fmi != "2.0":
        raise InputError("fmi: pythonfmu makes FMUs of FMI 2.0 only; use the native kind for FMI 3.0")
    if kind == "python" and schedule is not None:
        raise InputError("schedule: the python kind has none; use the native kind for stiffness over the torque")
    if kind == "python" and reduction is not None:
        raise InputError("order, tolerance: the python kind is the whole solver; use the native kind for reduced FMUs")
    check_target(path)
    settings = {
        "model_identifier": model_identifier(system.name),
        "description": f"{_PURPOSE} of {system.name}",
        "frequency": frequency,
        "version": __version__,
    }
    try:
        if kind == "native":
            network = prepared(system, schedule)
            more: dict[str, Any] = {"fmi": fmi, "documentation": documentation, "band": band}
            if reduction is not None:
                reduced = reduced_for(network, reduction)
                network, more = reduced.network, {**more, **_certified(system.name, reduced.certificate)}
            return export_native(network, path, **{**settings, **more})
        if system.source is not None:
            warnings.warn(SOURCELESS, stacklevel=3)
        return export_python(system, path, **settings)  # type: ignore[arg-type]
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror}); choose another place") from error


def export_reduced(
    network: ModalNetwork, certificate: Certificate, path: Path, *, fmi: str = "2.0", documentation: bool = True
) -> Path:
    """Write a network that has been reduced as a native FMU, over the band of its certificate, and return the path.

    Raises InputError as `export`.
    """
    if fmi not in VERSIONS:
        raise InputError(f"fmi: version {fmi!r} is not available; use one of: {', '.join(VERSIONS)}")
    check_target(path)
    settings: dict[str, Any] = {"fmi": fmi, "documentation": documentation, "band": certificate.band}
    try:
        return export_native(
            network,
            path,
            model_identifier=model_identifier(network.name),
            frequency=certificate.band[0],
            version=__version__,
            **settings,
            **_certified(network.name, certificate),
        )
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror}); choose another place") from error


def _certified(name: str, certificate: Certificate) -> dict[str, Any]:
    """What a reduced FMU says of its certificate."""
    return {"description": f"{_PURPOSE} of {name} ({certificate})", "extra_files": {RECORD: record_of(certificate)}}


def check_target(path: Path) -> None:
    """Refuse a path that no FMU can be written to, and make the folder that it lies in."""
    if path.suffix.lower() != ".fmu" and not path.is_dir():
        raise InputError(f"{path}: the name of an FMU ends in .fmu, or importers do not take it")
    if path.is_dir():
        raise InputError(f"{path}: is a folder; give the name of the FMU file to write")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{path.parent}: cannot be made ({error.strerror}); choose another place") from error


def started(system: System, schedule: Schedule | None) -> System:
    """The system whose joints have the matrices that a schedule begins with."""
    if schedule is None:
        return system
    K, C = schedule.at(schedule.first)
    joints = dict(system.joints)
    for name in K.keys() & joints.keys():
        joint = replace(joints[name], stiffness=_rows(K[name]), mounting=None)
        joints[name] = replace(joint, damping=_rows(C[name])) if name in C else joint
    return replace(system, joints=joints)


def prepared(system: System, schedule: Schedule | None) -> ModalNetwork:
    """The network that a native FMU is made of: viscous, in all modes, as the schedule begins.

    Raises:
        InputError: the schedule cannot be followed by this system.
    """
    network = replace(assemble(system).modal(), schedule=schedule)
    if schedule is None:
        return network.viscous()
    check_schedule(network)
    return network.viscous().at_torque(schedule.first)


def _rows(matrix: Real) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(row) for row in (0.5 * (matrix + matrix.T)).tolist())
