"""Names and units of the signals of python-control objects."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any


def signal_name(variable: str) -> str:
    """python-control's name of an FMU variable: it allows no dot, so `bearing_1.force_uy` is `bearing_1/force_uy`."""
    return variable.replace(".", "/")


def signal_names(variables: Sequence[str]) -> list[str]:
    """`signal_name` of several; of two that only a dot told apart the later one ends in an underscore."""
    names: dict[str, None] = {}
    for variable in variables:
        name = signal_name(variable)
        while name in names:
            name += "_"
        names[name] = None
    return list(names)


def plain_name(name: str) -> str:
    """A system's name without the dollar sign of `gearbox$indexed`, two of which Matplotlib takes for a formula."""
    return name.replace("$", "_")


def with_units(
    system: Any, about: str, inputs: Sequence[str], outputs: Sequence[str], states: Sequence[str] = ()
) -> None:
    """Give a python-control object its units, in the order of its signals.

    As dictionaries by signal name, `input_units`, `output_units` and (with states) `state_units`, and as text in its
    docstring, which `help` and editors show. python-control knows no units: what it makes of the object has none.
    """
    system.input_units = dict(zip(system.input_labels, inputs))
    system.output_units = dict(zip(system.output_labels, outputs))
    parts = {"Inputs": system.input_units, "Outputs": system.output_units}
    if states:
        system.state_units = parts["States"] = dict(zip(system.state_labels, states))
    system.__doc__ = "\n\n".join([about, *(_listed(title, units) for title, units in parts.items())]) + "\n"


def _listed(title: str, units: Mapping[str, str]) -> str:
    return "\n".join([f"{title}:", *(f"    {name} ({unit or '1'})" for name, unit in units.items())])
