"""States of an FMU as handles and bytes, and runs to be continued, in either version of FMI.

As a program it continues runs in a process of its own: python fmu_states.py FOLDER, where FOLDER has it.fmu, every
state as NAME.state and where it stands as NAME.at.npy, and gets the continuations as NAME.npy and NAME.end.
"""

import ctypes as ct
import sys
from pathlib import Path

import numpy as np
from fmi3_driver import Fmu3
from fmu_driver import OK, Fmu, Unpacked
from fmu_networks import C2, K2
from fmu_piecewise import in_entries

STEPS = [1e-5] * 4 + [3e-5, 1e-5, 2e-6, 2e-4, 1e-5 * (1 + 1e-15), 7e-5, 1e-5, 3e-5]  # s; more sizes than are kept
INPUTS = {"mesh.transmission_error": 1e-6, "mesh.force": 20.0, "actuators.shaker": 5.0}


def version_of(unpacked: Unpacked) -> int:
    return int(unpacked.description.fmiVersion[0])


def new(unpacked: Unpacked, *, exchange=False):
    if version_of(unpacked) == 3:
        return Fmu3(unpacked, exchange=exchange)
    return Fmu(unpacked, kind=int(not exchange))


class Keeper:
    """The six functions on states of one instance."""

    def __init__(self, fmu) -> None:
        self.fmu, self.version = fmu, version_of(fmu.unpacked)

    def call(self, verb: str, *arguments) -> int:
        name = "FMUstate" if self.version == 2 else "FMUState"
        verb = "Deserialize" if verb == "DeSerialize" and self.version == 3 else verb
        return self.fmu.call(f"fmi{self.version}{verb}{name}", *arguments)

    def keep(self, place: ct.c_void_p | None = None) -> ct.c_void_p:
        place = ct.c_void_p() if place is None else place
        assert self.call("Get", ct.byref(place)) == OK, self.fmu.messages
        return place

    def restore(self, place: ct.c_void_p) -> int:
        return self.call("Set", place)

    def free(self, place: ct.c_void_p) -> None:
        assert self.call("Free", ct.byref(place)) == OK
        assert place.value is None

    def load(self, content: bytes, place: ct.c_void_p | None = None) -> tuple[int, ct.c_void_p]:
        place = ct.c_void_p() if place is None else place
        room = ct.create_string_buffer(content, len(content) + 1)
        return self.call("DeSerialize", room, len(content), ct.byref(place)), place

    def take(self, content: bytes) -> int:
        """Continues from bytes."""
        status, place = self.load(content)
        if status == OK:
            status = self.restore(place)
            self.free(place)
        return status


class Run:
    """An instance that is stepped with inputs and step sizes that follow from how many steps were made."""

    def __init__(self, fmu, *, made: int = 0, time: float = 0.0) -> None:
        self.fmu, self.made, self.time = fmu, made, time
        named = fmu.unpacked.description.modelVariables
        self.outputs = [v.name for v in named if v.causality == "output"]
        self.inputs = [v.name for v in named if v.name in INPUTS]

    def set(self, values) -> None:
        assert self.fmu.set(in_entries(values, version_of(self.fmu.unpacked))) == OK, self.fmu.messages

    def step(self, h: float, *, read=True, inputs=True) -> np.ndarray:
        """Sets the inputs, reads all outputs, and steps."""
        if inputs:
            self.set({n: INPUTS[n] * np.sin(1.3 * self.made + k) for k, n in enumerate(self.inputs)})
        values = self.fmu.get(self.outputs) if read else np.empty(0)
        assert self.fmu.step(self.time, h) == OK, self.fmu.messages
        self.made, self.time = self.made + 1, self.time + h
        return values

    def go_on(self) -> tuple[np.ndarray, bytes]:
        """All that can follow: steps without a word, of many sizes, a bearing exchanged; outputs and the last state."""
        self.step(1e-5, read=False, inputs=False)
        found = [self.step(h) for h in STEPS]
        self.set({"bearing_2.stiffness": K2, "bearing_2.damping": C2})
        found += [self.step(h) for h in STEPS]
        return np.array(found), self.fmu.serialised()


def main() -> None:
    """Continues every state in a folder."""
    folder = Path(sys.argv[1])
    unpacked = Fmu.unpack(folder / "it.fmu", folder / "unpacked")
    for file in sorted(folder.glob("*.state")):
        fmu = new(unpacked)
        assert Keeper(fmu).take(file.read_bytes()) == OK, fmu.messages
        made, time = np.load(file.with_suffix(".at.npy"))
        found, end = Run(fmu, made=int(made), time=float(time)).go_on()
        np.save(file.with_suffix(".npy"), found)
        file.with_suffix(".end").write_bytes(end)
        fmu.free()


if __name__ == "__main__":
    main()
