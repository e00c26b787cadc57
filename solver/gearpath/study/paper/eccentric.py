"""What Fig. 11 to 15 share: one part of the machine moved, force path over moment path."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ...modelfile import Model
from ...report.layout import Figure
from .drawing import changes_seen, ratio_figure
from .effect import PATHS, Effect, effects


def shifted(key: str, model: Model, name: str, changes: Mapping[str, Any]) -> tuple[Effect, Figure]:
    """The effect of the change and the figure of both paths."""
    original, (effect,) = effects(model, {name: changes})
    curves = {"original": original, name: effect.changed}
    return effect, ratio_figure(key, curves, PATHS, changes_seen([effect], PATHS))
