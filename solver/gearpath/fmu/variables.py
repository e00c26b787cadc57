"""The variable table of an FMU: one list that the XML, model.bin and both kinds of FMU are made from."""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum
from typing import Literal

import numpy as np

from ..components.dofs import is_rotation
from ..errors import InputError
from ..network.modal import ModalNetwork
from ..network.records import JointRows, Load, Output
from ..numerics.arrays import Real


class Kind(IntEnum):
    """What a variable stands for; the numbers are those of `GP_INPUT` ... in fmu_src/gp_model.h."""

    INPUT = 0
    FREQUENCY = 1
    STIFFNESS = 2
    DAMPING = 3
    MODAL_DAMPING = 4
    OUTPUT = 5
    ALPHA = 6
    JOINT_ALPHA = 7
    FRF_REAL = 8
    FRF_IMAG = 9
    DESIGN = 10  # of the python kind only: what needs the components rebuilt


@dataclass(frozen=True)
class Variable:
    """A Real variable of the FMU; its value reference is its place in the table."""

    name: str
    kind: Kind
    index: tuple[int, int, int]  # into the network's loads, joints, outputs ...; what it means depends on the kind
    causality: Literal["input", "parameter", "output"]
    unit: str
    description: str
    nominal: float
    start: float | None = None  # None for outputs, which are calculated
    minimum: float | None = None
    maximum: float | None = None
    dependencies: tuple[str, ...] = ()  # of an output, on inputs, at a communication point
    initial_dependencies: tuple[str, ...] = ()  # of an output, on inputs and parameters, at the start


# One bname of FMI's structured naming convention, or several with dots.
_NAME = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*", re.ASCII)
_NOMINAL = {"displacement": 1e-6, "velocity": 1e-3, "acceleration": 1.0, "force": 100.0, "power": 1e-3}
_QUANTITY = {
    "displacement": "displacement",
    "velocity": "velocity",
    "acceleration": "acceleration",
    "force": "force on the receiver",
    "power": "instantaneous power into the receiver",
}


def variable_table(network: ModalNetwork, frequency: float) -> tuple[Variable, ...]:
    """All variables of the FMU of `network`, in the order of their value references.

    Inputs, then parameters, then outputs over time, then outputs over frequency (the last at the value of the
    input `frequency`, which starts at `frequency`, Hz).

    Raises:
        InputError: a name cannot be an FMU variable, or occurs twice; excitation or path do not exist.
    """
    if not (np.isfinite(frequency) and frequency > 0):
        raise InputError(f"the start value of the frequency input is {frequency} Hz; give a positive number")
    excitation = next((load for load in network.loads if load.name == network.excitation), None)
    if excitation is None:
        raise InputError(f"the excitation {network.excitation!r} is none of the network's loads; name one of them")
    for path in network.paths:
        if path not in {joint.name for joint in network.joints}:
            raise InputError(f"the path {path!r} is none of the network's joints; name one of them")
    parameters = [*_joint_parameters(network), *_modal_parameters(network)]
    table = (
        *_inputs(network, frequency),
        *parameters,
        *_time_outputs(network),
        *_frequency_outputs(network, excitation, tuple(p.name for p in parameters)),
    )
    seen: set[str] = set()
    for variable in table:
        name = re.sub(r"\[\d+,\d+\]$", "", variable.name)
        if not _NAME.fullmatch(name):
            raise InputError(
                f"{name!r} cannot name an FMU variable; use letters, digits and underscores, parted by dots"
            )
        if variable.name in seen:
            raise InputError(f"two FMU variables are called {variable.name!r}; rename one of what they belong to")
        seen.add(variable.name)
    return table


def motion_of(unit: str, dof: str) -> str:
    """Unit of a force or moment per motion: "N" and "uy" give "N/m", "N.s" and "rx" give "N.s/rad"."""
    return f"{unit}/{'rad' if is_rotation(dof) else 'm'}"


