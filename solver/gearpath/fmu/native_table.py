"""The variable table of the native kind: the common variables, states, source, and in FMI 3 arrays."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from ..components.dofs import is_rotation
from ..network.modal import ModalNetwork
from ..network.records import MeshSource
from ..network.time_twin import state_scale
from ..numerics.arrays import Real
from .dependencies import TORQUE, Dependencies
from .scheduled import followed, torque_inputs
from .variables import (
    Kind,
    Variable,
    check_names,
    checked,
    excitation_of,
    frequency_outputs,
    inputs,
    joint_parameters,
    load_nominal,
    modal_parameters,
    time_outputs,
)

_STATE, _DERIVATIVE = "state", "der(state)"  # the arrays of FMI 3
SPEED_NOMINAL = 1000.0  # rev/min


def native_table(network: ModalNetwork, frequency: float, fmi: str = "2.0") -> tuple[Variable, ...]:
    """All variables of the native FMU, in the order of their value references.

    Inputs, parameters (local where a schedule decides them), outputs over time, outputs over frequency, orders of the
    source, states and their derivatives. FMI 3 has arrays in place of matrix entries and states, ports as arrays as
    well, the matrices of the state equations, and the time. Raises InputError as `variable_table` does.
    """
    check_names(network, frequency)
    arrays = fmi == "3.0"
    names = _state_names(network)
    structure = Dependencies(
        network,
        states=(_STATE,) * len(names) if arrays else names,
        angle=_angle(network, arrays),
        matrices=arrays,
    )
    joints = followed(network, _joint_matrices(network) if arrays else joint_parameters(network))
    coupled = [*joints, *modal_parameters(network)]
    system = tuple(parameter.name for parameter in coupled if parameter.causality == "parameter")
    torque = (TORQUE,) if network.schedule else ()
    table = (
        *inputs(network, frequency),
        *_source_inputs(network.source),
        *torque_inputs(network.schedule),
        *coupled,
        *_source_parameters(network.source),
        *time_outputs(network, structure),
        *(_ports(network, structure) if arrays else ()),
        *frequency_outputs(network, excitation_of(network), system, ("frequency", *torque)),
        *_orders(network.source, system, torque),
        *(_state_arrays(network, system, torque) if arrays else _states(network, structure, names)),
        *(_matrices(network, system) if arrays else ()),
        *((Variable("time", Kind.TIME, (0, 0, 0), "independent", "s", "Simulation time", 1.0),) if arrays else ()),
    )
    return checked(table)


def state_nominals(network: ModalNetwork) -> Real:
    """Typical amplitude of both states of each mode, (N,): what the loads do to it statically, at their own scale."""
    w, X = state_scale(network), network.damping
    push = np.zeros_like(w)
    for load in network.loads:
        d = load.mesh_displacement
        each = load.column if d is None else (network.eigenvalues - X**2) * d
        push = np.maximum(push, np.abs(each) * load_nominal(load))
    nominal = push / w
    return np.maximum(nominal, 1e-3 * nominal.max(initial=0.0) or 1e-6)


def _angle(network: ModalNetwork, arrays: bool) -> str | None:
    if network.source is None:
        return None
    return _STATE if arrays else f"{_prefix(network.source)}.angle"


def _prefix(source: MeshSource) -> str:
    return source.load.rsplit(".", 1)[0]


def _state_names(network: ModalNetwork) -> tuple[str, ...]:
    quoted = {name: f"'{name}'" if "+" in name else name for name in network.components}  # of rigidly joined ones
    modes = [
        f"{quoted[name]}.mode_{k + 1}"
        for name, block in network.components.items()
        for k in range(block.stop - block.start)
    ]
    return (*(f"{mode}.x" for mode in modes), *(f"{mode}.v" for mode in modes))


def _source_inputs(source: MeshSource | None) -> Iterable[Variable]:
    if source is None:
        return
    text = "Speed of the driving shaft, for the gear mesh source; without effect where all its amplitudes are 0"
    yield Variable(
        f"{_prefix(source)}.speed", Kind.SPEED, (0, 0, 0), "input", "rev/min", text, SPEED_NOMINAL, start=source.speed
    )


def _source_parameters(source: MeshSource | None) -> Iterable[Variable]:
    if source is None:
        return
    yield Variable(
        f"{_prefix(source)}.teeth",
        Kind.TEETH,
        (0, 0, 0),
        "parameter",
        "1",
        "Tooth count of the gear on the driving shaft, a whole number",
        10.0,
        start=float(source.teeth),
        minimum=1.0,
        maximum=1e6,
    )
    for i, tone in enumerate(source.tones):
        what = f"harmonic {tone.harmonic:g} of the tooth meshing"
        if tone.shift:
            what = f"the sideband {tone.shift:+g} shaft orders beside {what}"
        for kind, part, unit, start, nominal in (
            (Kind.TONE_AMPLITUDE, "amplitude", "m", tone.amplitude, 1e-6),
            (Kind.TONE_PHASE, "phase", "rad", tone.phase, 1.0),
        ):
            text = f"{part.capitalize()} of {what} in the transmission error"
            yield Variable(f"{tone.name}.{part}", kind, (i, 0, 0), "parameter", unit, text, nominal, start=float(start))


def _orders(source: MeshSource | None, system: tuple[str, ...], torque: tuple[str, ...]) -> Iterable[Variable]:
    if source is None:
        return
    speed, teeth = f"{_prefix(source)}.speed", f"{_prefix(source)}.teeth"
    for i, tone in enumerate(source.tones):
        for kind, part, unit, text, nominal, extra in (
            (Kind.ORDER_FREQUENCY, "frequency", "Hz", "Frequency of this order at the present speed", 1000.0, ()),
            (
                Kind.ORDER_ALPHA,
                "alpha",
                "1",
                "Power through all paths over input power, at that frequency",
                1.0,
                system,
            ),
            (
                Kind.ORDER_POWER,
                "power",
                "W",
                "Time-averaged power through all paths that this order transmits when the speed is steady",
                1e-3,
                (f"{tone.name}.amplitude", *system),
            ),
        ):
            follows = () if kind is Kind.ORDER_FREQUENCY else torque
            yield Variable(
                f"{tone.name}.{part}",
                kind,
                (i, 0, 0),
                "output",
                unit,
                text,
                nominal,
                dependencies=(speed, *follows),
                initial_dependencies=(speed, *follows, teeth, *extra),
            )


def _joint_matrices(network: ModalNetwork) -> Iterable[Variable]:
    for j, joint in enumerate(network.joints):
        d = len(joint.dofs)
        for kind, what, matrix, factor in (
            (Kind.STIFFNESS_MATRIX, "stiffness", joint.stiffness, ""),
            (Kind.DAMPING_MATRIX, "damping", joint.damping, ".s"),
        ):
            symmetric = 0.5 * (matrix + matrix.T)
            text = f"{what.capitalize()} of {joint.name}, symmetric, on {', '.join(joint.dofs)}"
            scale = float(np.abs(symmetric).max(initial=0.0)) or 1.0
            rotation = all(is_rotation(dof) for dof in joint.dofs)
            translation = not any(is_rotation(dof) for dof in joint.dofs)
            unit = f"N.m{factor}/rad" if rotation else f"N{factor}/m" if translation else None
            start = tuple(float(value) for value in symmetric.ravel())
            shape = () if joint.scalar else (d, d)
            yield Variable(
                f"{joint.name}.{what}",
                kind,
                (j, 0, 0),
                "parameter",
                unit,
                text + ("" if unit else ": N, m and rad, the entries having different units"),
                scale,
                start=start[0] if joint.scalar else start,
                shape=shape,
                minimum=0.0 if joint.scalar else None,
            )


def _ports(network: ModalNetwork, structure: Dependencies) -> Iterable[Variable]:
    for j, joint in enumerate(network.joints):
        mixed = len({is_rotation(dof) for dof in joint.dofs}) > 1
        rotation = is_rotation(joint.dofs[0])
        for kind, part, units, nominal in (
            (Kind.PORT_FORCES, "force", ("N", "N.m"), 100.0),
            (Kind.PORT_VELOCITIES, "velocity", ("m/s", "rad/s"), 1e-3),
        ):
            unknown = structure.of_port(joint, force=kind is Kind.PORT_FORCES)
            side = "Forces and moments on" if kind is Kind.PORT_FORCES else "Velocities of"
            yield Variable(
                f"{joint.name}.{part}",
                kind,
                (j, 0, 0),
                "output",
                None if mixed else units[rotation],
                f"{side} the receiver of {joint.name}: {', '.join(joint.dofs)}",
                nominal,
                shape=(len(joint.dofs),),
                dependencies=unknown.knowns,
                initial_dependencies=unknown.initial,
            )


def _states(network: ModalNetwork, structure: Dependencies, names: Sequence[str]) -> Iterable[Variable]:
    nominals = np.tile(state_nominals(network), 2)
    N, source = len(network.eigenvalues), network.source
    for i, name in enumerate(names):
        text = "Modal displacement times the angular frequency of the mode" if i < N else "Modal velocity"
        nominal = float(nominals[i])
        yield Variable(name, Kind.STATE, (i, 0, 0), "local", None, f"{text}, mass-normalised", nominal, start=0.0)
    if source is not None:
        text = "Angle that the driving shaft has turned"
        yield Variable(f"{_prefix(source)}.angle", Kind.STATE, (2 * N, 0, 0), "local", "rad", text, 1.0, start=0.0)
    for i, name in enumerate(names):
        unknown = structure.of_derivative(i)
        nominal = float(nominals[i] * state_scale(network)[i % N])
        yield Variable(
            f"der({name})",
            Kind.DERIVATIVE,
            (i, 0, 0),
            "local",
            None,
            f"Derivative of {name}",
            nominal,
            dependencies=unknown.knowns,
            initial_dependencies=unknown.initial,
            derivative_of=name,
        )
    if source is not None:
        name, speed = f"{_prefix(source)}.angle", f"{_prefix(source)}.speed"
        yield Variable(
            f"der({name})",
            Kind.DERIVATIVE,
            (2 * N, 0, 0),
            "local",
            "rad/s",
            "Angular velocity of the driving shaft",
            100.0,
            dependencies=(speed,),
            initial_dependencies=(speed,),
            derivative_of=name,
        )


def _state_arrays(network: ModalNetwork, system: tuple[str, ...], torque: tuple[str, ...]) -> Iterable[Variable]:
    size = 2 * len(network.eigenvalues) + (network.source is not None)
    text = "Modal displacements times angular frequencies, then modal velocities, mass-normalised"
    if network.source is not None:
        text += "; at last the angle of the driving shaft, rad"
    nominal = float(state_nominals(network).max())
    yield Variable(_STATE, Kind.STATES, (0, 0, 0), "local", None, text, nominal, start=(0.0,) * size, shape=(size,))
    loads = [load.name for load in network.loads]
    source: tuple[str, ...] = ()
    if network.source is not None:
        loads.append(f"{_prefix(network.source)}.speed")
        tones = (f"{tone.name}.{part}" for tone in network.source.tones for part in ("amplitude", "phase"))
        source = (f"{_prefix(network.source)}.teeth", *tones)
    yield Variable(
        _DERIVATIVE,
        Kind.DERIVATIVES,
        (0, 0, 0),
        "local",
        None,
        "Derivatives of the states",
        nominal * float(np.median(state_scale(network))),
        shape=(size,),
        dependencies=(*loads, *torque, _STATE),
        initial_dependencies=(*loads, *torque, _STATE, *system, *source),
        derivative_of=_STATE,
    )


def _matrices(network: ModalNetwork, system: tuple[str, ...]) -> Iterable[Variable]:
    n, m = 2 * len(network.eigenvalues), len(network.loads)
    linear = [output for output in network.outputs if output.quantity != "power"]
    p = len(linear)
    states, loads, outputs = "the states", "the loads", "the outputs over time that are no powers, in their order"
    # A and C are what remains without loads, B and D what loads do to the system at rest
    free = Dependencies(replace(network, loads=(), source=None), states=(_STATE,) * n, matrices=True)
    driven = Dependencies(replace(network, source=None), at_rest=True, matrices=True)
    for kind, name, shape, rows, columns, structure in (
        (Kind.MATRIX_A, "A", (n, n), "derivatives of the states", states, free),
        (Kind.MATRIX_B, "B", (n, m), "derivatives of the states", loads, driven),
        (Kind.MATRIX_C, "C", (p, n), outputs, states, free),
        (Kind.MATRIX_D, "D", (p, m), outputs, loads, driven),
    ):
        if 0 in shape:
            continue
        unknowns = map(structure.of_output, linear) if name in "CD" else [structure.of_derivatives()]
        found = {known for unknown in unknowns for known in unknown.initial}
        yield Variable(
            f"system.{name}",
            kind,
            (0, 0, 0),
            "local" if TORQUE in found else "calculatedParameter",  # a parameter cannot follow an input
            None,
            f"Matrix {name} of the state equations x' = A x + B u, y = C x + D u: {rows} by {columns}",
            1.0,
            shape=shape,
            initial_dependencies=tuple(parameter for parameter in system if parameter in found),
        )
