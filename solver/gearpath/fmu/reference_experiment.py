"""The reference experiment: swept sines in all loads, and the outputs that must come out.

They come from the propagator of the whole state equations (numerics/propagator.py), not from the FMU, which integrates
mode by mode. The same inputs have two answers, for inputs that are held between rows and for inputs that vary linearly:

    x(t + h) = Phi x(t) + held u(t) [+ ramp (u(t + h) - u(t))],     y(t + h) = C x(t + h) + D u(t)  [D u(t + h)]

so a row of outputs holds what an importer reads at the end of a step, before it sets the next inputs. A gear mesh
source adds its tones, each an undamped oscillator beside the states.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..network.modal import ModalNetwork
from ..network.power import is_moment_path, power_flow
from ..network.records import JointRows, MeshSource, Output
from ..network.time_twin import time_twin
from ..numerics.arrays import Real
from ..numerics.propagator import discretise
from .variables import Kind, Variable, load_nominal

_HIGHEST = 0.1  # of the sampling rate: where the sweeps end


@dataclass(frozen=True)
class Answer:
    """Outputs over time under one reading of the inputs."""

    name: str
    words: str
    columns: Mapping[str, Real]  # by variable, in their order


def answers(
    network: ModalNetwork, variables: Sequence[Variable], inputs: Mapping[str, Real], step: float
) -> list[Answer]:
    """Outputs for held and for linear inputs; `inputs` (rows,) of every load, `step` (s) between rows."""
    needed = _linear_outputs(network)
    u, constant = np.column_stack([inputs[load.name] for load in network.loads]), _ratios(network, variables)
    words = {"held": "inputs held from row to row", "linear": "inputs linear between the rows"}
    found = []
    for name, values in zip(words, _simulated(network, needed, u, step)):
        series = dict(zip((output.name for output in needed), values.T))
        found.append(Answer(name, words[name], _shown(network, variables, series, constant, len(u))))
    return found


def sweeps(network: ModalNetwork, times: Real) -> dict[str, Real]:
    """A swept sine for every load, from standstill to a tenth of the sampling rate, each with an end of its own."""
    return {
        load.name: load_nominal(load) * swept(times, k / len(network.loads)) for k, load in enumerate(network.loads)
    }


def swept(times: Real, place: float) -> Real:
    """A sine swept from standstill to a tenth of the sampling rate, less the higher its place from 0 to 1 is."""
    t, span = times - times[0], times[-1] - times[0]
    highest = _HIGHEST * (len(times) - 1) / span
    return np.asarray(np.sin(np.pi * highest * (1.0 - 0.5 * place) * t**2 / span))


def _linear_outputs(network: ModalNetwork) -> list[Output]:
    """All outputs but powers, then what powers are made of."""
    found = [output for output in network.outputs if output.quantity != "power"]
    for joint in _joints_with_power(network):
        for i, dof in enumerate(joint.dofs):
            found.append(Output(f"({joint.name}.force_{dof})", "", "force", joint=joint.name, dof=i))
            found.append(Output(f"({joint.name}.velocity_{dof})", "", "velocity", row=joint.receiver[i]))
    return found


def _joints_with_power(network: ModalNetwork) -> list[JointRows]:
    wanted = {output.joint for output in network.outputs if output.quantity == "power"}
    return [joint for joint in network.joints if joint.name in wanted]


def _simulated(network: ModalNetwork, outputs: Sequence[Output], u: Real, step: float) -> tuple[Real, Real]:
    """Outputs for held and for linear inputs; u (rows, loads)."""
    twin = time_twin(network, outputs)
    A, B, C, D, x = twin.A, twin.B, twin.C, twin.D, np.zeros(len(twin.A))
    if network.source is not None:
        load = [item.name for item in network.loads].index(network.source.load)
        turn, read, begin = oscillators(network.source)
        A = np.block([[A, np.outer(B[:, load], read)], [np.zeros((len(turn), len(A))), turn]])
        B, C = np.vstack([B, np.zeros((len(turn), B.shape[1]))]), np.hstack([C, np.outer(D[:, load], read)])
        x = np.concatenate([x, begin])
    over = discretise(A, B, step)
    drive = np.stack([u[:-1] @ over.held.T, u[:-1] @ over.held.T + np.diff(u, axis=0) @ over.ramp.T], axis=-1)
    states = np.empty((len(u), len(x), 2))
    states[0] = x[:, None]
    for k, push in enumerate(drive):
        states[k + 1] = over.transition @ states[k] + push
    before = np.vstack([u[:1], u[:-1]])
    return (
        np.asarray(states[..., 0] @ C.T + before @ D.T),
        np.asarray(states[..., 1] @ C.T + u @ D.T),
    )


def oscillators(source: MeshSource) -> tuple[Real, Real, Real]:
    """W, r and z(0) with z' = W z and the transmission error of the source r z, at its steady start speed."""
    orders = np.array([tone.harmonic * source.teeth + tone.shift for tone in source.tones])
    amplitude, phase = (np.array([getattr(t, part) for t in source.tones]) for part in ("amplitude", "phase"))
    omega = orders * source.speed * 2.0 * np.pi / 60.0
    count = len(omega)
    W = np.block([[np.zeros((count, count)), -np.diag(omega)], [np.diag(omega), np.zeros((count, count))]])
    read = np.concatenate([amplitude * np.cos(phase), -amplitude * np.sin(phase)])
    return W, read, np.repeat([1.0, 0.0], count)


def _ratios(network: ModalNetwork, variables: Sequence[Variable]) -> dict[str, float]:
    """Power ratios at the start value of the input frequency."""
    wanted = [v for v in variables if v.kind in (Kind.ALPHA, Kind.JOINT_ALPHA)]
    hertz = next((v.start for v in variables if v.kind is Kind.FREQUENCY), None)
    if not wanted or not isinstance(hertz, float):
        return {}
    flow = power_flow(network, np.array([2.0 * np.pi * hertz]))
    ratios = {
        "alpha": flow.share(),
        "alpha_force": flow.share(lambda path: not is_moment_path(path)),
        "alpha_moment": flow.share(is_moment_path),
    }
    for joint in network.paths:
        ratios[f"{joint}.alpha"] = flow.share(lambda path, own=joint: path.rsplit(".", 1)[0] == own)  # type: ignore[misc]
    return {v.name: float(ratios[v.name][0]) for v in wanted}


def _shown(
    network: ModalNetwork,
    variables: Sequence[Variable],
    series: Mapping[str, Real],
    constant: Mapping[str, float],
    rows: int,
) -> dict[str, Real]:
    """The columns of an answer, in the order of the variables."""
    joints, columns = {joint.name: joint for joint in network.joints}, {}
    for variable in variables:
        if variable.name in constant:
            columns[variable.name] = np.full(rows, constant[variable.name])
        if variable.kind is not Kind.OUTPUT:
            continue
        output = network.outputs[variable.index[0]]
        if output.quantity == "power":
            assert output.joint is not None
            name = f"({output.joint}.{{part}}_{{dof}})"
            forces, velocities = (
                np.array([series[name.format(part=part, dof=dof)] for dof in joints[output.joint].dofs])
                for part in ("force", "velocity")
            )
            columns[variable.name] = (forces * velocities).sum(axis=0)
        else:
            columns[variable.name] = series[output.name]
    return columns