def transfer_unit(output: str, excitation: str) -> str:
    """Unit of a transfer from the excitation, such as "N/m" or "(m/s)/N"."""
    return "/".join(f"({unit})" if set("/.") & set(unit) else unit for unit in (output, excitation))


def _inputs(network: ModalNetwork, frequency: float) -> Iterable[Variable]:
    for k, load in enumerate(network.loads):
        error = load.is_transmission_error
        what = "Transmission error in the gear mesh" if error else "Force or moment from outside"
        yield Variable(load.name, Kind.INPUT, (k, 0, 0), "input", load.unit, what, _load_nominal(load), start=0.0)
    yield Variable(
        "frequency",
        Kind.FREQUENCY,
        (0, 0, 0),
        "input",
        "Hz",
        "Frequency of the frequency-domain outputs; without effect on the others",
        1000.0,
        start=float(frequency),
        minimum=1e-6,
    )


def _load_nominal(load: Load) -> float:
    return 1e-6 if load.is_transmission_error else 1.0


def _joint_parameters(network: ModalNetwork) -> Iterable[Variable]:
    for j, joint in enumerate(network.joints):
        for kind, matrix, factor in (
            (Kind.STIFFNESS, joint.stiffness, ""),
            (Kind.DAMPING, joint.damping, ".s"),
        ):
            yield from _matrix_parameters(j, joint, kind, matrix, factor)


def _matrix_parameters(j: int, joint: JointRows, kind: Kind, matrix: Real, factor: str) -> Iterable[Variable]:
    what = kind.name.lower()
    scale = np.sqrt(np.maximum(np.diag(matrix), 0.0))
    for i, row in enumerate(joint.dofs):
        for k, column in enumerate(joint.dofs[i:], start=i):
            moment = "N.m" if is_rotation(row) else "N"
            entry = "" if joint.scalar else f"[{i + 1},{k + 1}]"
            motion = "velocity" if factor else "motion"
            text = f"{what.capitalize()} of {joint.name}, force on {row} per {motion} of {column}"
            if i != k:
                text += "; also the entry mirrored in the diagonal, the matrix being symmetric"
            yield Variable(
                f"{joint.name}.{what}{entry}",
                kind,
                (j, i, k),
                "parameter",
                motion_of(moment + factor, column),
                text,
                float(abs(matrix[i, k]) or scale[i] * scale[k] or 1.0),
                start=float(matrix[i, k]),
                minimum=0.0 if i == k else None,
            )


def _modal_parameters(network: ModalNetwork) -> Iterable[Variable]:
    for g, (name, ratio) in enumerate(network.modal_damping.items()):
        yield Variable(
            f"{name}.modal_damping",
            Kind.MODAL_DAMPING,
            (g, 0, 0),
            "parameter",
            "1",
            f"Damping ratio of every elastic free-free mode of {name}, below 1",
            0.01,
            start=float(ratio),
            minimum=0.0,
            maximum=float(np.nextafter(1.0, 0.0)),
        )


def _time_outputs(network: ModalNetwork) -> Iterable[Variable]:
    structure = _Feedthrough(network)
    for o, output in enumerate(network.outputs):
        inputs, parameters = structure.of(output)
        yield Variable(
            output.name,
            Kind.OUTPUT,
            (o, 0, 0),
            "output",
            output.unit,
            f"{_QUANTITY[output.quantity].capitalize()}, over time",
            _NOMINAL[output.quantity],
            dependencies=inputs,
            initial_dependencies=(*inputs, *parameters),
        )


