"""Which variables of an FMU are the inputs, outputs and states of its linearisation; arrays element by element."""

from __future__ import annotations

from collections.abc import Container, Iterable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from itertools import product

from ...errors import InputError
from ..conformance.contents import FLOATS, Fmu, Variable


@dataclass(frozen=True)
class Signal:
    """One element of a float variable, the whole of a scalar."""

    variable: Variable
    element: int  # row by row
    name: str  # of the element, such as "force[2]" or "K[1,2]"

    @property
    def unit(self) -> str:
        """As the FMU declares it, "" where it does not."""
        return self.variable.unit or ""


def signals(fmu: Fmu, variable: Variable) -> list[Signal]:
    """All elements of a variable."""
    shape = fmu.shape(variable)
    if not shape:
        return [] if shape is None else [Signal(variable, 0, variable.name)]
    places = product(*(range(1, size + 1) for size in shape))
    return [Signal(variable, i, f"{variable.name}[{','.join(map(str, place))}]") for i, place in enumerate(places)]


def states_of(fmu: Fmu) -> list[Variable]:
    """The continuous states in the order of the state vector. Raises InputError where the description loses one."""
    states = []
    for place, state in enumerate(fmu.states, 1):
        if state is None or state.type not in FLOATS or state.reference is None or not fmu.size(state):
            raise InputError(
                f"modelDescription.xml: derivative {place} of the model structure leads to no state; "
                "gearpath validate says more about this FMU"
            )
        states.append(state)
    return states


def inputs_of(fmu: Fmu, names: str | Iterable[str] | None) -> list[Signal]:
    """The continuous inputs, or those of the names given. Raises InputError."""
    return _chosen(fmu, "input", [v for v in fmu.variables if v.causality == "input" and continuous(fmu, v)], names)


def outputs_of(fmu: Fmu, names: str | Iterable[str] | None, states: Sequence[Variable]) -> list[Signal]:
    """The continuous outputs, or those of the names given, states too; all states where there is no output."""
    outputs = [v for v in fmu.variables if v.causality == "output" and continuous(fmu, v)]
    if names is None:
        return [signal for v in outputs or states for signal in signals(fmu, v)]
    return _chosen(fmu, "output", [*outputs, *(s for s in states if s not in outputs)], names)


def continuous(fmu: Fmu, variable: Variable) -> bool:
    """Whether it is a float that may change at any time, and can be reached."""
    reachable = variable.type in FLOATS and variable.reference is not None and bool(fmu.size(variable))
    return variable.variability == "continuous" and reachable


def dotted(given: object, known: Container[str]) -> str:
    """A variable's name, which may be given as python-control has it, a slash for every dot."""
    name = str(given)
    return name if name in known else name.replace("/", ".")


def hint(name: str, known: Iterable[str]) -> str:
    """What to do about a name that is not known."""
    names = list(known)
    close = get_close_matches(name, names, n=1)
    if close:
        return f"did you mean {close[0]!r}?"
    shown = ", ".join(names[:10]) + (", ..." if len(names) > 10 else "")
    return f"known: {shown}" if names else "there are none"


def _chosen(fmu: Fmu, kind: str, variables: Sequence[Variable], names: str | Iterable[str] | None) -> list[Signal]:
    whole = {v.name: signals(fmu, v) for v in variables}
    if names is None:
        return [signal for elements in whole.values() for signal in elements]
    whole |= {alias: whole[v.name] for v in variables for alias, _ in v.aliases}
    known = {signal.name: [signal] for elements in whole.values() for signal in elements} | whole
    found = []
    for given in [names] if isinstance(names, str) else names:
        name = dotted(given, known)
        if name not in known:
            variable = fmu.by_name.get(name)
            if variable is not None:
                what = f"{variable.name!r} is a {variable.variability} {variable.causality} of type {variable.type}"
                raise InputError(f"{kind}s: {what}; only continuous floats can be an {kind}: {hint('', known)}")
            raise InputError(f"{kind}s: the FMU has no {kind} {str(given)!r}; {hint(name, known)}")
        found += [signal for signal in known[name] if signal not in found]
    return found
