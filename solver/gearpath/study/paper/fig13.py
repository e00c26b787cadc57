"""Fig. 13: the gear mesh shifted along the shafts."""

from __future__ import annotations

import numpy as np

from ...modelfile import Model
from .claims import judge, little, noticeable
from .eccentric import shifted
from .machine import shifted_gears, shipped
from .record import Study

SHIFT = 0.010  # m


def study(model: Model | None = None) -> Study:
    """Force and moment path with unequal lengths of shaft on the two sides of the mesh."""
    model = model or shipped()
    effect, figure = shifted("fig13", model, "mesh z + 10 mm", shifted_gears(model, SHIFT))
    pairs = list(zip(effect.medians("moment"), effect.medians("force")))
    return Study(
        key="fig13",
        title="Fig. 13: gear mesh shifted along the shafts (z)",
        done="Both gears, and the mesh with them, move 10 mm along z: one side of each shaft is 135 mm long, the other "
        "115 mm; the total length and the 8 + 8 elements stay.",
        figures=(figure,),
        claims=(
            little("There seems to be little change in the force path.", effect, "force"),
            noticeable("The effect in the moment path is noticeable.", effect, "moment"),
            judge(
                "The effect in the moment path is more noticeable than in the force path.",
                "median |D| of the moment path against that of the force path",
                pairs,
                np.greater,
            ),
        ),
        effects=(effect,),
    )
