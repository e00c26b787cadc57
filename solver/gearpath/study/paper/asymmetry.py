"""Sec. 7 after Fig. 15: along which axis is the power flow more sensitive to an asymmetry of the same size?"""

from __future__ import annotations

import numpy as np

from ...modelfile import Model
from .claims import NAMES, Claim, judge
from .drawing import changes_seen, ratio_figure
from .effect import PATHS, Effect, Part, effects
from .machine import shifted_casing, shifted_mounts, shipped
from .record import Study

SHIFT = 0.040  # m


def study(model: Model | None = None) -> Study:
    """The same shift along x and along z, of the centre of gravity and of the mounts."""
    model = model or shipped()
    changes = {
        "centre of gravity z + 40 mm": shifted_casing(model, z=SHIFT),
        "centre of gravity x + 40 mm": shifted_casing(model, x=SHIFT),
        "mounts z + 40 mm": shifted_mounts(model, z=SHIFT),
        "mounts x + 40 mm": shifted_mounts(model, x=SHIFT),
    }
    original, found = effects(model, changes)
    casing, mounts = found[:2], found[2:]
    figures = tuple(
        ratio_figure(
            f"asymmetry-{key}",
            {"original": original, **{effect.name: effect.changed for effect in pair}},
            PATHS,
            changes_seen(pair, PATHS),
            heading,
        )
        for key, heading, pair in (("casing", "Centre of gravity", casing), ("mounts", "Mounts", mounts))
    )
    return Study(
        key="asymmetry",
        title="Fig. 11 to 15 together: asymmetry across the shafts against asymmetry along them",
        done="The figures shift by different amounts; here everything moves by the same 40 mm, along x and along z.",
        figures=figures,
        claims=tuple(
            _more_sensitive(what, part, *pair)
            for what, pair in (("centre of gravity", casing), ("mounts", mounts))
            for part in PATHS
        ),
        effects=found,
    )


def _more_sensitive(what: str, part: Part, along: Effect, across: Effect) -> Claim:
    return judge(
        f"The power flow is more sensitive to asymmetry along x: {what}, {NAMES[part]}.",
        f"median |D| of {NAMES[part]} by the shift along x against that along z",
        list(zip(across.medians(part), along.medians(part))),
        np.greater,
    )
