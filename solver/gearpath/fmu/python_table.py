"""The variable table of the python kind: the common one, and the design parameters."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ..errors import GearpathError, InputError
from ..network.assemble import assemble
from ..network.modal import ModalNetwork
from ..network.system import System
from .python_bearings import decided_by_design
from .python_design import design_parameters, redesign
from .python_settings import Entry
from .variables import Kind, Variable, variable_table

_ABOVE_ZERO = float(np.nextafter(0.0, 1.0, dtype=np.float32))
_NUDGE = 1e-3  # of the nominal value: by how much parameters are moved to find all dependencies


def python_table(system: System, network: ModalNetwork, frequency: float) -> tuple[Variable, ...]:
    """All variables in the order of their value references: those of the native kind, then the design.

    Raises InputError where two variables have the same name.
    """
    decided = decided_by_design(system)
    common = tuple(_calculated(variable, network, decided) for variable in variable_table(network, frequency))
    designs = tuple(
        Variable(
            parameter.name,
            Kind.DESIGN,
            (k, 0, 0),
            "parameter",
            parameter.unit,
            parameter.description,
            parameter.nominal,
            start=float(parameter.read(system)),
            minimum=_ABOVE_ZERO if parameter.positive else None,
        )
        for k, parameter in enumerate(design_parameters(system))
    )
    taken = {variable.name for variable in common}
    for design in designs:
        if design.name in taken:
            raise InputError(f"two FMU variables are called {design.name!r}; rename what one of them belongs to")
    moved = _moved_table(system, frequency)
    names = tuple(design.name for design in designs)
    matrices = {variable.name for variable in common if variable.causality == "calculatedParameter"}
    completed = (_completed(variable, common, moved, names) for variable in common)
    return (*(_without(variable, matrices) for variable in completed), *designs)


def _without(variable: Variable, names: set[str]) -> Variable:
    """The variable without dependencies on these."""
    return replace(
        variable,
        dependencies=tuple(name for name in variable.dependencies if name not in names),
        initial_dependencies=tuple(name for name in variable.initial_dependencies if name not in names),
    )


def _calculated(variable: Variable, network: ModalNetwork, decided: frozenset[str]) -> Variable:
    """The entry of a matrix that the design decides as what it is."""
    if variable.kind not in (Kind.STIFFNESS, Kind.DAMPING):
        return variable
    if f"{network.joints[variable.index[0]].name}.{variable.kind.name.lower()}" not in decided:
        return variable
    return replace(variable, causality="calculatedParameter", start=None, minimum=None)


def entries(variables: Sequence[Variable], network: ModalNetwork) -> tuple[Entry, ...]:
    """The same table for the program inside the FMU."""
    return tuple(_entry(variable, network) for variable in variables)


def _entry(variable: Variable, network: ModalNetwork) -> Entry:
    index, row, column = variable.index
    if variable.kind == Kind.DESIGN:
        return Entry(variable.name, "design")
    match variable.kind:
        case Kind.INPUT:
            return Entry(variable.name, "input", network.loads[index].name)
        case Kind.FREQUENCY:
            return Entry(variable.name, "frequency")
        case Kind.STIFFNESS | Kind.DAMPING if variable.causality == "calculatedParameter":
            return Entry(variable.name, "followed", network.joints[index].name, row, column)
        case Kind.STIFFNESS | Kind.DAMPING:
            return Entry(variable.name, variable.kind.name.lower(), network.joints[index].name, row, column)
        case Kind.MODAL_DAMPING:
            return Entry(variable.name, "modal_damping", list(network.modal_damping)[index])
        case Kind.OUTPUT:
            return Entry(variable.name, "output", network.outputs[index].name)
        case Kind.ALPHA | Kind.JOINT_ALPHA | Kind.FRF_REAL | Kind.FRF_IMAG:
            return Entry(variable.name, "response")
    raise InputError(f"the python FMU has nothing for the variable {variable.name}")


def _completed(
    variable: Variable,
    common: Sequence[Variable],
    moved: Mapping[str, Variable] | None,
    designs: tuple[str, ...],
) -> Variable:
    """The variable with the dependencies that it has in any design."""
    if variable.causality == "calculatedParameter":
        return replace(variable, dependencies=(), initial_dependencies=designs)
    if variable.causality != "output":
        return variable
    inputs, parameters = variable.dependencies, variable.initial_dependencies
    if moved is None and variable.kind == Kind.OUTPUT:
        inputs = tuple(v.name for v in common if v.kind == Kind.INPUT)
        parameters = (*inputs, *(v.name for v in common if v.causality == "parameter"))
    elif moved is not None and variable.name in moved:
        inputs = _union(inputs, moved[variable.name].dependencies)
        parameters = _union(parameters, moved[variable.name].initial_dependencies)
    return replace(
        variable,
        dependencies=inputs,
        initial_dependencies=(*parameters, *designs) if parameters else (),
    )


def _union(first: tuple[str, ...], second: tuple[str, ...]) -> tuple[str, ...]:
    return (*first, *(name for name in second if name not in first))


def _moved_table(system: System, frequency: float) -> dict[str, Variable] | None:
    """The table of a design moved a little in everything, without zeros of symmetry; None if impossible."""
    moved = {
        parameter.name: float(parameter.read(system)) + _NUDGE * parameter.nominal * (1.0 + k / np.pi)
        for k, parameter in enumerate(design_parameters(system))
        if not parameter.whole
    }
    try:
        table = variable_table(assemble(redesign(system, moved)).modal().viscous(), frequency)
    except (GearpathError, ValueError, ArithmeticError):
        return None
    return {variable.name: variable for variable in table}
