"""Start values of any type, set into an instance before its initialisation."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ...errors import InputError
from ..conformance.contents import FLOATS, Fmu, Variable
from ..conformance.instance import Instance
from .signals import dotted, hint

_WHOLE_2 = {"Integer": "Integer", "Enumeration": "Integer"}
_WHOLE_3 = {f"{sign}Int{bits}" for sign in ("", "U") for bits in (8, 16, 32, 64)}

Start = tuple[Variable, str, list[Any]]


def starts(fmu: Fmu, values: Mapping[str, Any]) -> list[Start]:
    """Variables, the setter of each and its values, element by element. Raises InputError for what cannot be set."""
    found = []
    for given, value in values.items():
        name = dotted(given, fmu.by_name)
        variable = fmu.by_name.get(name)
        if variable is None:
            known = [v.name for v in fmu.variables if _settable(v)]
            raise InputError(f"start_values: the FMU has no variable {str(given)!r}; {hint(name, known)}")
        if not _settable(variable):
            what = f"{variable.variability} {variable.causality}"
            raise InputError(
                f"start_values: {variable.name!r} is a {what} that cannot be set before the initialisation; "
                "set parameters, inputs and variables with a start value"
            )
        setter, convert = _kind(fmu.version, variable)
        found.append((variable, setter, _elements(fmu, variable, value, convert)))
    return found


def set_starts(instance: Instance, values: list[Start]) -> None:
    """Set all of them."""
    for variable, setter, elements in values:
        getattr(instance, setter)([variable.reference], elements)


def _settable(variable: Variable) -> bool:
    free = variable.initial in ("exact", "approx") and variable.variability != "constant"
    return free and variable.causality != "structuralParameter" and variable.reference is not None


def _kind(version: int, variable: Variable) -> tuple[str, Any]:
    kind = variable.type
    if kind in FLOATS:
        return f"set{kind}", float
    if kind == "Boolean":
        return "setBoolean", bool
    if kind == "String":
        return "setString", str
    if version == 2 and kind in _WHOLE_2:
        return f"set{_WHOLE_2[kind]}", int
    if kind in _WHOLE_3 or kind == "Enumeration":
        return "setInt64" if kind == "Enumeration" else f"set{kind}", int
    raise InputError(f"start_values: {variable.name!r} is of type {kind}, which cannot be set; leave it out")


def _elements(fmu: Fmu, variable: Variable, value: Any, convert: Any) -> list[Any]:
    try:
        elements = [convert(item) for item in np.ravel(np.asarray(value, dtype=object))]
    except (TypeError, ValueError) as error:
        raise InputError(f"start_values: {variable.name} = {value!r} does not fit a {variable.type}") from error
    if len(elements) != fmu.size(variable):
        raise InputError(
            f"start_values: {variable.name} has {fmu.size(variable)} elements, and {len(elements)} were given"
        )
    if convert is float and not np.isfinite(elements).all():
        raise InputError(f"start_values: {variable.name} = {value!r} is not finite; give finite numbers")
    return elements
