"""The public functions: a model in, labelled results, python-control objects and FMUs out."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from .errors import InputError
from .fitting import fit_mobility
from .modelfile import Model, load
from .network.assemble import assemble
from .network.modal import ModalNetwork
from .network.natural import natural_frequencies as _natural_frequencies
from .network.operation import operating_point as _operating_point
from .network.operation import schedule as _schedule
from .network.records import Schedule
from .network.system import MeshExcitation
from .numerics.arrays import Real

if TYPE_CHECKING:
    import control
    import xarray as xr

    from .fmu.checks import ValidationReport
    from .fmu.linearization import Linearization
    from .identification import JointIdentification
    from .joints.bearings import Equilibrium
    from .statespace.frd import FrequencyResponse
    from .statespace.reduction import ReducedStateSpace

__all__ = [
    "Model",
    "amplitude",
    "expected_power",
    "export_fmu",
    "fit_mobility",
    "frequency_response",
    "identify_joint",
    "linearize",
    "load",
    "measure_joint",
    "modal_network",
    "natural_frequencies",
    "operating_point",
    "power_flow",
    "power_matrices",
    "reduce",
    "state_space",
    "to_frd",
    "torque_sweep",
    "validate_fmu",
]

Progress = Callable[[int], None]


def modal_network(model: Model) -> ModalNetwork:
    """The model's components in all their free-free modes, and the joints between them."""
    return assemble(model.system).modal()


def amplitude(model: Model) -> float:
    """Amplitude of the model's excitation: m of transmission error, or N or N m."""
    excitation = model.system.excitation
    return excitation.displacement if isinstance(excitation, MeshExcitation) else excitation.force


def power_flow(
    model: Model, frequencies_hz: ArrayLike | None = None, *, progress: Progress = lambda _: None
) -> xr.Dataset:
    """Structure-borne noise power flow through all bearings (Eq. 1 to 5), time averages.

    Over `frequency` (Hz; default: the model's own grid): `input_power`, `transmitted_power` (W), the ratios `alpha`,
    `alpha_force`, `alpha_moment`, and `dissipated_power` by `element`; over `path` (joint and degree of freedom)
    `path_alpha`, `force` (acts on the receiver), `velocity_source`, `velocity_receiver`. Raises InputError for
    frequencies that are not finite and positive.
    """
    from .results.labelled import labelled_power_flow

    f = model.frequencies() if frequencies_hz is None else frequencies_hz
    return labelled_power_flow(modal_network(model), f, amplitude(model), progress)


def frequency_response(
    model: Model,
    frequencies_hz: ArrayLike | None = None,
    outputs: str | Iterable[str] | None = None,
    inputs: str | Iterable[str] | None = None,
) -> xr.DataArray:
    """Complex responses (frequency, output, input) in SI units, by the names of the FMU variables.

    None stands for all linear outputs and all inputs. Raises InputError for a name that does not exist, with the
    closest one that does.
    """
    from .results.labelled import labelled_response

    f = model.frequencies() if frequencies_hz is None else frequencies_hz
    return labelled_response(modal_network(model), f, outputs, inputs)


def expected_power(
    model: Model,
    inputs: str | Iterable[str],
    spectrum: ArrayLike,
    frequencies_hz: ArrayLike | None = None,
    *,
    progress: Progress = lambda _: None,
) -> xr.Dataset:
    """Expected powers of several excitations at once, correlated or not (Eq. 5 with Q matrices, E[P] = tr(Q S)).

    `inputs` are n input names (mesh.transmission_error, mesh.force, actuators.NAME); `spectrum` is their
    cross-spectral matrix S = E[F F^H] of peak phasors in SI units of the inputs (for one-sided mean-square densities G
    give S = 2 G and read powers per Hz): (n, n) or (lines, n, n), Hermitian and positive semidefinite, or (n,) or
    (lines, n) for uncorrelated inputs. Returns `input_power`, `transmitted_power`, `alpha`, `alpha_force`,
    `alpha_moment`, `path_alpha`, `dissipated_power`, named as in `power_flow`. Raises InputError for what does not fit.
    """
    from .results.expected import labelled_expected_power

    f = model.frequencies() if frequencies_hz is None else frequencies_hz
    return labelled_expected_power(modal_network(model), f, inputs, spectrum, progress)


