"""Export of a linear system, such as a controller, as a native FMU: the same runtime, matrices in place of modes."""

from collections.abc import Mapping
from numbers import Real as Number
from pathlib import Path
from typing import Any

from .._version import __version__
from ..errors import InputError
from .description import Experiment
from .export import VERSIONS, check_target, model_identifier
from .icon import icon_png, icon_svg
from .linear_binary import linear_payload
from .linear_page import linear_page
from .linear_reference import linear_reference
from .linear_system import LinearSystem, from_control
from .linear_table import linear_table
from .native import check_arguments, core_files
from .package import write_fmu

STEP = 1e-5  # s, of the default experiment, as of a machine that a controller runs with
_STEPS = 10_000  # of the default experiment


def export_system(
    system: Any,
    path: Path,
    *,
    fmi: str = "2.0",
    documentation: bool = True,
    units: Mapping[str, str] | None = None,
    name: str | None = None,
    description: str | None = None,
    step_size: float | None = None,
) -> Path:
    """Write a python-control StateSpace or TransferFunction as an FMU to `path`; see `gearpath.export_fmu`."""
    if fmi not in VERSIONS:
        raise InputError(f"fmi: version {fmi!r} is not available; use one of: {', '.join(VERSIONS)}")
    for key, text in (("name", name), ("description", description)):
        if text is not None and not isinstance(text, str):
            raise InputError(f"{key}: {text!r} is no text; give it in quotes")
    if units is not None and not isinstance(units, Mapping):
        raise InputError(f'units: {units!r} gives no units by name; give them as {{"mount_1/force_uy": "N"}}')
    if step_size is not None and (isinstance(step_size, bool) or not isinstance(step_size, Number)):
        raise InputError(f"step_size: {step_size!r} is not a number; give seconds")
    found = from_control(system, name, units)
    check_target(path)
    step = STEP if step_size is None else float(step_size)
    text = f"Linear system {found.name}" if description is None else description
    try:
        return export_linear(found, path, fmi=fmi, description=text, step_size=step, documentation=documentation)
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror}); choose another place") from error


def export_linear(
    system: LinearSystem,
    path: Path,
    *,
    fmi: str = "2.0",
    description: str = "",
    step_size: float = STEP,
    version: str = __version__,
    documentation: bool = True,
) -> Path:
    """Write the FMU of `system` to `path`, model exchange and co-simulation, for all platforms; return the path.

    `step_size` (s) is that of the default experiment. `documentation` adds plots and reference results. The same
    arguments give the same bytes.

    Raises:
        InputError: a name, a number or the step size cannot be used.
        GearpathError: the compiled runtime is missing.
    """
    identifier, stop = model_identifier(system.name), _STEPS * step_size
    check_arguments(identifier, 0.0, stop, step_size)
    experiment = Experiment(0.0, float(f"{stop:.12g}"), step_size)
    variables = linear_table(system, fmi)
    files = core_files(
        variables,
        linear_payload(system, variables),
        fmi,
        name=system.name,
        model_identifier=identifier,
        description=description,
        version=version,
        experiment=experiment,
    )
    files["documentation/index.html"] = linear_page(
        system,
        variables,
        fmi=fmi,
        description=description,
        version=version,
        experiment=experiment,
        plots=documentation,
    )
    files |= {"terminalsAndIcons/icon.png": icon_png(), "terminalsAndIcons/icon.svg": icon_svg()}
    if fmi == "2.0":
        files["model.png"] = icon_png()
    return write_fmu(path, {**files, **(linear_reference(system, experiment) if documentation else {})})
