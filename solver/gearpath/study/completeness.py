"""Static completeness: how fast reduced bases of the source reach the power ratio of its complete basis.

The paper's central modelling claim (Sec. 4): a basis that holds the static responses at its interfaces truncates
without harm, one of free-free modes alone does not. Excited by the inertial force F_e = m_e w^2 e, in which every basis
is judged alike; the transmission error itself also needs the spin d in the basis, which free modes alone lack.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..components import Structure
from ..errors import InputError, MissingExtraError
from ..files import write_bytes
from ..network.assemble import Network, assemble, to_modes
from ..network.modal import ModalNetwork
from ..network.power import power_flow
from ..network.system import MeshExcitation
from ..numerics.arrays import Real
from ..reduction import (
    Flexibility,
    Reduction,
    craig_bampton,
    deviation,
    estimated_deviation,
    free_interface,
    inertia_relief,
    lanczos,
    reduced_modes,
    static_defect,
)
from ..report.layout import COLOURS, GRID, INK
from ..report.table import Group, Table

if TYPE_CHECKING:
    from ..modelfile import Model

COUNTS = (2, 4, 6, 9, 12, 14, 16, 18, 21, 24, 30, 36)
METHODS: Mapping[str, Callable[[Structure, int], Reduction]] = {
    "Lanczos, block start": lanczos,
    "Lanczos, mesh start": lambda structure, count: lanczos(structure, count, start="mesh"),
    "fixed-interface modes": craig_bampton,
    "free-interface modes": lambda structure, count: free_interface(structure, count, residual=False),
    "free-interface modes with residuals": lambda structure, count: free_interface(structure, count, residual=True),
}
_STYLES = (("o", "-"), ("x", "--"), ("s", "-."), ("^", ":"), ("D", "-"))


@dataclass(frozen=True)
class Convergence:
    """One method over the number of its vectors; every array has one entry a basis."""

    method: str
    vectors: Real  # Lanczos vectors or normal modes
    size: Real  # coordinates in all
    mean: Real  # |10 lg alpha - 10 lg alpha_complete| over the lines, dB
    maximum: Real  # dB
    static_defect: Real  # largest missing part of a driving-point static compliance, 0 to 1
    estimate: Real  # estimated relative deviation of the interface mobility, largest in the band; no complete basis
    deviation: Real  # its true value


@dataclass(frozen=True)
class Completeness:
    """The study of one component."""

    component: str
    coordinates: int  # of the component, unreduced
    frequency: Real  # Hz
    curves: tuple[Convergence, ...]

    def curve(self, method: str) -> Convergence:
        """The curve of a method."""
        return next(curve for curve in self.curves if curve.method == method)


def static_completeness(
    model: Model, counts: Sequence[int] = COUNTS, frequencies_hz: Real | None = None
) -> Completeness:
    """Deviation of alpha against the number of vectors, five methods, default lines 10, 20 ... 5000 Hz.

    The excited component is reduced. Counts beyond what it has are left out; raises InputError where none is left.
    """
    network = assemble(model.system)
    top = min(5000.0, network.band)  # a component that is itself reduced is complete up to its band only
    f = np.arange(10.0, top + 1.0, 10.0) if frequencies_hz is None else np.asarray(frequencies_hz, float)
    omega = 2.0 * np.pi * f
    name = _source(network)
    structure = network.structures[name]
    most = _most(structure)
    if not any(0 <= count <= most for count in counts):
        raise InputError(f"the excited component {name!r} can be reduced to 0 to {max(most, 0)} vectors, not {counts}")
    complete = _level(_by_force(network, network.modal()), omega)
    flexibility = inertia_relief(structure)
    curves = []
    for method, reduce in METHODS.items():
        bases = [reduce(structure, count) for count in counts if 0 <= count <= most]
        rows = [_judge(network, name, item, omega, complete, flexibility) for item in bases]
        vectors, size = ([getattr(item, key) for item in bases] for key in ("vectors", "size"))
        curves.append(Convergence(method, np.array(vectors), np.array(size), *np.array(rows).T))
    return Completeness(name, structure.size, f, tuple(curves))


def _source(network: Network) -> str:
    excitation = network.system.excitation
    return excitation.component if isinstance(excitation, MeshExcitation) else excitation.port.component


def _most(structure: Structure) -> int:
    """So many vectors every method has: coordinates less rigid motions, ports (six rows each at most) and meshes."""
    ports = sum(int(np.count_nonzero(np.any(rows, axis=1))) for rows in structure.ports.values())
    return int(structure.size - max(structure.rigid_modes.shape[1], ports + len(structure.meshes)))


def _by_force(network: Network, modal: ModalNetwork) -> ModalNetwork:
    excitation = network.system.excitation
    return replace(modal, excitation=f"{excitation.mesh}.force") if isinstance(excitation, MeshExcitation) else modal


def _level(modal: ModalNetwork, omega: Real) -> Real:
    """10 lg alpha, (F,); minus infinity where a basis lets no power through."""
    alpha = power_flow(modal, omega).share()
    return np.asarray(10.0 * np.log10(np.maximum(alpha, np.finfo(float).tiny)))


def _judge(
    network: Network, name: str, reduction: Reduction, omega: Real, complete: Real, flexibility: Flexibility
) -> tuple[float, ...]:
    structure = network.structures[name]
    modal = to_modes(network, {**network.bases, name: reduced_modes(structure, reduction)})
    error = abs(_level(_by_force(network, modal), omega) - complete)
    return (
        float(error.mean()),
        float(error.max()),
        static_defect(structure, reduction, flexibility=flexibility),
        float(estimated_deviation(structure, reduction, omega, flexibility=flexibility).max()),
        float(deviation(structure, reduction, network.bases[name], omega).max()),
    )


def completeness_table(study: Completeness) -> Table:
    """One row a basis, grouped by method."""

    def row(curve: Convergence, k: int) -> list[str]:
        figures = (curve.mean, curve.maximum, curve.static_defect, curve.estimate, curve.deviation)
        return [f"{curve.vectors[k]:.0f}", f"{curve.size[k]:.0f}", *(f"{figure[k]:.1e}" for figure in figures)]

    groups = [Group([row(curve, k) for k in range(len(curve.size))], curve.method) for curve in study.curves]
    head = [
        "vectors",
        "coordinates",
        "mean |Δα|, dB",
        "largest |Δα|, dB",
        "static compliance missing",
        "mobility, estimated",
        "mobility, true",
    ]
    f = study.frequency
    caption = (
        f"Reduced bases of {study.component} ({study.coordinates} coordinates) against its complete basis, {len(f)} "
        f"lines from {f[0]:g} to {f[-1]:g} Hz; mobility: largest relative deviation at the interface"
    )
    note = (
        "In a nearly symmetric machine the mesh start meets antisymmetric motion only through rounding: its deviations "
    )
    note += "beyond some nine vectors differ from one computer to another."
    return Table(caption, head, groups, text_columns=0, note=note)


def completeness_figure(study: Completeness, path: Path) -> Path:
    """Write mean and largest deviation of alpha over the size of the basis, two panels, as an SVG file.

    The same study gives the same bytes. Raises MissingExtraError without matplotlib.
    """
    try:
        import matplotlib as mpl
        from matplotlib.figure import Figure
    except ImportError as error:
        raise MissingExtraError("matplotlib", "control") from error
    style: Any = {"font.family": "DejaVu Sans", "font.size": 9.5, "svg.fonttype": "path", "svg.hashsalt": "gearpath"}
    style |= {f"{what}.color": INK for what in ("text", "xtick", "ytick")}
    style |= {"axes.edgecolor": INK, "axes.labelcolor": INK}
    with mpl.rc_context(style):
        figure = Figure(figsize=(10.4, 4.4), layout="constrained")
        panels = figure.subplots(1, 2, sharey=True)
        for axes, key, title in zip(panels, ("mean", "maximum"), ("mean over the lines", "largest of the lines")):
            for curve, colour, (marker, dash) in zip(study.curves, COLOURS, _STYLES):
                values = getattr(curve, key)
                axes.plot(curve.size, values, dash, marker=marker, ms=5, mfc="white", color=colour, label=curve.method)
            axes.set(xlabel="coordinates of the reduced source", yscale="log", title=title)
            axes.grid(color=GRID, lw=0.8)
            axes.spines[["top", "right"]].set_visible(False)
        panels[0].set_ylabel("deviation of α from the complete basis, dB")
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
        content = io.BytesIO()
        figure.savefig(content, format="svg", metadata={"Date": None, "Creator": None}, facecolor="white")
    return write_bytes(path, content.getvalue())
