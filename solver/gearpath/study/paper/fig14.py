"""Fig. 14: the mounts shifted along the shafts."""

from __future__ import annotations

from ...modelfile import Model
from .claims import little, noticeable
from .eccentric import shifted
from .machine import shifted_mounts, shipped
from .record import Study

SHIFT = 0.040  # m


def study(model: Model | None = None) -> Study:
    """Force and moment path with the mounts moved along z."""
    model = model or shipped()
    effect, figure = shifted("fig14", model, "mounts z + 40 mm", shifted_mounts(model, z=SHIFT))
    return Study(
        key="fig14",
        title="Fig. 14: mounts shifted along the shafts (z)",
        done="All four mounts move 40 mm along z; the centre of gravity stays at the mesh.",
        figures=(figure,),
        claims=(
            little("Only the moment path shows a difference: the force path does not.", effect, "force"),
            noticeable("The moment path shows some difference.", effect, "moment"),
        ),
        effects=(effect,),
    )
