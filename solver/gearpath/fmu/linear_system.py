"""A linear system given by its matrices, such as a controller, under the names that its FMU has."""

import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import cached_property
from typing import Any

import numpy as np
import scipy.linalg

from ..errors import InputError, MissingExtraError
from ..numerics.arrays import Real
from .units import unit_exponents

LARGEST = 1000  # states, inputs or outputs: what a dense propagator is still made of in seconds
# One name of FMI's structured naming convention, or several with dots; each may have an index in brackets.
_PART = r"[A-Za-z_]\w*(\[\d+(,\d+)*\])?"
_NAME = re.compile(rf"{_PART}(\.{_PART})*", re.ASCII)


@dataclass(frozen=True)
class LinearSystem:
    """x' = A x + B u, y = C x + D u: A (n, n), B (n, m), C (p, n), D (p, m); n may be odd or 0.

    `units` are those of the signals that have one, by name.
    """

    name: str
    A: Real
    B: Real
    C: Real
    D: Real
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    states: tuple[str, ...]
    units: Mapping[str, str] = field(default_factory=dict)

    @cached_property
    def poles(self) -> np.ndarray[tuple[int, ...], np.dtype[np.complex128]]:
        """Eigenvalues of A (n,), rad/s, the slowest first."""
        values = np.linalg.eigvals(self.A).astype(complex)
        return np.asarray(values[np.argsort(abs(values), kind="stable")])

    @cached_property
    def balance(self) -> Real:
        """Units of the states, then of the inputs (n + m,), powers of two, in which A and B are balanced.

        With x = T z and u = V v the matrix T^-1 A T has rows and columns of like size (Parlett and Reinsch 1969), and
        T^-1 B V no column larger than it.
        """
        T = np.ones(len(self.A))
        if len(T):
            _, (T, _) = scipy.linalg.matrix_balance(self.A, permute=False, separate=True)
        largest = float(abs(self.A * T / T[:, None]).sum(axis=0).max(initial=0.0)) or 1.0
        sizes = abs(self.B / T[:, None]).sum(axis=0)
        ratio = np.divide(sizes, largest, out=np.ones(len(sizes)), where=sizes > 0)
        return np.concatenate([T, np.exp2(-np.rint(np.log2(ratio)))])


def from_control(system: Any, name: str | None = None, units: Mapping[str, str] | None = None) -> LinearSystem:
    """The system of a `control.StateSpace`, or of a `control.TransferFunction` that can be made one.

    A slash in a signal's name, python-control's place for a dot, becomes a dot. `units` may name signals either way.

    Raises:
        InputError: it is none of them or sampled, a number, a size or a name cannot be used, or a unit is not known.
    """
    try:
        import control
    except ImportError as error:
        raise MissingExtraError("python-control", "control") from error
    if not isinstance(system, (control.StateSpace, control.TransferFunction)):
        raise InputError(
            f"model: {type(system).__name__} cannot become an FMU; give a Model, or a python-control StateSpace or "
            "TransferFunction"
        )
    title = name if name is not None else str(system.name)
    _check_continuous(title, system.dt)
    if isinstance(system, control.TransferFunction):
        system = _realised(title, system)
    matrices = {letter: np.asarray(getattr(system, letter)) for letter in "ABCD"}
    _check_matrices(title, matrices)
    labels = (system.input_labels, system.output_labels, system.state_labels)
    names = [tuple(str(label).replace("/", ".") for label in group) for group in labels]
    _check_names(title, [label for group in names for label in group])
    found = {letter: np.array(matrix, dtype=float) for letter, matrix in matrices.items()}
    known = _own_units(system) | _units(names, units)
    return LinearSystem(title, **found, inputs=names[0], outputs=names[1], states=names[2], units=known)


def _check_continuous(title: str, dt: Any) -> None:
    if dt is not None and float(dt) != 0.0:  # None, unspecified, counts as continuous, as in python-control itself
        raise InputError(
            f"{title}: dt = {dt} is a sampled system, which the FMU does not run; give the continuous-time system that "
            "it was sampled from, with dt = 0"
        )


def _realised(title: str, system: Any) -> Any:
    """A state space of a transfer function."""
    import control

    for row in zip(system.num, system.den):
        for numerator, denominator in zip(*row):
            if len(np.trim_zeros(numerator, "f")) > len(np.trim_zeros(denominator, "f")):
                raise InputError(
                    f"{title}: the transfer function is improper, with more zeros than poles; add a pole beyond the "
                    "frequencies of interest"
                )
    try:
        return control.ss(system)
    except (ValueError, NotImplementedError) as error:
        raise InputError(
            f"{title}: python-control finds no state space for this transfer function; give a StateSpace"
        ) from error


def _check_matrices(title: str, matrices: Mapping[str, Any]) -> None:
    for letter, matrix in matrices.items():
        if np.iscomplexobj(matrix) or not np.isfinite(matrix).all():
            raise InputError(f"{title}: matrix {letter} has an entry that is complex or not finite; give real numbers")
    outputs, states = matrices["C"].shape
    inputs = matrices["D"].shape[1]
    if not outputs:
        raise InputError(f"{title}: there is no output, so that an FMU of it would do nothing; add one")
    for count, what in ((states, "states"), (inputs, "inputs"), (outputs, "outputs")):
        if count > LARGEST:
            raise InputError(f"{title}: {count} {what} are more than the {LARGEST} of an FMU; reduce the system first")


def _check_names(title: str, names: list[str]) -> None:
    for name in names:
        if not _NAME.fullmatch(name):
            raise InputError(
                f"{title}: {name!r} cannot name an FMU variable; rename the signal with letters, digits and "
                "underscores, parted by dots or slashes"
            )
    twice = [name for name, count in Counter(names).items() if count > 1]
    if twice:
        raise InputError(f"{title}: two of its inputs, outputs and states are called {twice[0]!r}; rename one of them")


def _own_units(system: Any) -> dict[str, str]:
    """The units that Gearpath's own systems bring along, where FMI can say them."""
    found = {}
    for group in ("input_units", "output_units", "state_units"):
        for label, unit in getattr(system, group, {}).items():
            try:
                unit_exponents(unit)
            except InputError:
                continue
            found[label.replace("/", ".")] = unit
    return found


def _units(names: list[tuple[str, ...]], units: Mapping[str, str] | None) -> dict[str, str]:
    known = [name for group in names for name in group]
    found = {}
    for key, unit in (units or {}).items():
        name = str(key).replace("/", ".")
        if name not in known:
            near = get_close_matches(name, known, n=1) or known[:1]
            raise InputError(f"units: there is no signal {key!r}; did you mean {near[0]!r}?")
        unit_exponents(unit)  # raises InputError
        found[name] = unit
    return found
