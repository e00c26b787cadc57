"""One picture of a machine and its power ratio: the machine in space, and alpha with its parts over frequency."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import MissingExtraError
from ..files import write_bytes
from .results import compute
from .schematic import draw

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
    """Write the overview as an SVG file: the machine in space, and its power ratio.

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
        draw(left, model)
        left.set_title(f"{model.name}: gears, bearings, casing, mounts")
        _ratio(right, model)
        content = io.BytesIO()
        figure.savefig(content, format="svg", metadata={"Date": None, "Creator": None}, facecolor="white")
    return write_bytes(path, content.getvalue())


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
