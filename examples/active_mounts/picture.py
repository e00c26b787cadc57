"""Ground force, mount power and alpha over frequency, predicted, with what the co-simulations found."""

from pathlib import Path

import numpy as np
from comparison import STEP, Comparison, controller_of
from levels import decibels
from matplotlib.figure import Figure
from prediction import continuous, sampled

CURVES = np.geomspace(50.0, 2000.0, 800)  # Hz


def draw(path: Path, found: Comparison) -> None:
    """Lines: with the delay of the co-simulation; thin ones: without it; marks: measured at the mesh frequency.

    alpha leaves its axis where actuators feed the gear train so that the mesh takes in hardly any power.
    """
    figure = Figure(figsize=(9, 10), layout="constrained")
    axes = figure.subplots(3, 1, sharex=True)
    own = found.machine
    for k, (name, case) in enumerate(found.cases.items()):
        controller = controller_of(case.loop)
        answers = (
            sampled(own.plant, controller, CURVES, STEP, own.error),
            continuous(own.plant, controller, CURVES, own.error),
        )
        for answer, style in zip(answers, ({"label": name}, {"lw": 0.6, "ls": "--"})):
            shown = own.figures(answer, case.loop)
            axes[0].semilogx(CURVES, decibels(shown.ground_force), color=f"C{k}", **style)
            axes[1].loglog(CURVES, shown.mount_power, color=f"C{k}", **style)
            axes[2].semilogx(CURVES, shown.alpha, color=f"C{k}", **style)
        for marker, level in zip("o+", case.found.values()):
            for place, value in enumerate((decibels(level.ground_force), level.mount_power, level.alpha)):
                axes[place].plot(own.frequency, value, marker, color=f"C{k}", fillstyle="none")
    axes[0].set(ylabel="RMS force into the ground, dB re 1 N", title=f"{1e6 * own.error:g} um transmission error")
    axes[1].set(ylabel="power dissipated by the mounts, W")
    axes[2].set(ylabel="alpha", xlabel="frequency, Hz", ylim=(-0.2, 1.2))
    for panel in axes:
        panel.grid(visible=True, which="both", alpha=0.3)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize="small")
    figure.savefig(path)
    print("wrote", path)
