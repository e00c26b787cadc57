"""Fig. 12: the casing's centre of gravity shifted transverse to the shafts."""

from __future__ import annotations

from ...modelfile import Model
from .claims import increased, noticeable
from .eccentric import shifted
from .machine import shifted_casing, shipped
from .record import Study

SHIFT = 0.040  # m


def study(model: Model | None = None) -> Study:
    """Force and moment path with the centre of gravity moved along x."""
    model = model or shipped()
    effect, figure = shifted("fig12", model, "centre of gravity x + 40 mm", shifted_casing(model, x=SHIFT))
    return Study(
        key="fig12",
        title="Fig. 12: centre of gravity shifted across the shafts (x)",
        done="The casing's centre of gravity moves 40 mm along x, transverse to the shafts.",
        figures=(figure,),
        claims=(
            noticeable("A noticeable change occurs in the power flow through the force path.", effect, "force"),
            noticeable("A noticeable change occurs in the power flow through the moment path.", effect, "moment"),
            increased("In particular, the moment power flow is significantly increased.", effect, "moment"),
        ),
        effects=(effect,),
    )
