"""Which inputs, states and parameters an unknown of the FMU depends on at once."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..network.modal import ModalNetwork
from ..network.records import JointRows, Output
from ..numerics.arrays import Real

TORQUE = "operation.torque"  # the input that decides scheduled matrices
Mask = np.ndarray[tuple[int, ...], np.dtype[np.bool_]]


@dataclass(frozen=True)
class Unknown:
    """The names of what an unknown depends on."""

    knowns: tuple[str, ...]  # inputs and states
    parameters: tuple[str, ...]

    @property
    def initial(self) -> tuple[str, ...]:
        """What it depends on in initialisation, where parameters are knowns too."""
        return (*self.knowns, *self.parameters)


class Dependencies:
    """The structure of the time twin.

    q' = s + sum X d e,  s' = -L q - X s + sum push u - P^T g,  g = K P q + C P q'. Products are tested entry by entry
    for zeros, so that no parameter value can add a dependency. `at_rest`: the states are no variables and zero at
    the start; else `states` names the 2N of them (the same name for all in an array). `matrices`: joint matrices are
    variables as a whole, not by entry.
    """

    def __init__(
        self,
        network: ModalNetwork,
        *,
        at_rest: bool = False,
        states: tuple[str, ...] = (),
        angle: str | None = None,
        matrices: bool = False,
    ) -> None:
        self.network, self.at_rest, self.states, self.angle, self.matrices = network, at_rest, states, angle, matrices
        N = len(network.eigenvalues)
        self.elastic: Mask = network.eigenvalues > 0
        self.groups: dict[str, Mask] = {}  # parameter -> the elastic modes that it damps
        for name in network.modal_damping:
            self.groups[f"{name}.modal_damping"] = (network.damping_share(name) != 0) & self.elastic
        self.damped: Mask = np.any([*self.groups.values(), np.zeros(N, bool)], axis=0)
        self.acts: dict[str, Mask] = {joint.name: joint.relative != 0 for joint in network.joints}  # (rows, N)
        self.joints = {joint.name: joint for joint in network.joints}
        schedule = network.schedule
        self.tables: dict[str, Mapping[str, Real]] = {  # of the joints that follow the torque
            "stiffness": schedule.stiffness if schedule else {},
            "damping": schedule.damping if schedule else {},
        }
        self._forces: dict[tuple[str, int | None], _Found] = {}  # what was found for each, as it is asked for often

    def of_output(self, output: Output) -> Unknown:
        """What an output over time depends on."""
        found = _Found(len(self.network.eigenvalues))
        if output.joint is not None:
            joint = self.joints[output.joint]
            self._force(found, joint, None if output.quantity == "power" else output.dof)
            if output.quantity == "power":
                self._rates(found, (joint.receiver != 0).any(axis=0))
        elif output.row is not None:
            row = output.row != 0
            if output.quantity == "displacement":
                found.x |= row
            elif output.quantity == "velocity":
                self._rates(found, row)
            else:
                self._accelerations(found, row)
        return self._named(found)

    def of_port(self, joint: JointRows, *, force: bool) -> Unknown:
        """What the forces, or the receiver's velocities, of a joint depend on."""
        found = _Found(len(self.network.eigenvalues))
        if force:
            self._force(found, joint, None)
        else:
            self._rates(found, (joint.receiver != 0).any(axis=0))
        return self._named(found)

    def of_derivative(self, state: int) -> Unknown:
        """What the derivative of one of the 2N states depends on."""
        N = len(self.network.eigenvalues)
        found, mode = _Found(N), np.zeros(N, bool)
        mode[state % N] = True
        if state < N:
            self._rates(found, mode)
        else:
            self._accelerations(found, mode)
        return self._named(found)

    def of_derivatives(self) -> Unknown:
        """What the derivatives of all states depend on together."""
        found = _Found(len(self.network.eigenvalues))
        self._rates(found, np.ones_like(found.x))
        self._accelerations(found, np.ones_like(found.x))
        return self._named(found)

    def _rates(self, found: "_Found", modes: Mask) -> None:
        """q' of some modes."""
        found.v |= modes
        for load in self.network.loads:
            if load.mesh_displacement is None:
                continue
            terms = modes & (load.mesh_displacement != 0)
            dampers = {name for name, mask in self.groups.items() if (terms & mask).any()}
            if dampers:
                found.inputs.add(load.name)
                found.parameters |= dampers

    def _force(self, found: "_Found", joint: JointRows, dof: int | None) -> None:
        """g = K P q + C P q': all the joint's rows, as K and C couple them, but one row of entries only.

        Zeros in the tables of a schedule stay zero.
        """
        if (joint.name, dof) not in self._forces:
            force = self._forces[joint.name, dof] = _Found(len(found.x))
            acts = self.acts[joint.name]
            self._rates(force, np.asarray(acts[self._coupled(joint, "damping", dof)].any(axis=0)))
            force.x |= acts[self._coupled(joint, "stiffness", dof)].any(axis=0)
            for what in ("stiffness", "damping"):
                if not self.at_rest or (force.inputs and what == "damping"):
                    force.parameters |= self._entries(joint, what, dof)
        found.add(self._forces[joint.name, dof])

    def _accelerations(self, found: "_Found", modes: Mask) -> None:
        """s' of some modes."""
        found.x |= modes & self.elastic
        found.v |= modes & self.damped
        dampers = {name for name, mask in self.groups.items() if (modes & mask).any()}
        if not self.at_rest:
            found.parameters |= dampers
        for load in self.network.loads:
            terms = modes & (load.column != 0)
            if not load.is_transmission_error:
                found.inputs |= {load.name} if terms.any() else set()
                continue
            if (terms & self.elastic).any():
                found.inputs.add(load.name)
            found.parameters |= {name for name, mask in self.groups.items() if (terms & mask).any()}
        for D in self.network.dashpots.values():  # what they couple, they couple always
            for row in D[(D[:, modes] != 0).any(axis=1)]:
                self._rates(found, row != 0)
        for joint in self.network.joints:
            for dof in np.flatnonzero((self.acts[joint.name] & modes).any(axis=1)):
                self._force(found, joint, int(dof))

    def _coupled(self, joint: JointRows, what: str, dof: int | None) -> Mask:
        """The degrees of freedom whose motion a matrix turns into this force (d,): all where it is tunable."""
        if joint.name not in self.tables[what]:
            return np.ones(len(joint.dofs), bool)
        entries = (self.tables[what][joint.name] != 0).any(axis=0)
        return np.asarray(entries.any(axis=0) if dof is None else entries[dof])

    def _entries(self, joint: JointRows, what: str, dof: int | None) -> set[str]:
        if joint.name in self.tables[what]:
            table = self.tables[what][joint.name]
            rows = table if dof is None else table[:, dof]
            return {TORQUE} if (rows != rows[0]).any() else set()
        size = len(joint.dofs)
        if joint.scalar or self.matrices:
            return {f"{joint.name}.{what}"}
        return {
            f"{joint.name}.{what}[{i + 1},{k + 1}]"
            for i in range(size)
            for k in range(i, size)
            if dof is None or dof in (i, k)
        }

    def _named(self, found: "_Found") -> Unknown:
        source = self.network.source
        parameters, knowns = set(found.parameters), []
        if not self.at_rest:
            active = np.flatnonzero(np.concatenate([found.x, found.v]))
            knowns = list(dict.fromkeys(self.states[i] for i in active))
        if source is not None and self.angle and source.load in found.inputs:
            knowns += [self.angle] if self.angle not in knowns else []
            prefix = source.load.rsplit(".", 1)[0]
            parameters |= {f"{prefix}.teeth"}
            parameters |= {f"{tone.name}.{what}" for tone in source.tones for what in ("amplitude", "phase")}
        inputs = [load.name for load in self.network.loads if load.name in found.inputs]
        if TORQUE in parameters:  # an input that stands where parameters do
            parameters.remove(TORQUE)
            inputs.append(TORQUE)
        return Unknown((*inputs, *knowns), tuple(sorted(parameters)))


class _Found:
    """What has been found for an unknown so far."""

    def __init__(self, modes: int) -> None:
        self.x, self.v = np.zeros(modes, bool), np.zeros(modes, bool)  # displacements and velocities of modes
        self.inputs: set[str] = set()
        self.parameters: set[str] = set()

    def add(self, other: "_Found") -> None:
        """What another unknown depends on, too."""
        self.x |= other.x
        self.v |= other.v
        self.inputs |= other.inputs
        self.parameters |= other.parameters
