"""State equations whose signals have units, and whose parts keep them."""

from __future__ import annotations

from typing import Any

from ..errors import MissingExtraError
from .signals import plain_name, with_units

try:
    import control
except ImportError as error:
    raise MissingExtraError("python-control", "control") from error


class StateSpace(control.StateSpace):  # type: ignore[misc]  # python-control has no types
    """x' = A x + B u, y = C x + D u with the units of its signals, by name."""

    input_units: dict[str, str]
    output_units: dict[str, str]
    state_units: dict[str, str]

    def __getitem__(self, key: Any) -> StateSpace:
        """`G["output", "input"]`, or lists of names: a part, with the names and units of all signals and states."""
        part = super().__getitem__(key)
        made = StateSpace(
            *(part.A, part.B, part.C, part.D, part.dt),
            inputs=part.input_labels,
            outputs=part.output_labels,
            states=self.state_labels,
            name=plain_name(part.name),
            remove_useless_states=False,
        )
        known = [self.input_units, self.output_units, getattr(self, "state_units", {})]
        labels = [made.input_labels, made.output_labels, made.state_labels]
        units = [[of_whole.get(label, "") for label in group] for of_whole, group in zip(known, labels)]
        with_units(made, f"Part of {self.name}.", *(units if known[2] else units[:2]))
        return made

    def sample(self, *args: Any, **kwargs: Any) -> control.StateSpace:
        """The sampled system of python-control, under a plain name."""
        sampled = super().sample(*args, **kwargs)
        sampled.name = plain_name(sampled.name)
        return sampled
