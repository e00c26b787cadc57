"""Model exchange through ctypes, the same few calls in both versions of FMI."""

import ctypes as ct

import numpy as np
from fmu_driver import OK, reals


class EventInfo(ct.Structure):
    _fields_ = [(f"flag{i}", ct.c_int) for i in range(5)] + [("next", ct.c_double)]


class Exchange:
    """The same few calls of either version."""

    def __init__(self, fmu, version: int) -> None:
        self.fmu, self.version, self.n = fmu, version, 54
        self.names = {
            2: {"derivatives": "GetDerivatives", "update": "NewDiscreteStates"},
            3: {"derivatives": "GetContinuousStateDerivatives", "update": "UpdateDiscreteStates"},
        }[version]

    def call(self, function: str, *arguments) -> int:
        return self.fmu.call(f"fmi{self.version}{function}", *arguments)

    def ok(self, function: str, *arguments) -> None:
        assert self.call(function, *arguments) == OK, self.fmu.messages

    def vector(self, function: str) -> np.ndarray:
        room = (ct.c_double * self.n)()
        self.ok(function, room, self.n)
        return np.array(room)

    @property
    def states(self) -> np.ndarray:
        return self.vector("GetContinuousStates")

    @states.setter
    def states(self, x) -> None:
        self.ok("SetContinuousStates", reals(x), len(x))

    @property
    def derivatives(self) -> np.ndarray:
        return self.vector(self.names["derivatives"])

    def update(self) -> bool:
        """Handles an event: whether the states have changed."""
        if self.version == 3:
            return self.fmu.update_states()
        info = EventInfo(*[7] * 5, 1.0)
        self.ok("NewDiscreteStates", ct.byref(info))
        assert (info.flag0, info.flag1, info.flag2, info.flag4) == (0, 0, 0, 0)
        return bool(info.flag3)

    def set(self, values: dict) -> None:
        """Joint matrices as a whole in either version."""
        flat = {}
        for name, value in values.items():
            if np.ndim(value) == 2 and self.version == 2:
                flat |= {f"{name}[{i + 1},{k + 1}]": value[i][k] for i in range(2) for k in range(i, 2)}
            else:
                flat[name] = value
        assert self.fmu.set(flat) == OK, self.fmu.messages
