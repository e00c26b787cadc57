"""One picture of a machine and its power ratio: the schematic seen along y, and alpha with its parts over frequency."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..components import GearTrain
from ..errors import MissingExtraError
from ..files import write_bytes
from ..network.ports import joint_place
from .results import compute

if TYPE_CHECKING:
    from ..modelfile import Model

INK, GREY, FORCE, MOMENT = "#1d2733", "#8a94a0", "#0072b2", "#d55e00"
_STYLE: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 9.5,
    "svg.fonttype": "path",
    "svg.hashsalt": "gearpath",
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "text.color": INK,
}


def picture(model: Model, path: Path) -> Path:
    """Write the overview as an SVG file: the machine in the plane of its shafts, and its power ratio.

    The same model gives the same bytes. Raises MissingExtraError without matplotlib.
    """
    try:
        import matplotlib as mpl
        from matplotlib.figure import Figure
    except ImportError as error:
        raise MissingExtraError("matplotlib", "control") from error
    with mpl.rc_context(_STYLE):
        figure = Figure(figsize=(10.4, 4.1), layout="constrained")
        left, right = figure.subplots(1, 2, width_ratios=[1.0, 1.25])
        _schematic(left, model)
        _ratio(right, model)
        content = io.BytesIO()
        figure.savefig(content, format="svg", metadata={"Date": None, "Creator": None}, facecolor="white")
    return write_bytes(path, content.getvalue())


def _schematic(axes: Any, model: Model) -> None:
    """Shafts, disks, meshes, bearings and mounts in the z-x plane, lengths in mm; y points out of the page."""
    system = model.system
    trains = [part for part in system.components.values() if isinstance(part, GearTrain)]
    places = [(joint.kind, place) for joint in system.joints.values() if (place := joint_place(system, joint))]
    for train in trains:
        for shaft in train.shafts.values():
            x, _, z = shaft.origin
            at = z
            for section in shaft.sections:
                _box(axes, at, x - section.outer / 2, section.length, section.outer, "#dfe5eb")
                at += section.length
        for mesh in train.meshes.values():
            for (name, disk), radius in zip(mesh.between, mesh.base_radii):
                shaft = train.shafts[name]
                x, _, z = shaft.position(shaft.disk(disk).z)
                _box(axes, z - 0.012, x - radius, 0.024, 2 * radius, "#b9c6d2")
                axes.annotate(disk, (1e3 * (z + 0.017), 1e3 * (x + 0.4 * radius)), fontsize=8.5, color=INK, va="center")
            (first, disk), _ = mesh.between
            x, _, z = train.shafts[first].position(train.shafts[first].disk(disk).z)
            contact = x + mesh.base_radii[0] * np.sign(_other_axis(train, mesh) - x)
            axes.plot(1e3 * z, 1e3 * contact, "o", color=MOMENT, ms=5, zorder=5)
    span = np.array([(place[2], place[0]) for _, place in places])
    margin = np.array([0.03, 0.035])
    low, high = span.min(axis=0) - margin, span.max(axis=0) + margin
    width, height = high - low
    _box(axes, low[0], low[1], width, height, "none", linewidth=2.2)
    for kind, (x, _, z) in places:
        if kind == "bearing":
            for side in (-1, 1):
                _box(axes, z - 0.008, x + side * 0.024 - 0.008, 0.016, 0.016, FORCE, linewidth=0)
        else:
            axes.plot(1e3 * z, 1e3 * x, marker="X", color=GREY, ms=8, ls="none", zorder=4, mec="white")
    axes.plot([], [], "s", color=FORCE, ms=7, label="bearing")
    axes.plot([], [], "X", color=GREY, ms=8, mec="white", label="mount")
    axes.plot([], [], "o", color=MOMENT, ms=5, label="gear mesh (excitation)")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=3, frameon=False, handletextpad=0.3)
    axes.set(xlabel="z, mm", ylabel="x, mm", aspect="equal", title=f"{model.name}: casing, shafts and joints")
    axes.spines[["top", "right"]].set_visible(False)


def _other_axis(train: GearTrain, mesh: Any) -> float:
    return train.shafts[mesh.between[1][0]].origin[0]


def _box(axes: Any, z: float, x: float, width: float, height: float, colour: str, linewidth: float = 0.9) -> None:
    from matplotlib.patches import Rectangle

    corner = (1e3 * z, 1e3 * x)
    edge = INK if linewidth else colour
    axes.add_patch(
        Rectangle(corner, 1e3 * width, 1e3 * height, facecolor=colour, edgecolor=edge, linewidth=linewidth, zorder=2)
    )
    axes.update_datalim([corner, (corner[0] + 1e3 * width, corner[1] + 1e3 * height)])
    axes.autoscale_view()


def _ratio(axes: Any, model: Model) -> None:
    """alpha, and its force and moment parts; dotted where a part returns power to the source."""
    results = compute(model)
    f = results.frequency
    parts = [("moment paths", results.alpha_moment, MOMENT, 1.3), ("force paths", results.alpha_force, FORCE, 1.3)]
    for label, values, colour, width in [*parts, ("all paths, α", results.alpha, INK, 2.0)]:
        with np.errstate(divide="ignore"):
            level = 10.0 * np.log10(abs(values))
        dash = (0, (4, 2)) if label == "all paths, α" else "-"
        axes.plot(f, np.where(values > 0, level, np.nan), color=colour, lw=width, ls=dash, label=label)
        axes.plot(f, np.where(values < 0, level, np.nan), color=colour, lw=width, ls=":")
    axes.plot([], [], ":", color=GREY, label="returned to the source")
    axes.set(xlabel="frequency, Hz", ylabel="power ratio, dB", title="power through the bearings / input power")
    axes.set(xlim=(0, f[-1]), ylim=(max(-110.0, axes.get_ylim()[0]), 6.0))
    axes.grid(color="#e6eaee", lw=0.8)
    axes.spines[["top", "right"]].set_visible(False)
    handles, labels = axes.get_legend_handles_labels()
    order = [2, 1, 0, 3]
    axes.legend([handles[k] for k in order], [labels[k] for k in order], frameon=False, loc="lower left", ncols=2)
