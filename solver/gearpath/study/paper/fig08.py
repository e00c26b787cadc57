"""Fig. 8: bearings with full stiffness matrices, with diagonal ones, and with radial stiffness only."""

from __future__ import annotations

import numpy as np
from scipy.signal import find_peaks

from ...modelfile import Model
from .claims import noticeable, number_of
from .drawing import changes_seen, ratio_figure
from .effect import PATHS, Effect, Ratios, effects
from .machine import masked_bearings, shipped
from .record import Study

PEAK = (2100.0, 2300.0)  # Hz, where the assembled gearbox has two natural frequencies


def study(model: Model | None = None) -> Study:
    """Force and moment path with entries of the bearings' K and C left out."""
    model = model or shipped()
    radial = np.zeros((len(model.dofs),) * 2)
    radial[model.dofs.index("uy"), model.dofs.index("uy")] = 1.0
    changes = {
        "diagonal (no coupling term)": masked_bearings(model, np.eye(len(model.dofs))),
        "radial stiffness only": masked_bearings(model, radial),
    }
    original, found = effects(model, changes)
    curves = {"original, full matrix": original, **{effect.name: effect.changed for effect in found}}
    peaks = "; ".join(f"{name} {_peak(curve)}" for name, curve in curves.items())
    return Study(
        key="fig08",
        title="Fig. 8: full, diagonal and radial bearing stiffness",
        done="The bearings' stiffness and damping matrices (C = 1 µs · K): whole, without the coupling term between uy "
        "and rx, and with the radial entry alone.",
        figures=(ratio_figure("fig08", curves, PATHS, changes_seen(found, ("force",))),),
        claims=tuple(
            noticeable(f"Significant discrepancies in the {path} path: {effect.name}.", effect, path)
            for path in PATHS
            for effect in found
        ),
        effects=found,
        remarks=(
            f"Highest peak of the force path between {PEAK[0] / 1e3:g} and {PEAK[1] / 1e3:g} kHz, by its prominence: "
            f"{peaks}.",
            *_vanished(found),
        ),
    )


def _peak(curve: Ratios) -> str:
    """How far the highest peak near 2.2 kHz stands above the curve around it."""
    f = curve.frequency
    places, about = find_peaks(curve.level("force"), prominence=0.1)
    heights = about["prominences"][(f[places] >= PEAK[0]) & (f[places] <= PEAK[1])]
    return f"{number_of(heights.max(), 1)} dB" if len(heights) else "none"


def _vanished(found: tuple[Effect, ...]) -> tuple[str, ...]:
    gone = [effect.name for effect in found if not effect.changed.ratio("moment").any()]
    if not gone:
        return ()
    return (
        f"The moment path carries no power at all with: {', '.join(gone)}. The machine is then symmetric about its "
        "middle plane, so the casing does not tilt about x, and moments do no work on it.",
    )
