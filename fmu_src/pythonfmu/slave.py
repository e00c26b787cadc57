"""The FMI face of a python FMU: pythonfmu's calls become calls of a `Machine`.

Travels inside the FMU as `<package>/fmu/slave.py`, beside the solver's own files and the model; all imports
are relative. Value references are places in `VARIABLES`. pythonfmu offers no way to return fmi2Error: an
exception is reported as fmi2Fatal, and a step that returns False as fmi2Discard. Either way the instance
stays as it was before the call and can be used further.
"""

import ctypes
import functools
import json
import math
import sys
import zlib

from ..errors import InputError
from ..model import FREQUENCY, MODEL, SYSTEM, VARIABLES
from ..pythonfmu.enums import Fmi2Status
from ..pythonfmu.fmi2slave import Fmi2Slave
from .python_machine import Machine, jitter

STATE_VERSION = 1


def keep(thing):
    """Add a reference to `thing`, to make up for one that pythonfmu's native part drops without owning it."""
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(thing))


def guarded(method):
    """Make a call that fails harmless.

    On an exception pythonfmu drops its references to the instance, its class and its log, and drops them once
    more when the instance is freed.
    """

    @functools.wraps(method)
    def call(self, *arguments):
        try:
            return method(self, *arguments)
        except BaseException:
            for thing in (type(self), self, self.log_queue):
                keep(thing)
            raise

    return call


class GearpathSlave(Fmi2Slave):
    """One instance of the FMU."""

    def __init__(self, **arguments):
        super().__init__(**arguments)
        forget_path(self.resources)
        self._machine = Machine(SYSTEM, FREQUENCY)
        self._phase = "instantiated"  # then "initialising", "stepping", "terminated"
        self._time, self._stop = 0.0, None

    @guarded
    def setup_experiment(self, start_time, stop_time=None, tolerance=None):  # noqa: ARG002
        """Take the start and the stop time; there is no tolerance, since steps are exact."""
        if not math.isfinite(start_time) or not (stop_time is None or math.isfinite(stop_time)):
            raise InputError("The start time and the stop time must be finite")
        if stop_time is not None and stop_time < start_time:
            raise InputError(f"The stop time {stop_time:g} s lies before the start time {start_time:g} s")
        self._time, self._stop = float(start_time), None if stop_time is None else float(stop_time)

    @guarded
    def enter_initialization_mode(self):
        """Begin the initialisation."""
        self._phase = "initialising"

    @guarded
    def exit_initialization_mode(self):
        """End the initialisation; the design is built and stays."""
        self._machine.use()
        self._phase = "stepping"

    @guarded
    def terminate(self):
        """End the simulation; values can still be read."""
        self._phase = "terminated"

    @guarded
    def get_real(self, references):
        """Values of variables, as they follow from the inputs and parameters of this moment."""
        return [self._machine.get(entry) for entry in self._entries(references)]

    @guarded
    def set_real(self, references, values):
        """Set inputs and parameters: all of them, or none."""
        entries = self._entries(references)
        for entry in entries:
            if entry.kind == "design" and self._phase in ("stepping", "terminated"):
                raise InputError(f"{entry.name} is fixed and can be set until the initialisation ends only")
        self._machine.check(entries, values)
        for entry, value in zip(entries, values):
            self._machine.set(entry, value)

    @guarded
    def do_step(self, current_time, step_size):
        """Advance by one step, or log why not and leave everything as it was."""
        try:
            self._check_step(current_time, step_size)
            self._machine.step(current_time, step_size)
        except InputError as error:
            self.log(f"{error}", Fmi2Status.error)
            return False
        self._time = current_time + step_size
        return True

    def _check_step(self, time, step):
        if self._phase != "stepping":
            raise InputError(f"A step needs an instance that is initialised; this one is {self._phase}")
        if not (math.isfinite(step) and step > 0.0):
            raise InputError(f"The step size must be positive and finite, but is {step:g} s")
        tolerance = 1e-6 * step + jitter(time, step)
        if not abs(time - self._time) <= tolerance:
            raise InputError(f"The step starts at {time!r} s, but the last step ended at {self._time!r} s")
        if self._stop is not None and time + step > self._stop + tolerance:
            raise InputError(f"The step ends at {time + step!r} s, after the stop time {self._stop!r} s")

    def _entries(self, references):
        for reference in references:
            if not 0 <= reference < len(VARIABLES):
                raise InputError(f"The variable with value reference {reference} does not exist")
        return [VARIABLES[reference] for reference in references]

    @guarded
    def _get_fmu_state(self):
        return {
            "model": MODEL,
            "version": STATE_VERSION,
            "phase": self._phase,
            "time": self._time,
            "stop": self._stop,
            "machine": self._machine.plain(),
        }

    @guarded
    def _set_fmu_state(self, state):
        if state.get("model") != MODEL or state.get("version") != STATE_VERSION:
            raise InputError(state.get("problem", "The FMU state belongs to another model; it is not used"))
        self._machine.restore(state["machine"])
        self._phase, self._time, self._stop = state["phase"], state["time"], state["stop"]

    @staticmethod
    def _fmu_state_to_bytes(state):
        content = json.dumps(state).encode("ascii")
        return b"%08x" % zlib.crc32(content) + content

    @staticmethod
    def _fmu_state_from_bytes(state):
        # A failure here would cost the instance its references, so it is reported when the state is set.
        content = state[8:]
        if state[:8] != b"%08x" % zlib.crc32(content):
            return {"problem": "The serialised FMU state is cut short or altered, so it is not used"}
        return json.loads(content)

    def _refuse(self, *arguments):  # noqa: ARG002
        raise InputError("All variables of this FMU are of the type Real")

    get_integer = set_integer = get_boolean = set_boolean = get_string = set_string = guarded(_refuse)


def forget_path(resources):
    """Take the FMU's folder off Python's search path again: everything is imported."""
    while resources in sys.path:
        sys.path.remove(resources)
    sys.path_importer_cache.pop(resources, None)
