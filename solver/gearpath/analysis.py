"""The public functions that compute: a model in, arrays and labelled results out."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from .modelfile import Model
from .network.assemble import assemble
from .network.modal import ModalNetwork
from .network.natural import natural_frequencies as _natural_frequencies
from .network.operation import operating_point as _operating_point
from .network.system import MeshExcitation
from .numerics.arrays import Real

if TYPE_CHECKING:
    import xarray as xr

    from .identification import JointIdentification
    from .joints.bearings import Equilibrium

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


def natural_frequencies(model: Model) -> Real:
    """Undamped natural frequencies of the assembled machine, ascending, Hz; rigid-body modes are 0.

    With plates or frames those up to `frequency.stop` of the model, for which they were reduced.
    """
    network = modal_network(model)
    found = _natural_frequencies(network)
    return found[found <= network.band]


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
