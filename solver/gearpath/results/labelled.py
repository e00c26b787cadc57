"""Power flow and frequency responses with names and units (xarray)."""

from collections.abc import Callable, Iterable

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..components.dofs import force_unit, motion_unit
from ..errors import InputError
from ..network.modal import ModalNetwork
from ..network.power import PowerFlow, is_moment_path, power_flow
from ..network.records import Load, Output
from ..network.response import frequency_response
from .names import chosen

Progress = Callable[[int], None]


def checked_frequencies(
    frequencies_hz: ArrayLike, network: ModalNetwork
) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Frequencies (Hz) as a one-dimensional array.

    Raises InputError unless all are finite and positive, not above the band that the network was reduced for, and
    within that of every measured component.
    """
    try:
        f = np.atleast_1d(np.asarray(frequencies_hz, dtype=float))
    except (TypeError, ValueError) as error:
        raise InputError(f"frequencies: {frequencies_hz!r} are not numbers; give them in Hz") from error
    if f.ndim != 1 or not f.size:
        raise InputError(f"frequencies: shape {f.shape} is not a list of frequencies; give one dimension, in Hz")
    wrong = f[~(np.isfinite(f) & (f > 0.0))]
    if wrong.size:
        raise InputError(f"frequencies: {wrong[0]:g} Hz is not allowed; mobilities need finite, positive frequencies")
    if f.max() > network.band * (1.0 + 1e-9):
        raise InputError(
            f"frequencies: {f.max():g} Hz is above {network.band:g} Hz, up to which plates and frames of this model "
            "were reduced; raise frequency.stop of the model"
        )
    for name, component in network.measured.items():
        low, high = component.band
        off = f[(f < low * (1.0 - 1e-9)) | (f > high * (1.0 + 1e-9))]
        if off.size:
            raise InputError(
                f"frequencies: {off[0]:g} Hz is outside {low:g} to {high:g} Hz, where {name} was measured; stay within"
            )
    return f


def labelled_power_flow(
    network: ModalNetwork, frequencies_hz: ArrayLike, amplitude: float, progress: Progress = lambda _: None
) -> xr.Dataset:
    """Power flow as a Dataset over `frequency` (Hz), `path` and `element`; see `gearpath.power_flow`."""
    f = checked_frequencies(frequencies_hz, network)
    flow = power_flow(network, 2.0 * np.pi * f, amplitude, progress)
    return _dataset(network, f, flow, amplitude)


def _dataset(network: ModalNetwork, f: ArrayLike, flow: PowerFlow, amplitude: float) -> xr.Dataset:
    dofs = [path.rsplit(".", 1)[1] for path in flow.paths]
    transmitted = flow.transmitted_power
    alpha_path = np.divide(
        flow.path_power, flow.input_power, out=flow.path_power, where=flow.input_power != 0.0
    )  # in place: the powers are not needed again
    alpha_path[:, flow.input_power == 0.0] = 0.0
    moment = np.array([is_moment_path(path) for path in flow.paths], bool)
    alpha = alpha_path.sum(axis=0)
    ratios = {"units": "1"}
    lines, paths = ("frequency",), ("path", "frequency")
    load = next(item for item in network.loads if item.name == network.excitation)
    return xr.Dataset(
        {
            "input_power": (lines, flow.input_power, {"units": "W", "long_name": "input power, time average"}),
            "transmitted_power": (
                lines,
                transmitted,
                {"units": "W", "long_name": "net power through all paths into the receivers, time average"},
            ),
            "alpha": (lines, alpha, {**ratios, "long_name": "power ratio, transmitted to input (Eq. 5a)"}),
            "alpha_force": (
                lines,
                alpha_path[~moment].sum(axis=0),
                {**ratios, "long_name": "power ratio of the force paths"},
            ),
            "alpha_moment": (
                lines,
                alpha_path[moment].sum(axis=0),
                {**ratios, "long_name": "power ratio of the moment paths"},
            ),
            "dissipated_power": (
                ("element", "frequency"),
                flow.dissipated_power,
                {"units": "W", "long_name": "power dissipated in each component and joint"},
            ),
            "path_alpha": (paths, alpha_path, {**ratios, "long_name": "power ratio of each path"}),
            "force": (paths, flow.force, {"units": "N or N m", "long_name": "force on the receiver, phasor"}),
            "velocity_source": (
                paths,
                flow.velocity_source,
                {"units": "m/s or rad/s", "long_name": "velocity on the source side, phasor"},
            ),
            "velocity_receiver": (
                paths,
                flow.velocity_receiver,
                {"units": "m/s or rad/s", "long_name": "velocity on the receiver side, phasor"},
            ),
        },
        coords={
            "frequency": (lines, f, {"units": "Hz"}),
            "path": list(flow.paths),
            "element": list(flow.elements),
            "force_unit": ("path", [force_unit(dof) for dof in dofs]),
            "velocity_unit": ("path", [motion_unit(dof, 1) for dof in dofs]),
        },
        attrs={
            "model": network.name,
            "excitation": network.excitation,
            "amplitude": amplitude,
            "amplitude_unit": load.unit,
            "convention": "phasors e^{+i w t}, peak amplitudes, P = 1/2 Re(v^H F), positive into the receiver",
        },
    )


def labelled_response(
    network: ModalNetwork,
    frequencies_hz: ArrayLike,
    outputs: str | Iterable[str] | None = None,
    inputs: str | Iterable[str] | None = None,
    progress: Progress = lambda _: None,
) -> xr.DataArray:
    """Frequency responses as a DataArray (frequency, output, input); see `gearpath.frequency_response`."""
    f = checked_frequencies(frequencies_hz, network)
    linear = tuple(o for o in network.outputs if o.quantity != "power")
    rows: tuple[Output, ...] = chosen("output", outputs, linear, {o.name for o in network.outputs})
    loads: tuple[Load, ...] = chosen("input", inputs, network.loads)
    H = frequency_response(network, 2.0 * np.pi * f, rows, loads, progress)
    return xr.DataArray(
        H,
        dims=("frequency", "output", "input"),
        coords={
            "frequency": ("frequency", f, {"units": "Hz"}),
            "output": [row.name for row in rows],
            "input": [load.name for load in loads],
            "output_unit": ("output", [row.unit for row in rows]),
            "input_unit": ("input", [load.unit for load in loads]),
        },
        name="frequency_response",
        attrs={"model": network.name, "units": "output unit per input unit, SI", "convention": "e^{+i w t}"},
    )
