"""Several systems one after another by python-control, the state carried over: what a change of joints must do."""

import control
import numpy as np
from fmi3_driver import Fmu3
from fmu_driver import OK, Fmu

from gearpath.statespace import state_space


class Piece:
    """A network as long as nothing is changed: its state equations as python-control has them, and its powers."""

    def __init__(self, network) -> None:
        self.network, self.space = network, state_space(network)
        self.half = self.space.nstates // 2
        top = np.arange(self.half)
        self.scale = self.space.A[top, top + self.half]  # w of the states w q
        self.powers = [o for o in network.outputs if o.quantity == "power"]
        self.names = [*(label.replace("/", ".") for label in self.space.output_labels), *(o.name for o in self.powers)]

    def rates(self, x, u) -> np.ndarray:
        """q' (steps, N) from the upper half of the state equations."""
        A, B = self.space.A[: self.half], self.space.B[: self.half]
        return (x @ A.T + u @ B.T) / self.scale

    def all_outputs(self, x, u) -> np.ndarray:
        """The linear outputs, and the powers as forces times velocities of the receiver."""
        linear, rate, q = x @ self.space.C.T + u @ self.space.D.T, self.rates(x, u), x[:, : self.half] / self.scale
        joints = {joint.name: joint for joint in self.network.joints}
        powers = []
        for output in self.powers:
            joint = joints[output.joint]
            P = joint.source - joint.receiver
            g = q @ (joint.stiffness @ P).T + rate @ (joint.damping @ P).T
            powers.append((g * (rate @ joint.receiver.T)).sum(axis=1))
        return np.column_stack([linear, *powers])

    def follow(self, x, u, h: float, linear: bool) -> np.ndarray:
        """States (steps + 1, n) from x under the inputs u (steps + 1, m), straight lines or held."""
        system = self.space if linear else control.sample_system(self.space, h, "zoh")
        found = control.forced_response(system, h * np.arange(len(u)), u.T, x, return_states=True)
        return found.states.T

    def after(self, before: "Piece", x, u) -> np.ndarray:
        """The state after a change from `before` under the inputs u: no mode's displacement or velocity jumps."""
        moved = x.copy()
        moved[self.half :] += (before.space.B[: self.half] - self.space.B[: self.half]) @ u / self.scale
        return moved


def simulate(pieces, lengths, u, h: float, *, linear: bool) -> np.ndarray:
    """All outputs before each step and after the last, of the system that is next; the state begins at 0."""
    x, at, found = np.zeros(pieces[0].space.nstates), 0, []
    for k, (piece, length) in enumerate(zip(pieces, lengths)):
        if k:
            x = piece.after(pieces[k - 1], x, u[at])
        states = piece.follow(x, u[at : at + length + 1], h, linear)
        found.append(piece.all_outputs(states, u[at : at + length + 1])[: -1 if k + 1 < len(pieces) else None])
        x, at = states[-1], at + length
    return np.concatenate(found)


def in_entries(values, version: int) -> dict:
    """Joint matrices by the variables of either version: entries of the upper half, or the array."""
    flat = {}
    for name, value in values.items():
        if version == 2 and np.size(value) > 1:
            flat |= {f"{name}[{i + 1},{k + 1}]": value[i][k] for i in range(len(value)) for k in range(i, len(value))}
        else:
            flat[name] = float(np.ravel(value)[0]) if np.size(value) == 1 else value
    return flat


def differences(before, after) -> dict:
    """Joint matrices and damping ratios that differ between two networks, by the names of FMI 3."""
    values = {}
    for old, new in zip(before.joints, after.joints):
        for what in ("stiffness", "damping"):
            if not np.array_equal(getattr(old, what), getattr(new, what)):
                values[f"{new.name}.{what}"] = getattr(new, what)
    for name, ratio in after.modal_damping.items():
        if before.modal_damping[name] != ratio:
            values[f"{name}.modal_damping"] = ratio
    return values


class Stepper:
    """Co-simulation in either version of FMI, with joints that change between steps."""

    def __init__(self, unpacked) -> None:
        self.version = int(unpacked.description.fmiVersion[0])
        self.ends: dict | None = None  # inputs at the end of the step, where they are straight lines
        self.fmu = Fmu(unpacked) if self.version == 2 else Fmu3(unpacked, intermediate=self._give)
        self.fmu.start()

    def _give(self, fmu, _time, asked, _readable) -> None:
        if asked and self.ends is not None:
            assert fmu.set(self.ends) == OK, fmu.messages

    def set(self, values) -> None:
        assert self.fmu.set(in_entries(values, self.version)) == OK, self.fmu.messages

    def run(self, inputs, u, h: float, names, changes, *, linear: bool) -> np.ndarray:
        """Outputs before each step and after the last; `changes`: step -> what is set before it, after the inputs."""
        found = []
        for i in range(len(u)):
            self.set(dict(zip(inputs, u[i])))
            if i in changes:
                self.set(changes[i])
            found.append(self.fmu.get(names))
            if i + 1 == len(u):
                break
            if linear and self.version == 2:
                assert self.fmu.set_slopes(dict(zip(inputs, (u[i + 1] - u[i]) / h))) == OK
            self.ends = dict(zip(inputs, u[i + 1])) if linear else None
            assert self.fmu.step(i * h, h) == OK, self.fmu.messages
        return np.array(found)


def is_modal(state: bytes) -> bool:
    """Whether a serialised state has modal coordinates: the flag that gp_state.c writes."""
    return np.frombuffer(state, "<f8", 1, offset=72 + 8 * (6 + 8))[0] == 1.0
