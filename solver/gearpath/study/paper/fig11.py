"""Fig. 11: the casing's centre of gravity shifted along the shafts."""

from __future__ import annotations

from ...modelfile import Model
from .claims import little, noticeable
from .eccentric import shifted
from .machine import shifted_casing, shipped
from .record import Study

SHIFT = 0.030  # m


def study(model: Model | None = None) -> Study:
    """Force and moment path with the centre of gravity moved along z."""
    model = model or shipped()
    effect, figure = shifted("fig11", model, "centre of gravity z + 30 mm", shifted_casing(model, z=SHIFT))
    return Study(
        key="fig11",
        title="Fig. 11: centre of gravity shifted along the shafts (z)",
        done="The casing's centre of gravity moves 30 mm along z; shafts, bearings and mounts stay where they are.",
        figures=(figure,),
        claims=(
            little("The power transmitted by the force path is unaffected.", effect, "force"),
            noticeable("The power transmitted by the moment path is somewhat altered.", effect, "moment"),
        ),
        effects=(effect,),
    )