def power_matrices(
    model: Model,
    frequencies_hz: ArrayLike | None = None,
    inputs: str | Iterable[str] | None = None,
    *,
    progress: Progress = lambda _: None,
) -> xr.Dataset:
    """Hermitian power matrices Q of Eq. 5b and 5c: P = F^H Q F of the peak phasors F of all chosen inputs.

    `input_power` over (frequency, input, input_2), `path_power` also over `path`, `dissipated_power` over `element`.
    """
    from .results.expected import labelled_power_matrices

    f = model.frequencies() if frequencies_hz is None else frequencies_hz
    return labelled_power_matrices(modal_network(model), f, inputs, progress)


def operating_point(model: Model) -> dict[str, Equilibrium]:
    """State of every rolling bearing that the model gives by geometry or catalogue, by the joint's name.

    Displacement of the inner ring (6,), the load that it carries (6,), stiffness (6, 6), loads and contact angles of
    the rolling elements, linear solves and residual, notes where the theory stops; SI units, on ux to rz.
    With `[operation]` from the static equilibrium of the whole machine. Raises ModelError for a load that the bearings
    cannot carry.
    """
    return _operating_point(model.system)


def torque_sweep(
    model: Model,
    torques: ArrayLike,
    frequencies_hz: ArrayLike | None = None,
    *,
    progress: Progress = lambda _: None,
) -> xr.Dataset:
    """Power flow over the torque through the gears: alpha(torque, frequency).

    At each torque (N m, on the shaft of `[operation]`) every bearing given by geometry or catalogue has the stiffness
    of its operating point. `alpha`, `alpha_force`, `alpha_moment`, `input_power`, `transmitted_power` (W) over `torque`
    and `frequency`, `path_alpha` also over `path`, and `stiffness.JOINT` over `torque`, `dof`, `dof_2`. Raises
    InputError for a model without operation and for torques that the bearings cannot carry.
    """
    from .results.torque import labelled_torque_sweep

    f = model.frequencies() if frequencies_hz is None else frequencies_hz
    return labelled_torque_sweep(model.system, torques, f, amplitude(model), progress)


def state_space(model: Model) -> control.StateSpace:
    """The time twin as a `control.StateSpace`: inputs, outputs and states by name, a dot written as a slash.

    Inputs are every mesh's `transmission_error` (m, in a proper realisation) and `force` (N, its inertial
    equivalent), and the actuators; outputs are all linear time-domain outputs of the FMU. Units of all signals are in
    `input_units`, `output_units`, `state_units` (J^0.5: mass-normalised modes) and the object's own docstring.
    """
    from .statespace import state_space as build

    return build(modal_network(model))


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
    return reduction.reduce(modal_network(model), order, tolerance, _band(model, band), method)


def _band(model: Model, band: tuple[float, float] | None) -> tuple[float, float]:
    """The band given, two numbers in Hz, or the model's own."""
    if band is None:
        return model.frequency.start, model.frequency.stop
    try:
        low, high = (float(f) for f in band)
    except (TypeError, ValueError) as error:
        raise InputError(f"band: {band!r} is not a pair of frequencies; give (start, stop) in Hz") from error
    return low, high


