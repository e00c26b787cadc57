"""Vibratory power flow through the joints: input, transmitted by path, dissipated by element (Eq. 5)."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..components.dofs import is_rotation
from ..numerics.arrays import Complex, Real
from ..numerics.lines import chunks, real_times_complex
from .measured import port_forces
from .modal import ModalNetwork
from .records import Load
from .synthesis import Response, Synthesis, load_power


@dataclass(frozen=True)
class PowerFlow:
    """Time-averaged powers (W) at an excitation of the given amplitude; F lines, p paths, e elements."""

    paths: tuple[str, ...]  # joint and degree of freedom, such as "bearing_1.uy"
    elements: tuple[str, ...]  # what dissipates: components, then joints
    input_power: Real  # (F,)
    path_power: Real  # (p, F), positive into the receiver
    force: Complex  # (p, F), acts on the receiver
    velocity_source: Complex  # (p, F)
    velocity_receiver: Complex  # (p, F)
    dissipated_power: Real  # (e, F)

    @property
    def transmitted_power(self) -> Real:
        """Net power through all paths, W."""
        return np.asarray(self.path_power.sum(axis=0))

    def share(self, chosen: Callable[[str], bool] = lambda _: True) -> Real:
        """Power through the chosen paths relative to the input power (alpha, Eq. 5a); 0 where no power enters."""
        rows = [k for k, path in enumerate(self.paths) if chosen(path)]
        return ratio(self.path_power[rows].sum(axis=0), self.input_power)


def ratio(power: Real, reference: Real) -> Real:
    """power / reference, and 0 where the reference is 0 (no excitation reaches the structure)."""
    return np.divide(power, reference, out=np.zeros_like(power), where=reference != 0.0)


def is_moment_path(path: str) -> bool:
    """Whether a path such as "bearing_1.rx" carries a moment."""
    return is_rotation(path.rsplit(".", 1)[1])


@dataclass(frozen=True)
class PathRows:
    """Where the power flow paths stand in the interface."""

    names: tuple[str, ...]  # joint and degree of freedom
    interface: list[int]  # their places among the stacked joint degrees of freedom
    receiver: Real  # (p, N): motion of the receivers
    elements: tuple[str, ...]  # what dissipates: components, then joints


def path_rows(network: ModalNetwork) -> PathRows:
    """The power flow paths of a network, and its elements."""
    slices = network.joint_slices()
    joints = [joint for joint in network.joints if joint.name in network.paths]
    return PathRows(
        names=tuple(f"{joint.name}.{dof}" for joint in joints for dof in joint.dofs),
        interface=[i for joint in joints for i in range(slices[joint.name].start, slices[joint.name].stop)],
        receiver=np.vstack([np.zeros((0, len(network.eigenvalues))), *(joint.receiver for joint in joints)]),
        elements=(*network.components, *(joint.name for joint in network.joints)),
    )


def power_flow(
    network: ModalNetwork,
    omega: Real,
    amplitude: float = 1.0,
    progress: Callable[[int], None] = lambda _: None,
) -> PowerFlow:
    """Power flow of the network's excitation at the angular frequencies `omega` (rad/s, positive).

    Computed in chunks of bounded memory; `progress` is told how many lines were added.
    """
    load = next(item for item in network.loads if item.name == network.excitation)
    synthesis = Synthesis(network, [load])
    rows = path_rows(network)
    lines, paths = len(omega), len(rows.names)
    flow = PowerFlow(
        paths=rows.names,
        elements=rows.elements,
        input_power=np.empty(lines),
        path_power=np.empty((paths, lines)),
        force=np.empty((paths, lines), complex),
        velocity_source=np.empty((paths, lines), complex),
        velocity_receiver=np.empty((paths, lines), complex),
        dissipated_power=np.empty((len(rows.elements), lines)),
    )
    for part in chunks(lines, synthesis.bytes_per_line):
        w = omega[part]
        solved = synthesis.solve(w)
        g, velocity = solved.force[:, 0], solved.velocity[:, 0]
        flow.input_power[part] = amplitude**2 * load_power(network, load, solved, 0, w)
        flow.force[:, part] = amplitude * g[rows.interface]
        v, slip = real_times_complex(rows.receiver, velocity), real_times_complex(synthesis.P, velocity)
        flow.velocity_receiver[:, part] = amplitude * v
        flow.velocity_source[:, part] = amplitude * (v + slip[rows.interface])
        v, F = flow.velocity_receiver[:, part], flow.force[:, part]
        flow.path_power[:, part] = 0.5 * (v.real * F.real + v.imag * F.imag)
        flow.dissipated_power[:, part] = amplitude**2 * _dissipation(network, load, solved, slip, w)
        progress(len(w))
    return flow


def _dissipation(network: ModalNetwork, load: Load, solved: Response, slip: Complex, omega: Real) -> Real:
    """Power lost in every element, (e, F): 1/2 q'^H X q' of components, 1/2 dv^H C dv of joints.

    `slip` is the relative velocity dv of all joints, stacked. Loss factors add eta L / w to X and eta K / w to C.
    A measured component takes 1/2 Re(f^H v) of the forces f on its channels.
    """
    damping, joints = element_damping(network, omega)
    elastic = solved.elastic[:, 0]
    lost = 0.5 * damping * (elastic.real**2 + elastic.imag**2)
    for name in network.measured:
        block = network.components[name]
        lost[block] = 0.5 * (port_forces(network, [load], solved.force, block)[:, 0].conj() * elastic[block]).real
    rows = [lost[modes].sum(axis=0) for modes in network.components.values()]
    for places, weight in inner_damping(network, omega):
        for k, name in enumerate(network.components):
            if name in places:
                rows[k] += 0.5 * (abs(slip[places[name]]) ** 2).sum(axis=0) * weight
    for at, (C, K_lost) in zip(network.joint_slices().values(), joints):
        drag = real_times_complex(C, slip[at])
        if K_lost.any():
            drag += real_times_complex(K_lost, slip[at]) / omega
        rows.append(0.5 * (slip[at].real * drag.real + slip[at].imag * drag.imag).sum(axis=0))
    return np.array(rows)


def inner_damping(network: ModalNetwork, omega: Real) -> list[tuple[dict[str, slice], Real]]:
    """Interface rows inside components, and what they dissipate at unit velocity, (F,): 1 of D, 1 / w of losses E."""
    return [(network.dashpot_slices(), np.ones_like(omega)), (network.loss_slices(), 1.0 / omega)]


def element_damping(network: ModalNetwork, omega: Real) -> tuple[Real, list[tuple[Real, Real]]]:
    """What dissipates: X + eta L / w of the modes, (N, F) or (N, 1), and C and eta K of every joint (C + eta K / w)."""
    damping = network.damping[:, None]
    if network.loss_factors:
        damping = damping + network.hysteresis[:, None] / omega
    return damping, [(joint.damping, joint.loss_factor * joint.stiffness) for joint in network.joints]
