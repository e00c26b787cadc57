"""The public functions that make systems of a model: python-control objects and FMUs, and what is read back of them."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from .analysis import frequency_response, modal_network
from .errors import InputError
from .modelfile import Model
from .network.operation import schedule as _schedule
from .network.records import Schedule

if TYPE_CHECKING:
    import control
    import xarray as xr

    from .fmu.checks import ValidationReport
    from .fmu.linearization import Linearization
    from .statespace.frd import FrequencyResponse
    from .statespace.reduction import ReducedStateSpace


def state_space(model: Model) -> control.StateSpace:
    """The time twin as a `control.StateSpace`: inputs, outputs and states by name, a dot written as a slash.

    Inputs are every mesh's `transmission_error` (m, in a proper realisation) and `force` (N, its inertial
    equivalent), and the actuators; outputs are all linear time-domain outputs of the FMU. Units of all signals are in
    `input_units`, `output_units`, `state_units` (J^0.5: mass-normalised modes) and the object's own docstring.
    """
    from .statespace import state_space as build

    return build(modal_network(_model(model)))


def reduce(
    model: Model,
    order: int | None = None,
    tolerance: float | None = None,
    band: tuple[float, float] | None = None,
    method: str = "rational_krylov",
) -> ReducedStateSpace:
    """A smaller `control.StateSpace` with the signals of `state_space`, and its `certificate`.

    order: second-order coordinates, half as many as states; or tolerance: the relative error that the certificate must
    keep (1e-3 where neither is given). band: Hz, the model's own frequencies where left out. method: "rational_krylov"
    (congruence component by component, stable and passive by construction, joints explicit: `.with_joint`), "modal"
    (free modes, truncated), "craig_bampton" or "balanced" (of the whole machine). The certificate gives `error` (over
    all input-output pairs, the largest deviation in the band relative to the pair's own largest gain), `frequency` (Hz)
    where it occurs, `order`, `stable`, `passive`. Loss factors are replaced by their viscous equivalents. Raises
    InputError for requests that do not fit and for methods that the machine does not allow.
    """
    from .statespace import reduction

    if order is None and tolerance is None:
        tolerance = 1e-3
    times = {name: getattr(joint, "damping_time", None) for name, joint in _model(model).table.joints.items()}
    known = {name: time for name, time in times.items() if time is not None}
    return reduction.reduce(modal_network(model), order, tolerance, _band(model, band), method, known)


def _band(model: Model, band: tuple[float, float] | None) -> tuple[float, float]:
    """The band given, two numbers in Hz, or the model's own."""
    if band is None:
        return model.frequency.start, model.frequency.stop
    try:
        low, high = (float(f) for f in band)
    except (TypeError, ValueError) as error:
        raise InputError(f"band: {band!r} is not a pair of frequencies; give (start, stop) in Hz") from error
    return low, high


def to_frd(
    model: Model | xr.DataArray,
    frequencies_hz: ArrayLike | None = None,
    outputs: str | Iterable[str] | None = None,
    inputs: str | Iterable[str] | None = None,
    *,
    smooth: bool = False,
) -> FrequencyResponse:
    """The exact frequency response as a `control.FrequencyResponseData`: signals by name, a dot written as a slash.

    model: a model, or what `frequency_response` returned. omega is in rad/s and ascending; `input_units` and
    `output_units` as in `state_space`. Loss factors are exact here, whereas `state_space` takes their viscous
    equivalents. `smooth` interpolates between the frequencies by splines, which resonances need many of. Raises
    InputError as `frequency_response` does, and for a frequency that is given twice.
    """
    from .statespace.frd import to_frd as build

    if isinstance(model, Model):
        chosen = _names("outputs", outputs, 1), _names("inputs", inputs, 1)
        return build(frequency_response(model, frequencies_hz, *chosen), smooth=smooth)
    if not (frequencies_hz is None and outputs is None and inputs is None):
        raise InputError("to_frd: a response has its frequencies, outputs and inputs; select from it with .sel instead")
    if not hasattr(model, "coords"):
        raise InputError(f"to_frd: {type(model).__name__} is neither a model nor a response; give one of the two")
    return build(model, smooth=smooth)


def linearize(
    fmu: str | Path,
    *,
    inputs: str | Iterable[str] | None = None,
    outputs: str | Iterable[str] | None = None,
    start_values: Mapping[str, Any] | None = None,
    states: Mapping[str, float] | None = None,
    time: float | None = None,
    method: str = "auto",
    relative_step: float = 0.01,
) -> Linearization:
    """A, B, C, D of any FMU with model exchange (FMI 2.0 and 3.0), as a `control.StateSpace` with names and units.

        x' = dx0 + A (x - x0) + B (u - u0),   y = y0 + C (x - x0) + D (u - u0)

    inputs, outputs: names, all continuous ones where left out (the states where the FMU has no outputs); arrays element
    by element, as `force[2]`. start_values: parameters, inputs and start values of any type. states: values that the
    states are put to after the initialisation. time: s, to which the FMU is then integrated (fmpy's CVode, inputs held,
    events handled); left out, its start time. method: "derivatives" (directional derivatives of the FMU, compared with
    differences in one direction), "differences" (extrapolated, within declared minima and maxima, the first step
    `relative_step` times nominal or value), or "auto": the former where the FMU provides them. Events are handled until
    none is left, so that discrete variables fit the operating point, and stay as they are beside it.

    The result also has `method`, `time`, `x0`, `u0`, `y0`, `dx0`, `error` and `warnings`. Raises InputError for a file
    that is no FMU, one without model exchange or a binary for this machine, unknown names, values that the FMU refuses
    (with its own message) and derivatives that are not finite. The FMU runs in this process.
    """
    from .fmu.linearization import linearize as run

    return run(
        _path(fmu),
        inputs=_names("inputs", inputs),
        outputs=_names("outputs", outputs),
        start_values=_values("start_values", start_values),
        states=_values("states", states),
        time=time,
        method=method,
        relative_step=relative_step,
    )


def export_fmu(
    model: Model | control.StateSpace | control.TransferFunction,
    path: str | Path,
    fmi: str = "2.0",
    kind: str = "native",
    *,
    documentation: bool = True,
    schedule: Sequence[float] | None = None,
    order: int | None = None,
    tolerance: float | None = None,
    band: tuple[float, float] | None = None,
    units: Mapping[str, str] | None = None,
    name: str | None = None,
    description: str | None = None,
    step_size: float | None = None,
) -> Path:
    """Write the model, or a continuous-time python-control system such as a controller, as an FMU; return its path.

    kind "native" runs without Python on every platform; kind "python" holds the whole solver, with the design
    parameters as well, and needs Python with numpy and scipy in the host. `documentation` adds plots of this very model
    and reference results to the native kind. `schedule` are at least two torques (N m), increasing: a native FMU has
    the input `operation.torque`, between whose points the stiffness of the bearings that follow the operation is
    interpolated; the model's own torque is one of them where it lies between. `order` or `tolerance` reduce a native
    FMU as `reduce` does, over the `band` (Hz; left out, the model's frequencies); its joints stay tunable. Raises
    InputError for an unknown kind or version, torques that cannot be used, and a path that cannot be written.

    A python-control system becomes a native FMU with the names of its signals, where a slash becomes a dot
    (`mount_1/force_uy` is `mount_1.force_uy`). Only such a system takes `units` by signal
    ({"mount_1/force_uy": "N"}), another `name`, a `description`, and the `step_size` (s) of the default experiment.
    Raises InputError for a sampled system (dt other than 0), and for a name, number or unit that cannot be used.

    What `reduce` returned becomes the gearbox FMU of these coordinates, with its joints as parameters, like the model
    itself with the same `order` or `tolerance`; after balanced truncation, and of parts of it, a linear system.
    """
    target = _path(path)
    own = {"units": units, "name": name, "description": description, "step_size": step_size}
    others = {"schedule": schedule, "order": order, "tolerance": tolerance, "band": band}
    if not isinstance(model, Model):
        _refuse(others, "Model")
        return _export_system(model, target, fmi, kind, documentation, own)
    _refuse(own, "python-control system")
    from .fmu.export import export
    from .fmu.reduction import ReductionRequest

    wanted = None
    if order is not None or tolerance is not None:
        wanted = ReductionRequest(order, tolerance, _band(model, band))
    elif band is not None:
        raise InputError("band: only a reduced FMU has one; give order or tolerance with it")
    shown = (model.frequency.start, model.frequency.stop)
    return export(
        model.system,
        target,
        fmi=fmi,
        kind=kind,
        frequency=shown[0],
        documentation=documentation,
        band=shown,
        reduction=wanted,
        schedule=None if schedule is None else _scheduled(model, _torques(schedule)),
    )


def _export_system(system: Any, path: Path, fmi: str, kind: str, documentation: bool, settings: dict[str, Any]) -> Path:
    from .fmu.export import export_reduced
    from .fmu.linear_export import export_system
    from .statespace.reduction import ReducedStateSpace

    if kind != "native":
        raise InputError(f"kind: {kind!r} is for a Model; a python-control system becomes a native FMU")
    if isinstance(system, ReducedStateSpace) and system.network is not None:
        _refuse(settings, "controller or another linear system")
        return export_reduced(system.network, system.certificate, path, fmi=fmi, documentation=documentation)
    return export_system(system, path, fmi=fmi, documentation=documentation, **settings)


def _model(model: Any) -> Model:
    if not isinstance(model, Model):
        raise InputError(f"model: {type(model).__name__} is no Model; give what gearpath.load returns")
    return model


def _names(key: str, names: Any, least: int = 0) -> list[str] | None:
    """Names as a list; None, which means all of them, stays."""
    if names is None:
        return None
    found = [names] if isinstance(names, str) else list(names) if isinstance(names, Iterable) else None
    if found is None or len(found) < least:
        raise InputError(f"{key}: {names!r} names none; give one name or several, or leave it out for all")
    return found


def _values(key: str, values: Any) -> dict[str, Any]:
    if values is not None and not isinstance(values, Mapping):
        raise InputError(f'{key}: {values!r} gives no values by name; give them as {{"name": 1.0}}')
    return dict(values or {})


def _refuse(settings: Mapping[str, Any], purpose: str) -> None:
    for key in (key for key, value in settings.items() if value is not None):
        raise InputError(f"{key}: is for a {purpose} only; leave it out")


def _path(path: Any) -> Path:
    try:
        return Path(path)
    except TypeError as error:
        raise InputError(f"path: {path!r} is no path; give the name of a file") from error


def _torques(schedule: Any) -> list[float]:
    try:
        return [float(torque) for torque in schedule]
    except (TypeError, ValueError) as error:
        raise InputError(f"schedule: {schedule!r} are no torques; give two or more numbers in N m") from error


def _scheduled(model: Model, torques: list[float]) -> Schedule:
    """Matrices over the torque, which begin at the model's own."""
    operation = model.system.operation
    if operation is not None and torques and torques[0] < operation.torque < torques[-1]:
        place = bisect_left(torques, operation.torque)  # what is out of order stays so, and is refused
        own = [] if operation.torque in torques else [operation.torque]
        torques = [*torques[:place], *own, *torques[place:]]
    return replace(_schedule(model.system, torques), start=None if operation is None else operation.torque)


def validate_fmu(
    path: str | Path,
    model: Model,
    *,
    message: Callable[[str], None] = lambda _: None,
    advance: Callable[[float], None] = lambda _: None,
) -> ValidationReport:
    """Check an FMU against the model that it was exported from: every check with its figure, and `report.passed`.

    The standard (fmpy's validator), frequency-domain outputs against the power flow, swept sine against
    python-control, sine steady state against the mobility synthesis, energy balance, agreement of both kinds.
    `message` is told what begins and `advance` which part of the work was done. Raises InputError where the file is
    not an FMU.
    """
    from .fmu.validation import torques_of, validate

    frequency, torques = model.frequency, torques_of(Path(path))
    known = len(torques) > 0 and model.system.operation is not None
    return validate(
        Path(path),
        model.system,
        (frequency.start, frequency.stop),
        scheduled=_scheduled(model, torques) if known else None,
        message=message,
        advance=advance,
    )
