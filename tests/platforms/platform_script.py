"""Scripts for the C host, by variable names, and what it printed."""

import struct
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from fmpy import read_model_description
from numpy.typing import ArrayLike, NDArray
from platform_machines import Machine


def bits(value: float) -> str:
    """The 16 hexadecimal digits of a double."""
    return struct.pack(">d", value).hex()


def _words(values: ArrayLike) -> list[str]:
    return [bits(float(value)) for value in np.ravel(np.asarray(values, float))]


@dataclass(frozen=True)
class UnpackedFmu:
    """An FMU in a folder: its version, its token and its variables' references and sizes."""

    folder: Path
    fmi: str

    @cached_property
    def _description(self):
        return read_model_description(str(self.folder), validate=False)

    @property
    def token(self) -> str:
        description = self._description
        return str(description.guid if self.fmi == "2.0" else description.instantiationToken)

    @cached_property
    def reference(self) -> dict[str, int]:
        return {v.name: v.valueReference for v in self._description.modelVariables}

    @cached_property
    def size(self) -> dict[str, int]:
        """Numbers of each variable, row by row where it is a matrix."""
        return {v.name: int(np.prod([int(d.start) for d in v.dimensions])) for v in self._description.modelVariables}

    def names(self, causality: str) -> list[str]:
        """The variables of one causality, in the FMU's order."""
        return [v.name for v in self._description.modelVariables if v.causality == causality]

    def library(self, machine: Machine) -> Path:
        return self.folder / "binaries" / machine.folders[self.fmi] / f"gearbox{machine.extension}"


class Script:
    """The lines for one run of the host, written as calls. Method names are the host's commands."""

    def __init__(self, fmu: UnpackedFmu, machine: Machine, library: Path | None = None) -> None:
        self.fmu, self.machine = fmu, machine
        self.lines: list[str] = []
        self.call("library", f"fmi{fmu.fmi[0]}", machine.path(library or fmu.library(machine)))

    @property
    def text(self) -> str:
        return "\n".join(self.lines) + "\n"

    def call(self, *words: object) -> None:
        """One line, for the commands that have no method."""
        self.lines.append(" ".join(map(str, words)))

    def instantiate(self, kind: str, location: str | None = None) -> None:
        """An instance for "cs" or "me"."""
        where = self.machine.location(self.fmu.folder / "resources", self.fmu.fmi) if location is None else location
        self.call("instantiate", kind, self.fmu.token, where)

    def start(self, kind: str, time: float = 0.0) -> None:
        """An instance that went through initialisation; in model exchange ready for an integrator."""
        self.instantiate(kind)
        self.call("start", bits(time))
        self.call("initialised")
        if kind == "me":
            self.call("update")
            self.call("continuous")

    def set(self, values: Mapping[str, ArrayLike]) -> None:
        words = [word for value in values.values() for word in _words(value)]
        self.call("set", len(values), len(words), *self._references(values), *words)

    def get(self, names: Sequence[str]) -> None:
        total = sum(self.fmu.size[name] for name in names)
        self.call("get", len(names), total, *self._references(names))

    def ramp(self, start: Mapping[str, float], end: Mapping[str, float], h: float) -> None:
        """Inputs that go straight from `start` to `end` in the next step of size `h`."""
        values = end if self.fmu.fmi == "3.0" else {name: (end[name] - start[name]) / h for name in end}
        self.call("ramp", len(values), *self._references(values), *_words(list(values.values())))

    def step(self, time: float, h: float) -> None:
        self.call("step", bits(time), bits(h))

    def time(self, time: float) -> None:
        self.call("time", bits(time))

    def integrate(self, time: float, h: float, steps: int, states: int) -> None:
        self.call("integrate", bits(time), bits(h), steps, states)

    def set_states(self, x: ArrayLike) -> None:
        words = _words(x)
        self.call("setstates", len(words), *words)

    def derivative(self, name: str, unknowns: Sequence[str], knowns: Sequence[str], seed: ArrayLike) -> None:
        """What the host calls "directional" or "adjoint"."""
        results = sum(self.fmu.size[n] for n in (unknowns if name == "directional" else knowns))
        words = _words(seed)
        references = [*self._references(unknowns), *self._references(knowns)]
        self.call(name, len(unknowns), len(knowns), len(words), results, *references, *words)

    def _references(self, names: Iterable[str]) -> list[int]:
        return [self.fmu.reference[name] for name in names]


@dataclass(frozen=True)
class Call:
    """A printed line: the command, what it returned, and the words after that."""

    name: str
    status: int
    words: tuple[str, ...]

    def reals(self) -> NDArray[np.float64]:
        return np.frombuffer(bytes.fromhex("".join(self.words)), ">f8").astype(float)


def parsed(output: str) -> list[Call]:
    """The host's output; a log message is the words of a call named "log"."""
    calls = []
    for line in output.splitlines():
        name, status, *words = line.split(" ")
        calls.append(Call(name, int(status), tuple(words)))
    return calls


def values(output: str, name: str = "get") -> list[NDArray[np.float64]]:
    """The numbers of all calls of one name, after a check that every call was successful and nothing logged."""
    calls = parsed(output)
    bad = [call for call in calls if call.status != 0 or call.name == "log"]
    assert not bad, bad[0]
    return [call.reals() for call in calls if call.name == name]
