"""Everything the report shows, computed once from the model."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..network.assemble import assemble
from ..network.modal import ModalNetwork
from ..network.natural import natural_frequencies
from ..network.power import is_moment_path
from ..network.system import MeshExcitation, System
from ..numerics.arrays import Real
from ..results.labelled import labelled_power_flow

if TYPE_CHECKING:
    import xarray as xr

    from ..modelfile import Model

NOISE = 1e-13  # parts below this fraction of the sum of absolute path powers are rounding, and zero
NOTHING = 1e-9  # and so are parts that nowhere in the band reach this fraction


@dataclass(frozen=True)
class Results:
    """Power flow of a model and what it follows from; F lines, p paths, e elements."""

    system: System
    network: ModalNetwork
    amplitude: float  # of the excitation, m, N or N m
    amplitude_unit: str
    frequency: Real  # (F,), Hz
    paths: tuple[str, ...]  # "bearing_1.uy"
    elements: tuple[str, ...]
    input_power: Real  # (F,), W
    path_power: Real  # (p, F), W, positive into the receiver, rounding noise set to zero
    dissipated_power: Real  # (e, F), W
    alpha: Real  # (F,), ratios to the input power, rounding noise set to zero in the parts
    alpha_force: Real
    alpha_moment: Real
    path_alpha: Real  # (p, F)
    natural: Real  # assembled, Hz, ascending
    natural_alpha: Real  # alpha at the natural frequencies within the band, (as many as `natural_in_band`,)
    free: Mapping[str, Real]  # component -> its free-free natural frequencies, Hz

    @property
    def bearings(self) -> tuple[str, ...]:
        """Joints that count as paths."""
        return self.network.paths

    @property
    def natural_in_band(self) -> Real:
        """Natural frequencies of the assembly within the band of the power flow, Hz, rigid-body modes left out."""
        return _within(self.natural, self.frequency)

    @property
    def moment(self) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """Which paths carry moments, (p,)."""
        return np.array([is_moment_path(path) for path in self.paths], bool)

    def of_bearing(self, bearing: str) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """Which paths belong to a bearing, (p,)."""
        return np.array([path.rsplit(".", 1)[0] == bearing for path in self.paths], bool)

    @property
    def residual(self) -> Real:
        """|input - sum of dissipated| / input power, (F,); 0 where no power enters."""
        return _ratio(abs(self.input_power - self.dissipated_power.sum(axis=0)), abs(self.input_power))


def compute(model: Model, progress: Callable[[str], None] = lambda _: None) -> Results:
    """Power flow on the model's own grid, its parts without rounding noise, natural frequencies."""
    network = assemble(model.system).modal()
    f = np.asarray(model.frequencies(), float)
    amplitude = _amplitude(model.system)
    progress(f"report: power flow at {len(f)} frequencies")
    flow = labelled_power_flow(network, f, amplitude)
    progress("report: natural frequencies")
    natural = natural_frequencies(network)
    inside = _within(natural, f)
    at_natural = labelled_power_flow(network, inside, amplitude)["alpha"].values if len(inside) else inside
    path_alpha, force, moment = parts(flow)
    return Results(
        system=model.system,
        network=network,
        amplitude=amplitude,
        amplitude_unit=str(flow.attrs["amplitude_unit"]),
        frequency=f,
        paths=tuple(str(path) for path in flow["path"].values),
        elements=tuple(str(element) for element in flow["element"].values),
        input_power=flow["input_power"].values,
        path_power=path_alpha * flow["input_power"].values,
        dissipated_power=flow["dissipated_power"].values,
        alpha=flow["alpha"].values,
        alpha_force=force,
        alpha_moment=moment,
        path_alpha=path_alpha,
        natural=natural,
        natural_alpha=at_natural,
        free={name: np.sqrt(network.eigenvalues[block]) / (2.0 * np.pi) for name, block in network.components.items()},
    )


def parts(flow: xr.Dataset) -> tuple[Real, Real, Real]:
    """Path ratios (p, F), force part and moment part (F,), rounding noise set to zero.

    A part below 1e-13 of the sum of the absolute path ratios is rounding, and so is one that nowhere in the band
    reaches 1e-9 of it: what is left of a path that carries nothing, because the machine is symmetric for example.
    """
    paths = np.array(flow["path_alpha"].values)
    whole = abs(paths).sum(axis=0)
    moment = np.array([is_moment_path(str(path)) for path in flow["path"].values], bool)

    def clean(part: Real) -> Real:
        size = abs(part)
        carries = (size > NOTHING * whole).any(axis=-1, keepdims=True)
        return np.asarray(np.where(carries & (size >= NOISE * whole), part, 0.0))

    force, tilt = (clean(paths[chosen].sum(axis=0)) for chosen in (~moment, moment))
    return clean(paths), force, tilt


def _amplitude(system: System) -> float:
    excitation = system.excitation
    return excitation.displacement if isinstance(excitation, MeshExcitation) else excitation.force


def _within(natural: Real, frequency: Real) -> Real:
    return np.asarray(natural[(natural > 0.0) & (natural >= frequency.min()) & (natural <= frequency.max())])


def _ratio(part: Real, whole: Real) -> Real:
    return np.asarray(np.divide(part, whole, out=np.zeros_like(part), where=whole != 0.0))
