"""The machine that runs inside the python FMU: parameters, state over time, response over frequency.

Knows nothing of FMI. Bundled into the FMU; imports floors 1 to 4 only.
"""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from ..errors import GearpathError, InputError
from ..network.assemble import assemble
from ..network.modal import ModalNetwork
from ..network.power import is_moment_path, power_flow
from ..network.response import frequency_response
from ..network.system import System
from ..network.time_twin import TimeTwin, time_twin
from ..numerics.arrays import Real
from ..numerics.propagator import Propagator, discretise
from .python_bearings import decided_by_design
from .python_design import design_parameters, redesign
from .python_settings import Entry, Settings

STEP_SIZES = 8  # discretisations that are kept
_FAILURES = (GearpathError, ValueError, ArithmeticError)  # LinAlgError is a ValueError


def jitter(time: float, step: float) -> float:
    """By how much a step size (s) may differ from the one meant, being a difference of times."""
    return 8.0 * float(np.finfo(float).eps) * max(abs(time), abs(step))


class Machine:
    """A system at rest with all inputs 0, to be stepped in time with held inputs and read at any moment.

    Parameters are checked when they are next used, so that a matrix may be indefinite while its entries are
    set one by one; what does not fit is then taken back, and InputError says so.
    """

    def __init__(self, system: System, frequency: float) -> None:
        self._start = system
        self._parameters = {parameter.name: parameter for parameter in design_parameters(system)}
        self._solved: ModalNetwork = assemble(system).modal().viscous()
        self._network = self._solved
        self._valid = Settings.of(self._solved, decided_by_design(system))
        self._wanted = self._valid.copy()
        self._pending = False
        self._frequency = float(frequency)
        self._inputs = {load.name: 0.0 for load in self._solved.loads}
        self._state = np.zeros(2 * len(self._solved.eigenvalues))
        self._begun = False  # whether a step was made
        self._twin: TimeTwin | None = None
        self._propagators: dict[float, Propagator] = {}
        self._values: dict[str, float] | None = None  # of the outputs over time
        self._response: dict[str, float] | None = None  # of the outputs over frequency

    def check(self, entries: Sequence[Entry], values: Sequence[float]) -> None:
        """Raise InputError if one of the values can never be set."""
        for entry, value in zip(entries, values):
            if entry.kind == "design":
                self._parameters[entry.name].check(value)
            entry.check(value)

    def set(self, entry: Entry, value: float) -> None:
        """Set an input or a parameter to a checked value."""
        if entry.kind == "input":
            self._inputs[entry.target] = value
            self._values = None
        elif entry.kind == "frequency":
            if value != self._frequency:
                self._frequency, self._response = value, None
        elif entry.kind == "design":
            self._pending |= self._wanted.design.get(entry.name) != value
            self._wanted.design[entry.name] = value
        else:
            self._pending |= self._wanted.set_entry(entry, value)

    def get(self, entry: Entry) -> float:
        """The value of any variable, computed from the inputs and parameters of this moment.

        An output that the present design does not have (a coordinate that nothing reaches any more) is 0.
        """
        if entry.kind == "input":
            return self._inputs[entry.target]
        if entry.kind == "frequency":
            return self._frequency
        if entry.kind == "design":
            return self._design(entry.name)
        if not entry.is_output:
            return self._wanted.entry(entry)
        self.use()
        if entry.kind == "followed":
            joint = next(joint for joint in self._network.joints if joint.name == entry.target)
            return float((joint.stiffness if ".stiffness" in entry.name else joint.damping)[entry.row, entry.column])
        if entry.kind == "output":
            return self._output_values().get(entry.target, 0.0)
        return self._response_values().get(entry.name, 0.0)

    def use(self) -> None:
        """Bring the network up to date with the parameters; raise InputError for what was taken back."""
        if not self._pending:
            return
        self._pending = False
        problems = self._wanted.take_back_joints(self._valid)
        if self._wanted.design != self._valid.design:
            try:
                self._solved = assemble(redesign(self._start, self._wanted.design)).modal().viscous()
                self._state = np.zeros(2 * len(self._solved.eigenvalues))
                self._begun = False
            except _FAILURES as error:
                problems.append(f"The design cannot be built and keeps its last valid parameters: {error}.")
                self._wanted.design = dict(self._valid.design)
        if self._wanted != self._valid:
            network = self._wanted.applied(self._solved)
            self._keep_velocity(network)
            self._network = network
            self._valid = self._wanted.copy()
            self._forget()
        if problems:
            raise InputError(" ".join(problems))

    def step(self, time: float, step: float) -> None:
        """Advance from `time` by `step` (s) with the inputs held; exact for such inputs."""
        self.use()
        try:
            propagator = self._propagator(time, step)
            u = np.array([self._inputs[load.name] for load in self._time_twin().loads])
            with np.errstate(over="ignore", invalid="ignore"):
                state = propagator.step(self._state, u, np.zeros_like(u))
        except _FAILURES as error:
            raise InputError(
                f"The system cannot be discretised for the step size {step:g} s; use a smaller step"
            ) from error
        if not np.isfinite(state).all():
            raise InputError("The step overflows, so it is not made; check the inputs and their units")
        self._state, self._values, self._begun = state, None, True

    def plain(self) -> dict[str, Any]:
        """Everything that the machine's future depends on, as dictionaries, lists and numbers."""
        return {
            "wanted": self._wanted.plain(),
            "valid": self._valid.plain(),
            "inputs": dict(self._inputs),
            "frequency": self._frequency,
            "state": self._state.tolist(),
            "begun": self._begun,
        }

    def restore(self, plain: Mapping[str, Any]) -> None:
        """Go back to what `plain` returned, in this machine or another one of the same system."""
        self._wanted = Settings.from_plain(plain["valid"])
        self._pending = self._wanted != self._valid
        self.use()
        self._wanted = Settings.from_plain(plain["wanted"])
        self._pending = self._wanted != self._valid
        self._inputs = {name: float(value) for name, value in plain["inputs"].items()}
        self._frequency = float(plain["frequency"])
        self._state, self._begun = np.array(plain["state"], float), bool(plain["begun"])
        self._values = self._response = None

    def _keep_velocity(self, network: ModalNetwork) -> None:
        """Keep q' = s + sum X d e, of which s is the state, where another network has another X.

        A velocity cannot jump with a damping ratio. Before the first step there is nothing to keep: the machine
        starts at rest with all inputs 0.
        """
        if self._begun:
            change = self._network.damping - network.damping
            for load in network.loads:
                if load.mesh_displacement is not None:
                    self._state[len(change) :] += change * load.mesh_displacement * self._inputs[load.name]

    def _forget(self) -> None:
        """Drop what was computed from the parameters."""
        self._twin = self._values = self._response = None
        self._propagators = {}

    def _design(self, name: str) -> float:
        """A design parameter: as it was set, otherwise as the design has it."""
        if name in self._wanted.design:
            return self._wanted.design[name]
        try:
            system = redesign(self._start, self._wanted.design)
        except InputError:
            system = redesign(self._start, self._valid.design)
        return self._parameters[name].read(system)

    def _time_twin(self) -> TimeTwin:
        if self._twin is None:
            self._twin = time_twin(self._network)
        return self._twin

    def _propagator(self, time: float, step: float) -> Propagator:
        """The discretisation for a step size: a kept one where only rounding differs, or a new one."""
        nearest = min(self._propagators, key=lambda kept: abs(kept - step), default=np.inf)
        if abs(nearest - step) > jitter(time, step):
            while len(self._propagators) >= STEP_SIZES:
                del self._propagators[next(iter(self._propagators))]
            twin = self._time_twin()
            with np.errstate(all="ignore"):
                self._propagators[step] = discretise(twin.A, twin.B, step)
            nearest = step
        found = self._propagators.pop(nearest)
        self._propagators[nearest] = found  # the last is the latest used
        return found

    def _output_values(self) -> dict[str, float]:
        """All outputs over time, by name."""
        if self._values is None:
            twin = self._time_twin()
            u = np.array([self._inputs[load.name] for load in twin.loads])
            y: Real = twin.C @ self._state + twin.D @ u
            values = dict(zip((output.name for output in twin.outputs), y.tolist()))
            dofs = {joint.name: joint.dofs for joint in self._network.joints}
            for output in self._network.outputs:
                if output.quantity == "power" and output.joint is not None:
                    j = output.joint
                    values[output.name] = sum(
                        values[f"{j}.force_{dof}"] * values[f"{j}.velocity_{dof}"] for dof in dofs[j]
                    )
            self._values = values
        return self._values

    def _response_values(self) -> dict[str, float]:
        """All outputs over frequency, by name."""
        if self._response is None:
            try:
                with np.errstate(all="ignore"):
                    values = _response(self._network, abs(self._frequency))
            except GearpathError:
                values = {"alpha": np.nan}
            if not np.isfinite(list(values.values())).all():
                raise InputError(
                    f"The frequency response is singular at {self._frequency:g} Hz (an undamped resonance); "
                    "add damping or change the frequency"
                )
            self._response = values
        return self._response


def _belongs(joint: str, path: str) -> bool:
    return path.rsplit(".", 1)[0] == joint


def _response(network: ModalNetwork, frequency: float) -> dict[str, float]:
    """Power ratios and transfers from the excitation at one frequency (Hz), by the name of the variable."""
    if frequency == 0.0:
        return defaultdict(float)  # no vibration, no power
    omega = np.array([2.0 * np.pi * frequency])
    flow = power_flow(network, omega)
    values = {
        "alpha": flow.share(),
        "alpha_force": flow.share(lambda path: not is_moment_path(path)),
        "alpha_moment": flow.share(is_moment_path),
    }
    for joint in network.paths:
        values[f"{joint}.alpha"] = flow.share(partial(_belongs, joint))
    excitation = next(load for load in network.loads if load.name == network.excitation)
    outputs = [output for output in network.outputs if output.quantity != "power"]
    H = frequency_response(network, omega, outputs, [excitation])[0, :, 0]
    for output, value in zip(outputs, H):
        values[f"frf.{output.name}.re"], values[f"frf.{output.name}.im"] = value.real, value.imag
    return {name: float(np.squeeze(value)) for name, value in values.items()}
