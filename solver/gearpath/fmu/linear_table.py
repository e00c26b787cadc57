"""The variable table of the FMU of a linear system: inputs, outputs, states and their derivatives."""

from collections.abc import Iterable

import numpy as np

from ..errors import InputError
from ..numerics.arrays import Real
from .linear_system import LinearSystem
from .variables import Kind, Variable

# Typical amplitudes of inputs by unit; 1 of any other. Motions are those of structure-borne noise.
_NOMINAL = {"m": 1e-6, "rad": 1e-6, "m/s": 1e-3, "rad/s": 1e-3}
_RATES = {"m": "m/s", "rad": "rad/s", "m/s": "m/s2", "rad/s": "rad/s2"}


def linear_table(system: LinearSystem, fmi: str = "2.0") -> tuple[Variable, ...]:
    """All variables, in the order of their value references; FMI 3 has the matrices and the time as well.

    Raises:
        InputError: a signal is called as one of these is.
    """
    table = (*_inputs(system), *_outputs(system), *_states(system), *_derivatives(system))
    if fmi == "3.0":
        time = Variable("time", Kind.TIME, (0, 0, 0), "independent", "s", "Simulation time", 1.0)
        table = (*table, *_matrices(system), time)
    names = [variable.name for variable in table]
    for signal in (*system.inputs, *system.outputs, *system.states):
        if names.count(signal) > 1:
            raise InputError(f"{system.name}: FMI 3 has a variable {signal!r} of its own; rename the signal")
    return table


def input_nominals(system: LinearSystem) -> Real:
    """Typical amplitudes of the inputs (m,)."""
    return np.array([_NOMINAL.get(system.units.get(name, ""), 1.0) for name in system.inputs])


def state_nominals(system: LinearSystem) -> Real:
    """Typical amplitudes of the states (n,): largest response to the inputs' own, at the corner frequency of any pole.

    |(s I - A)^-1 B| u with s = |p| (1 + i) / sqrt(2): halfway between frequency and growth, where neither an integrator
    nor an undamped pole is infinite.
    """
    n, sizes = len(system.A), input_nominals(system)
    found = np.zeros(n)
    for corner in np.unique(np.where(abs(system.poles) > 0, abs(system.poles), 1.0)):
        shifted = corner * (1.0 + 1.0j) / np.sqrt(2.0) * np.eye(n) - system.A
        try:
            response = abs(np.linalg.solve(shifted, system.B.astype(complex))) @ sizes
        except np.linalg.LinAlgError:
            continue
        found = np.fmax(found, response)
    return np.where(np.isfinite(found) & (found > 0), found, 1.0)


def _inputs(system: LinearSystem) -> Iterable[Variable]:
    for k, (name, nominal) in enumerate(zip(system.inputs, input_nominals(system))):
        unit = system.units.get(name)
        yield Variable(name, Kind.INPUT, (k, 0, 0), "input", unit, "Input", float(nominal), start=0.0)


def _knowns(system: LinearSystem, of_states: Real, of_inputs: Real) -> tuple[str, ...]:
    """What a row of [A B] or [C D] depends on."""
    inputs = (name for name, entry in zip(system.inputs, of_inputs) if entry)
    return (*inputs, *(name for name, entry in zip(system.states, of_states) if entry))


def _size(of_states: Real, of_inputs: Real, x: Real, u: Real) -> float:
    """Typical amplitude of a row of [A B] or [C D]; 1 where nothing reaches it."""
    size = float(max((abs(of_states) * x).max(initial=0.0), (abs(of_inputs) * u).max(initial=0.0)))
    return size if 0.0 < size < np.inf else 1.0


def _outputs(system: LinearSystem) -> Iterable[Variable]:
    x, u = state_nominals(system), input_nominals(system)
    for k, (name, C, D) in enumerate(zip(system.outputs, system.C, system.D)):
        knowns, unit = _knowns(system, C, D), system.units.get(name)
        yield Variable(
            name,
            Kind.OUTPUT,
            (k, 0, 0),
            "output",
            unit,
            "Output",
            _size(C, D, x, u),
            dependencies=knowns,
            initial_dependencies=knowns,
        )


def _states(system: LinearSystem) -> Iterable[Variable]:
    for k, (name, nominal) in enumerate(zip(system.states, state_nominals(system))):
        unit = system.units.get(name)
        yield Variable(name, Kind.STATE, (k, 0, 0), "local", unit, "State", float(nominal), start=0.0)


def _rate(unit: str) -> str:
    return _RATES.get(unit, f"({unit})/s" if set("/.") & set(unit) else f"{unit}/s")


def _derivatives(system: LinearSystem) -> Iterable[Variable]:
    x, u = state_nominals(system), input_nominals(system)
    for k, (name, A, B) in enumerate(zip(system.states, system.A, system.B)):
        knowns, unit = _knowns(system, A, B), system.units.get(name)
        yield Variable(
            f"der({name})",
            Kind.DERIVATIVE,
            (k, 0, 0),
            "local",
            None if unit is None else _rate(unit),
            f"Derivative of {name}",
            _size(A, B, x, u),
            dependencies=knowns,
            initial_dependencies=knowns,
            derivative_of=name,
        )


def _matrices(system: LinearSystem) -> Iterable[Variable]:
    for kind, letter in zip((Kind.MATRIX_A, Kind.MATRIX_B, Kind.MATRIX_C, Kind.MATRIX_D), "ABCD"):
        matrix: Real = getattr(system, letter)
        if matrix.size:
            text = f"Matrix {letter} of the state equations x' = A x + B u, y = C x + D u"
            yield Variable(
                f"system.{letter}", kind, (0, 0, 0), "calculatedParameter", None, text, 1.0, shape=matrix.shape
            )
