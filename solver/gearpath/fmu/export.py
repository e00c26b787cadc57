"""Export of a system as an FMU of either kind."""

import re
import warnings
from pathlib import Path

from .._version import __version__
from ..errors import InputError
from ..network.assemble import assemble
from ..network.system import System
from .documentation import BAND
from .native import export_native
from .python_kind import export_python

KINDS = ("native", "python")
VERSIONS = ("2.0", "3.0")
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
) -> Path:
    """Write the FMU to `path` (a temporary file is moved there at the end) and return the path.

    `frequency` (Hz) is the start value of the input of that name. `documentation` adds plots over the `band`
    (Hz) and reference results to the native kind. Raises InputError for an unknown kind or version of FMI and for a
    path that cannot be written.
    """
    if kind not in KINDS:
        raise InputError(f"kind: there is no kind {kind!r} of FMU; use one of: {', '.join(KINDS)}")
    if fmi not in VERSIONS:
        raise InputError(f"fmi: version {fmi!r} is not available; use one of: {', '.join(VERSIONS)}")
    if kind == "python" and fmi != "2.0":
        raise InputError("fmi: pythonfmu makes FMUs of FMI 2.0 only; use the native kind for FMI 3.0")
    if path.suffix.lower() != ".fmu" and not path.is_dir():
        raise InputError(f"{path}: the name of an FMU ends in .fmu, or importers do not take it")
    if path.is_dir():
        raise InputError(f"{path}: is a folder; give the name of the FMU file to write")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{path.parent}: cannot be made ({error.strerror}); choose another place") from error
    settings = {
        "model_identifier": model_identifier(system.name),
        "description": f"Structure-borne noise power flow of {system.name}",
        "frequency": frequency,
        "version": __version__,
    }
    try:
        if kind == "native":
            network = assemble(system).modal().viscous()
            more = {"fmi": fmi, "documentation": documentation, "band": band}
            return export_native(network, path, **settings, **more)  # type: ignore[arg-type]
        if system.source is not None:
            warnings.warn(SOURCELESS, stacklevel=3)
        return export_python(system, path, **settings)  # type: ignore[arg-type]
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror}); choose another place") from error
