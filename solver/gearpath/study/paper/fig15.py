"""Fig. 15: the mounts shifted transverse to the shafts."""

from __future__ import annotations

from ...modelfile import Model
from .claims import increased
from .eccentric import shifted
from .machine import shifted_mounts, shipped
from .record import Study

SHIFT = 0.040  # m


def study(model: Model | None = None) -> Study:
    """Force and moment path with the mounts moved along x."""
    model = model or shipped()
    effect, figure = shifted("fig15", model, "mounts x + 40 mm", shifted_mounts(model, x=SHIFT))
    return Study(
        key="fig15",
        title="Fig. 15: mounts shifted across the shafts (x)",
        done="All four mounts move 40 mm along x; the centre of gravity stays at the mesh.",
        figures=(figure,),
        claims=(increased("The moment power flows are significantly amplified.", effect, "moment"),),
        effects=(effect,),
    )