def measure_joint(
    model: Model,
    frequencies_hz: ArrayLike | None = None,
    joints: str | Iterable[str] | None = None,
    *,
    noise: float = 0.0,
    seed: int | None = None,
    connected: bool = True,
) -> xr.DataArray:
    """Mobilities that a measurement on both sides of joints would give, (frequency, motion, force), SI.

    Ports are named bearing_1.source.uy, bearing_1.receiver.uy ...; joints: all power flow paths where left out. noise:
    sqrt(E|e|^2) / |Y_ij| of independent circular complex Gaussian noise on every entry, from the random `seed`.
    connected: False takes the joints out of the machine, for `without` of `identify_joint`. Raises InputError for
    joints that do not exist or stand on the ground.
    """
    from .results.identified import labelled_measurement

    f = model.frequencies() if frequencies_hz is None else frequencies_hz
    return labelled_measurement(modal_network(model), f, joints, noise, seed, connected)


def identify_joint(
    mobility: ArrayLike | xr.DataArray,
    frequencies_hz: ArrayLike | None = None,
    joints: Mapping[str, Sequence[str]] | None = None,
    *,
    noise: ArrayLike | None = None,
    without: ArrayLike | xr.DataArray | None = None,
) -> JointIdentification:
    """K and C of joints in situ, from mobilities of the assembled machine on both sides, with confidence intervals.

    mobility: (F, 2 n, 2 n), velocity by force, e^(+i w t): the source sides of all joints that connect the two parts,
    then their receiver sides; or with names, as `measure_joint` gives it. joints: name -> degrees of freedom, n in
    all. Nothing is known of the two parts, which may be rigid: K and C minimise the adjustment of the mobilities, in
    parts of their noise, that makes

        rank [[I + Z Y_ba, Z Y_bb], [Y_aa, Y_ab]] = n,   Z = K / (i w) + C  block-diagonal, K and C symmetric

    noise: relative noise sqrt(E|e|^2) / |Y_ij| of one FRF, or standard deviations (F, 2 n, 2 n); left out, it is found
    from the data. without: mobilities at the same ports with these joints taken out, from a model or another
    measurement: then they alone are needed, whatever else connects the parts. Raises InputError for data that cannot
    be mobilities on both sides, and AccuracyError where noise hides the joints. See docs/identification.md.
    """
    from .results.identified import identified

    return identified(mobility, frequencies_hz, joints, noise, without)


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
        return build(frequency_response(model, frequencies_hz, outputs, inputs), smooth=smooth)
    if not (frequencies_hz is None and outputs is None and inputs is None):
        raise InputError("to_frd: a response has its frequencies, outputs and inputs; select from it with .sel instead")
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
        Path(fmu),
        inputs=inputs,
        outputs=outputs,
        start_values=start_values or {},
        states=states or {},
        time=time,
        method=method,
        relative_step=relative_step,
    )


def natural_frequencies(model: Model) -> Real:
    """Undamped natural frequencies of the assembled machine, ascending, Hz; rigid-body modes are 0.

    With plates or frames those up to `frequency.stop` of the model, for which they were reduced.
    """
    network = modal_network(model)
    found = _natural_frequencies(network)
    return found[found <= network.band]


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
    """
    own = {"units": units, "name": name, "description": description, "step_size": step_size}
    others = {"schedule": schedule, "order": order, "tolerance": tolerance, "band": band}
    is_model = isinstance(model, Model)
    for key in (key for key, value in (own if is_model else others).items() if value is not None):
        raise InputError(f"{key}: is for a {'python-control system' if is_model else 'Model'} only; leave it out")
    if not isinstance(model, Model):
        return _export_system(model, Path(path), fmi, kind, documentation, own)
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
        Path(path),
        fmi=fmi,
        kind=kind,
        frequency=shown[0],
        documentation=documentation,
        band=shown,
        reduction=wanted,
        schedule=None if schedule is None else _scheduled(model, [float(torque) for torque in schedule]),
    )


def _export_system(system: Any, path: Path, fmi: str, kind: str, documentation: bool, settings: dict[str, Any]) -> Path:
    from .fmu.linear_export import export_system

    if kind != "native":
        raise InputError(f"kind: {kind!r} is for a Model; a python-control system becomes a native FMU")
    return export_system(system, path, fmi=fmi, documentation=documentation, **settings)


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
