"""The public functions: a model in, labelled results, python-control objects and FMUs out."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

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
    from .joints.bearings import Equilibrium

__all__ = [
    "Model",
    "amplitude",
    "expected_power",
    "export_fmu",
    "frequency_response",
    "load",
    "modal_network",
    "natural_frequencies",
    "operating_point",
    "power_flow",
    "power_matrices",
    "state_space",
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
    equivalent), and the actuators; outputs are all linear time-domain outputs of the FMU.
    """
    from .statespace import state_space as build

    return build(modal_network(model))


def natural_frequencies(model: Model) -> Real:
    """Undamped natural frequencies of the assembled machine, ascending, Hz; rigid-body modes are 0.

    With plates or frames those up to `frequency.stop` of the model, for which they were reduced.
    """
    network = modal_network(model)
    found = _natural_frequencies(network)
    return found[found <= network.band]


def export_fmu(
    model: Model,
    path: str | Path,
    fmi: str = "2.0",
    kind: str = "native",
    *,
    documentation: bool = True,
    schedule: Sequence[float] | None = None,
) -> Path:
    """Write the model as an FMU and return its path.

    kind "native" runs without Python on every platform; kind "python" holds the whole solver, with the design
    parameters as well, and needs Python with numpy and scipy in the host. `documentation` adds plots of this very model
    and reference results to the native kind. `schedule` are at least two torques (N m), increasing: a native FMU has
    the input `operation.torque`, between whose points the stiffness of the bearings that follow the operation is
    interpolated; the model's own torque is one of them where it lies between. Raises InputError for an unknown kind or
    version, torques that cannot be used, and a path that cannot be written.
    """
    from .fmu.export import export

    band = (model.frequency.start, model.frequency.stop)
    return export(
        model.system,
        Path(path),
        fmi=fmi,
        kind=kind,
        frequency=band[0],
        documentation=documentation,
        band=band,
        schedule=None if schedule is None else _scheduled(model, [float(torque) for torque in schedule]),
    )


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
