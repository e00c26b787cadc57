"""The figures of a model: power ratio with its parts, and the transfers from its excitation."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from ...components.dofs import is_rotation
from ...network.modal import ModalNetwork
from ...network.natural import natural_frequencies
from ...network.power import is_moment_path, power_flow
from ...network.records import Output
from ...network.response import frequency_response
from ...numerics.arrays import Complex, Real
from ..variables import excitation_of, transfer_unit
from .svg import DASHES, Curve, legend, plot

BAND, POINTS = (20.0, 5000.0), 400  # Hz, of the plots where nothing else is asked for
# Lines added beside a natural frequency, relative to it; not on it, where an undamped machine has no finite response.
_NEAR = np.array([-0.03, -0.01, -0.003, -0.0005, 0.0005, 0.003, 0.01, 0.03])
_DEPTH = 120.0  # dB, of the largest axis
_RETURNED = "1.5 3"  # the dash of power that flows back


@dataclass(frozen=True)
class _Panel:
    key: str
    heading: str
    unit: str
    words: str
    curves: Sequence[Curve]


def grid(network: ModalNetwork, natural: Real, band: tuple[float, float]) -> Real:
    """Frequencies of the plots in the band, Hz: even on a logarithmic axis, dense about the natural frequencies."""
    high = min(band[1], network.band)
    low = band[0] if band[0] < high else 0.1 * high
    near = (natural[(natural > low) & (natural < high)][:, None] * (1.0 + _NEAR)).ravel()
    return np.unique(np.concatenate([np.geomspace(low, high, POINTS), near[(near > low) & (near < high)]]))


def figures(network: ModalNetwork, band: tuple[float, float], frequencies: Real | None = None) -> dict[str, str]:
    """HTML of the figures by section: "power" and "transfers"; a section without a figure is left out."""
    natural = natural_frequencies(network)
    f = grid(network, natural, band) if frequencies is None else np.asarray(frequencies, float)
    found = {}
    if network.paths:
        found["power"] = _figure(_ratios(network, f), f, natural)
    panels = list(_transfers(network, f))
    if panels:
        found["transfers"] = "\n".join(_figure(panel, f, natural) for panel in panels)
    return found


def _figure(panel: _Panel, f: Real, natural: Real) -> str:
    drawing = plot(panel.key, f, panel.curves, panel.unit, panel.words, natural, _DEPTH)
    caption = f"<figcaption>{escape(panel.heading)}</figcaption>"
    return f"<figure>\n{caption}\n{drawing}\n{legend(panel.curves)}\n</figure>"


def _ratios(network: ModalNetwork, f: Real) -> _Panel:
    flow = power_flow(network, 2.0 * np.pi * f)
    parts = (
        ("all paths, alpha", flow.share(), -1, 3.4),
        ("force paths", flow.share(lambda path: not is_moment_path(path)), 0, 1.6),
        ("moment paths", flow.share(is_moment_path), 1, 1.6),
    )
    curves = [curve for part in parts for curve in _signed(*part)]
    words = f"Power ratio and its parts from {f[0]:g} to {f[-1]:g} Hz."
    return _Panel("power", "Power through the bearings over input power", "10 lg |P / P_in|, dB", words, curves)


def _signed(name: str, ratio: Real, colour: int, width: float) -> Iterator[Curve]:
    """A solid curve where power enters the receivers, a dotted one where it returns; none where there is nothing."""
    with np.errstate(divide="ignore"):
        level = 10.0 * np.log10(abs(ratio))
    if (ratio > 0).any():
        yield Curve(name, np.where(ratio > 0, level, np.nan), colour, "", width)
    if (ratio < 0).any():
        yield Curve(f"{name}, returned to the source", np.where(ratio < 0, level, np.nan), colour, _RETURNED, width)


def _transfers(network: ModalNetwork, f: Real) -> Iterator[_Panel]:
    """Forces of the bearings, a panel for each degree of freedom; then velocities of bodies and sensors by unit."""
    load = excitation_of(network)
    groups = [*_force_groups(network).items(), *_velocity_groups(network).items()]
    outputs = [output for _, group in groups for output in group]
    if not outputs:
        return
    H = dict(zip((o.name for o in outputs), frequency_response(network, 2.0 * np.pi * f, outputs, [load])[:, :, 0].T))
    for place, (heading, group) in enumerate(groups):
        unit = transfer_unit(group[0].unit, load.unit)
        curves = [Curve(o.name, decibels(H[o.name]), k, DASHES[k % len(DASHES)]) for k, o in enumerate(group)]
        words = f"{heading}: {len(curves)} transfers from {load.name}, {f[0]:g} to {f[-1]:g} Hz."
        title = f"{heading}, per unit of {load.name}"
        yield _Panel(f"transfer-{place}", title, f"20 lg |H|, dB re 1 {unit}", words, curves)


def _force_groups(network: ModalNetwork) -> dict[str, list[Output]]:
    joints = {j.name: j for j in network.joints if j.name in network.paths or not network.paths}
    found: dict[str, list[Output]] = {}
    for output in network.outputs:
        if output.quantity == "force" and output.joint in joints:
            dof = joints[output.joint].dofs[output.dof]
            kind = "Moments" if is_rotation(dof) else "Forces"
            found.setdefault(f"{kind} on the receivers, {dof}", []).append(output)
    return found


def _velocity_groups(network: ModalNetwork) -> dict[str, list[Output]]:
    """Velocities that are not a joint's; of the joints' receivers only where there are no others."""
    every = [output for output in network.outputs if output.quantity == "velocity"]
    own = [o for o in every if not any(o.name.startswith(f"{joint.name}.") for joint in network.joints)]
    found: dict[str, list[Output]] = {}
    for output in own or every:
        kind = "Angular velocities" if output.unit == "rad/s" else "Velocities"
        found.setdefault(kind, []).append(output)
    return found


def decibels(values: Complex) -> Real:
    """20 lg |H|; a gap where it is zero."""
    size = abs(values)
    return np.asarray(20.0 * np.log10(np.where(size > 0.0, size, np.nan)))
