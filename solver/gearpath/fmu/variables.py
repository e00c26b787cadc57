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
from ..network.records import JointRows, Load
from ..numerics.arrays import Real
from .dependencies import Dependencies


class Kind(IntEnum):
    """What a variable stands for; the numbers are those of `GP_INPUT` ... in fmu_src/gp_model.h."""

    INPUT = 0
    FREQUENCY = 1
    SPEED = 2
    STIFFNESS = 3
    DAMPING = 4
    MODAL_DAMPING = 5
    TEETH = 6
    TONE_AMPLITUDE = 7
    TONE_PHASE = 8
    OUTPUT = 9
    ALPHA = 10
    JOINT_ALPHA = 11
    FRF_REAL = 12
    FRF_IMAG = 13
    ORDER_FREQUENCY = 14
    ORDER_ALPHA = 15
    ORDER_POWER = 16
    STATE = 19
    DERIVATIVE = 20
    TIME = 25
    TORQUE = 26
    # arrays
    STIFFNESS_MATRIX = 64
    DAMPING_MATRIX = 65
    PORT_FORCES = 66
    PORT_VELOCITIES = 67
    STATES = 68
    DERIVATIVES = 69
    MATRIX_A = 70
    MATRIX_B = 71
    MATRIX_C = 72
    MATRIX_D = 73
    DESIGN = 127  # of the python kind only: what needs the components rebuilt


Causality = Literal["input", "parameter", "output", "local", "calculatedParameter", "independent"]


@dataclass(frozen=True)
class Variable:
    """A Real (FMI 3: Float64) variable of the FMU; its value reference is its place in the table."""

    name: str
    kind: Kind
    index: tuple[int, int, int]  # into the network's loads, joints, outputs ...; what it means depends on the kind
    causality: Causality
    unit: str | None  # None where SI has none, such as for mass-normalised states
    description: str
    nominal: float
    start: float | tuple[float, ...] | None = None  # None for what is calculated; arrays row by row
    minimum: float | None = None
    maximum: float | None = None
    dependencies: tuple[str, ...] = ()  # of an unknown, on inputs and states, at a communication point
    initial_dependencies: tuple[str, ...] = ()  # of an unknown, on inputs, states and parameters, at the start
    shape: tuple[int, ...] = ()  # of an array
    derivative_of: str | None = None  # the state whose derivative it is


# One bname of FMI's structured naming convention, or several with dots; a joined body, as 'casing+frame', is quoted.
_NAME = re.compile(r"([A-Za-z_]\w*|'\w+(\+\w+)+')(\.[A-Za-z_]\w*)*", re.ASCII)
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
    check_names(network, frequency)
    parameters = [*joint_parameters(network), *modal_parameters(network)]
    table = (
        *inputs(network, frequency),
        *parameters,
        *time_outputs(network, Dependencies(network, at_rest=True)),
        *frequency_outputs(network, excitation_of(network), tuple(p.name for p in parameters)),
    )
    return checked(table)


def check_names(network: ModalNetwork, frequency: float) -> None:
    """Refuse a frequency, an excitation or a path that does not exist."""
    if not (np.isfinite(frequency) and frequency > 0):
        raise InputError(f"the start value of the frequency input is {frequency} Hz; give a positive number")
    excitation_of(network)
    for path in network.paths:
        if path not in {joint.name for joint in network.joints}:
            raise InputError(f"the path {path!r} is none of the network's joints; name one of them")


def excitation_of(network: ModalNetwork) -> Load:
    """The load that power ratios and transfers refer to."""
    excitation = next((load for load in network.loads if load.name == network.excitation), None)
    if excitation is None:
        raise InputError(f"the excitation {network.excitation!r} is none of the network's loads; name one of them")
    return excitation


def checked(table: tuple[Variable, ...]) -> tuple[Variable, ...]:
    """The table, after a look at its names."""
    seen: set[str] = set()
    for variable in table:
        name = re.sub(r"^der\((.*)\)$", r"\1", re.sub(r"\[\d+,\d+\]$", "", variable.name))
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


def inputs(network: ModalNetwork, frequency: float) -> Iterable[Variable]:
    """All loads, and the frequency of the frequency-domain outputs."""
    for k, load in enumerate(network.loads):
        error = load.is_transmission_error
        what = "Transmission error in the gear mesh" if error else "Force or moment from outside"
        yield Variable(load.name, Kind.INPUT, (k, 0, 0), "input", load.unit, what, load_nominal(load), start=0.0)
    yield Variable(
        "frequency",
        Kind.FREQUENCY,
        (0, 0, 0),
        "input",
        "Hz",
        "Frequency of the frequency-domain outputs (its magnitude); without effect on the others",
        1000.0,
        start=float(frequency),
    )


def load_nominal(load: Load) -> float:
    """A typical amplitude, m or N."""
    return 1e-6 if load.is_transmission_error else 1.0


def joint_parameters(network: ModalNetwork) -> Iterable[Variable]:
    """Every entry of the upper halves of K and C of all joints."""
    for j, joint in enumerate(network.joints):
        for kind, matrix, factor in (
            (Kind.STIFFNESS, joint.stiffness, ""),
            (Kind.DAMPING, joint.damping, ".s"),
        ):
            yield from matrix_parameters(j, joint, kind, matrix, factor)


def matrix_parameters(j: int, joint: JointRows, kind: Kind, matrix: Real, factor: str) -> Iterable[Variable]:
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


def modal_parameters(network: ModalNetwork) -> Iterable[Variable]:
    """The damping ratio of every component that has elastic modes."""
    for g, (name, ratio) in enumerate(network.modal_damping.items()):
        yield Variable(
            f"{name}.modal_damping",
            Kind.MODAL_DAMPING,
            (g, 0, 0),
            "parameter",
            "1",
            _damping_text(network, name),
            0.01,
            start=float(ratio),
            minimum=0.0,
            maximum=float(np.nextafter(1.0, 0.0)),
        )


def _damping_text(network: ModalNetwork, name: str) -> str:
    if name in network.damping_shares:
        return f"Damping ratio of {name}, below 1; its modes keep their parts of it"
    return f"Damping ratio of every elastic free-free mode of {name}, below 1"


def time_outputs(network: ModalNetwork, structure: Dependencies) -> Iterable[Variable]:
    """All outputs over time: forces on the receivers, motions, powers."""
    for o, output in enumerate(network.outputs):
        unknown = structure.of_output(output)
        yield Variable(
            output.name,
            Kind.OUTPUT,
            (o, 0, 0),
            "output",
            output.unit,
            f"{_QUANTITY[output.quantity].capitalize()}, over time",
            _NOMINAL[output.quantity],
            dependencies=unknown.knowns,
            initial_dependencies=unknown.initial,
        )


def frequency_outputs(
    network: ModalNetwork, excitation: Load, parameters: tuple[str, ...], inputs: tuple[str, ...] = ("frequency",)
) -> Iterable[Variable]:
    """Power ratios and transfers at the input frequency; `parameters` and `inputs` are all that change them."""
    initial = (*inputs, *parameters)

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
            dependencies=inputs,
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
                _NOMINAL[output.quantity] / load_nominal(excitation),
                dependencies=inputs,
                initial_dependencies=initial,
            )
