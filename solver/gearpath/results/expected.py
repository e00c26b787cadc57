"""Expected powers and power matrices of several excitations with names and units (xarray)."""

from collections.abc import Callable, Iterable

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..errors import InputError
from ..network.excitations import PowerMatrices, checked_spectrum, expected, power_matrices
from ..network.modal import ModalNetwork
from ..network.power import is_moment_path, ratio
from ..numerics.arrays import Real
from .labelled import checked_frequencies
from .names import chosen

Progress = Callable[[int], None]
_RATIO = {"units": "1"}


def labelled_power_matrices(
    network: ModalNetwork,
    frequencies_hz: ArrayLike,
    inputs: str | Iterable[str] | None = None,
    progress: Progress = lambda _: None,
) -> xr.Dataset:
    """Q of Eq. 5 over `frequency`, `input` and `input_2`, see `gearpath.power_matrices`."""
    f, Q = _solved(network, frequencies_hz, inputs, progress)
    names = [load.name for load in Q.loads]
    pair = ("frequency", "input", "input_2")
    watts = {"units": "W per unit of both inputs"}
    return xr.Dataset(
        {
            "input_power": (pair, Q.input, {**watts, "long_name": "Q_e, input power"}),
            "path_power": (("path", *pair), Q.path, {**watts, "long_name": "Q_p, power into the receiver"}),
            "dissipated_power": (("element", *pair), Q.dissipated, {**watts, "long_name": "dissipated power"}),
        },
        coords={
            **_coordinates(f, Q),
            "input": names,
            "input_2": names,
            "input_unit": ("input", [load.unit for load in Q.loads]),
        },
        attrs={"model": network.name, "convention": "P = F^H Q F of peak phasors F; E[P] = tr(Q S), S = E[F F^H]"},
    )


def labelled_expected_power(
    network: ModalNetwork,
    frequencies_hz: ArrayLike,
    inputs: str | Iterable[str],
    spectrum: ArrayLike,
    progress: Progress = lambda _: None,
) -> xr.Dataset:
    """Powers of correlated excitations over `frequency`, `path` and `element`, see `gearpath.expected_power`."""
    f = checked_frequencies(frequencies_hz, network)
    loads = chosen("input", inputs, network.loads)
    S = checked_spectrum(spectrum, [load.name for load in loads], len(f))
    f, Q = _solved(network, f, [load.name for load in loads], progress)
    entering, path, lost = expected(Q.input, S), expected(Q.path, S), expected(Q.dissipated, S)
    moment = np.array([is_moment_path(name) for name in Q.paths], bool)
    share = np.array([ratio(row, entering) for row in path]).reshape(path.shape)
    lines = ("frequency",)
    return xr.Dataset(
        {
            "input_power": (lines, entering, {"units": "W", "long_name": "expected input power"}),
            "transmitted_power": (
                lines,
                path.sum(axis=0),
                {"units": "W", "long_name": "expected net power of all paths"},
            ),
            "alpha": (lines, share.sum(axis=0), {**_RATIO, "long_name": "expected power ratio (Eq. 5a)"}),
            "alpha_force": (lines, share[~moment].sum(axis=0), {**_RATIO, "long_name": "ratio of the force paths"}),
            "alpha_moment": (lines, share[moment].sum(axis=0), {**_RATIO, "long_name": "ratio of the moment paths"}),
            "path_alpha": (("path", "frequency"), share, {**_RATIO, "long_name": "power ratio of each path"}),
            "dissipated_power": (
                ("element", "frequency"),
                lost,
                {"units": "W", "long_name": "expected dissipated power"},
            ),
        },
        coords=_coordinates(f, Q),
        attrs={
            "model": network.name,
            "excitation": ", ".join(load.name for load in loads),
            "convention": "S = E[F F^H] of peak phasors, powers are expected values, positive into the receiver",
        },
    )


def _solved(
    network: ModalNetwork, frequencies_hz: ArrayLike, inputs: str | Iterable[str] | None, progress: Progress
) -> tuple[Real, PowerMatrices]:
    f = checked_frequencies(frequencies_hz, network)
    loads = chosen("input", inputs, network.loads)
    if not loads:
        raise InputError("inputs: there is none; name at least one input, such as 'mesh.transmission_error'")
    if len({load.name for load in loads}) < len(loads):
        raise InputError("inputs: one is named twice; name each once and put its power in the spectrum")
    return f, power_matrices(network, 2.0 * np.pi * f, loads, progress)


def _coordinates(f: Real, Q: PowerMatrices) -> dict[str, object]:
    return {"frequency": (("frequency",), f, {"units": "Hz"}), "path": list(Q.paths), "element": list(Q.elements)}