def _frequency_outputs(network: ModalNetwork, excitation: Load, parameters: tuple[str, ...]) -> Iterable[Variable]:
    initial = ("frequency", *parameters)

    def ratio(name: str, kind: Kind, index: int, what: str) -> Variable:
        text = f"Time-averaged power {what}, divided by the input power, at the input frequency"
        return Variable(
            name,
            kind,
            (index, 0, 0),
            "output",
            "1",
            text,
            1.0,
            dependencies=("frequency",),
            initial_dependencies=initial,
        )

    for a, (name, what) in enumerate(
        (
            ("alpha", "through all paths"),
            ("alpha_force", "through the forces"),
            ("alpha_moment", "through the moments"),
        )
    ):
        yield ratio(name, Kind.ALPHA, a, what)
    for j, joint in enumerate(network.joints):
        if joint.name in network.paths:
            yield ratio(f"{joint.name}.alpha", Kind.JOINT_ALPHA, j, f"through {joint.name}")
    for o, output in enumerate(network.outputs):
        if output.quantity == "power":
            continue
        for part, kind in (("re", Kind.FRF_REAL), ("im", Kind.FRF_IMAG)):
            side = "Real" if part == "re" else "Imaginary"
            yield Variable(
                f"frf.{output.name}.{part}",
                kind,
                (o, 0, 0),
                "output",
                transfer_unit(output.unit, excitation.unit),
                f"{side} part of the transfer from {excitation.name} to {output.name}, at the frequency",
                _NOMINAL[output.quantity] / _load_nominal(excitation),
                dependencies=("frequency",),
                initial_dependencies=initial,
            )


class _Feedthrough:
    """Which inputs and parameters reach an output at once, without the state.

    q' = s + sum X d e,  s' = ... + sum push u - P^T g,  g = K P q + C P q'; q and s are zero at the start.
    Products are tested entry by entry for zeros, so that no parameter value can add a dependency.
    """

    def __init__(self, network: ModalNetwork) -> None:
        self.network = network
        self.groups: dict[str, Real] = {}  # parameter -> 1 for each elastic mode that it damps
        for name in network.modal_damping:
            mask = np.zeros(len(network.eigenvalues))
            mask[network.components[name]] = 1.0
            self.groups[f"{name}.modal_damping"] = mask * (network.eigenvalues > 0)
        self.damped = sum(self.groups.values(), np.zeros(len(network.eigenvalues)))

    def of(self, output: Output) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Names of the inputs and of the parameters."""
        if output.quantity in ("force", "power"):
            found = self._of_joint(next(j for j in self.network.joints if j.name == output.joint), output)
        elif output.quantity == "displacement" or output.row is None:
            found = set()
        elif output.quantity == "velocity":
            found = self._of_rates(output.row[None])
        else:
            found = self._of_acceleration(output.row)
        inputs = tuple(load.name for load in self.network.loads if load.name in found)
        return inputs, tuple(sorted(found - set(inputs)))

    def _of_rates(self, rows: Real) -> set[str]:
        """What rows . X d e depends on."""
        found = set()
        for load in self.network.loads:
            if load.mesh_displacement is None:
                continue
            terms = np.abs(rows) * np.abs(load.mesh_displacement)
            for parameter, mask in self.groups.items():
                if (terms * mask).any():
                    found |= {load.name, parameter}
        return found

    def _of_joint(self, joint: JointRows, output: Output | None) -> set[str]:
        """What g = C P q' depends on: all the joint's rows, as C couples them, but its own entries only."""
        found = self._of_rates(joint.relative)
        if found:
            found |= {
                v.name
                for v in _matrix_parameters(0, joint, Kind.DAMPING, joint.damping, "")
                if output is None or output.quantity == "power" or output.dof in v.index[1:]
            }
        return found

    def _of_acceleration(self, row: Real) -> set[str]:
        found = set()
        for load in self.network.loads:
            terms = np.abs(row) * np.abs(load.column)
            if load.mesh_displacement is None:
                found |= {load.name} if terms.any() else set()
                continue
            if (terms * (self.network.eigenvalues > 0)).any():
                found.add(load.name)
            found |= {parameter for parameter, mask in self.groups.items() if (terms * mask).any()}
        for joint in self.network.joints:
            if (np.abs(joint.relative) * np.abs(row)).any():
                found |= self._of_joint(joint, None)
        return found
