"""Frequency responses as python-control objects."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError, MissingExtraError
from .signals import plain_name, signal_name, signal_names, with_units

try:
    import control
except ImportError as error:
    raise MissingExtraError("python-control", "control") from error

if TYPE_CHECKING:
    import xarray as xr

_DIMENSIONS = ("frequency", "output", "input")


class FrequencyResponse(control.FrequencyResponseData):  # type: ignore[misc]  # python-control has no types
    """H(i omega) at given frequencies, with the names and units of its signals; omega in rad/s."""

    input_units: dict[str, str]
    output_units: dict[str, str]

    def feedback(self, other: Any = 1, sign: float = -1) -> FrequencyResponse:
        """H (I - sign other H)^-1, the loop closed through `other`: negative feedback unless sign is +1.

        python-control's own method takes any sign for -1 (0.10). Inputs and outputs keep their names and units.
        """
        path = np.asarray(other) if isinstance(other, list | tuple) else other
        closed = super().feedback(path if sign == -1 else -sign * path)
        names = {"inputs": self.input_labels, "outputs": self.output_labels}
        return _like(self, closed.frdata, names, f"{self.name}_closed", f"Closed loop around {self.name}")

    def __getitem__(self, key: Any) -> Any:
        """`H["output", "input"]`, or lists of names: a part, with names and units."""
        part = super().__getitem__(key)
        if not isinstance(part, control.FrequencyResponseData):
            return part
        names = {"inputs": part.input_labels, "outputs": part.output_labels}
        return _like(self, part.frdata, names, plain_name(part.name), f"Part of the frequency response of {self.name}")


def _like(
    whole: FrequencyResponse, values: Any, names: dict[str, list[str]], name: str, what: str
) -> FrequencyResponse:
    """Values with some of the signals of `whole`, at its frequencies."""
    made = FrequencyResponse(values, whole.omega, name=name, smooth=whole._ifunc is not None, dt=whole.dt, **names)
    known = whole.input_units, whole.output_units
    units = [[of_whole.get(label, "") for label in labels] for of_whole, labels in zip(known, names.values())]
    with_units(made, f"{what}; omega in rad/s.", *units)
    return made


def to_frd(response: xr.DataArray, *, smooth: bool = False) -> FrequencyResponse:
    """A labelled response (frequency in Hz, output, input) for python-control; see `gearpath.to_frd`."""
    if set(response.dims) != set(_DIMENSIONS):
        raise InputError(
            f"response: its dimensions are {', '.join(map(str, response.dims)) or 'none'} instead of frequency, "
            'output, input; select with lists, as in response.sel(output=["casing.velocity_uy"])'
        )
    ordered = response.transpose(*_DIMENSIONS).sortby("frequency")
    f = ordered.frequency.values.astype(float)
    twice = f[1:][np.diff(f) == 0.0]
    if twice.size:
        raise InputError(f"frequencies: {twice[0]:g} Hz is given more than once; give every frequency once")
    if smooth and f.size < 2:
        raise InputError("smooth: one frequency cannot be interpolated; give several")
    name = str(response.attrs.get("model", "response"))
    made = FrequencyResponse(
        np.moveaxis(ordered.values, 0, -1),
        2.0 * np.pi * f,
        inputs=signal_names([str(label) for label in ordered.input.values]),
        outputs=signal_names([str(label) for label in ordered.output.values]),
        name=signal_name(name),
        smooth=smooth,
        dt=0,
    )
    about = f"Frequency response of {name} at {f.size} frequencies; omega in rad/s."
    with_units(made, about, *(_units(ordered, side) for side in ("input", "output")))
    return made


def _units(response: xr.DataArray, side: str) -> list[str]:
    if f"{side}_unit" not in response.coords:
        return [""] * response.sizes[side]
    return [str(unit) for unit in response.coords[f"{side}_unit"].values]
