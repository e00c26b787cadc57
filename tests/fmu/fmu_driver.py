"""FMI 2 through ctypes: thin enough to make wrong calls on purpose, fast enough for 10,000 steps."""

import ctypes as ct
import zipfile
from dataclasses import dataclass
from pathlib import Path

import fmpy
import numpy as np
from fmi_signatures import declare
from fmpy.model_description import ModelDescription, read_model_description

OK, WARNING, DISCARD, ERROR, FATAL, PENDING = range(6)
LOGGER = ct.CFUNCTYPE(None, ct.c_void_p, ct.c_char_p, ct.c_int, ct.c_char_p, ct.c_char_p)  # the varargs stay unread


class Callbacks(ct.Structure):
    _fields_ = [
        ("logger", LOGGER),
        ("allocateMemory", ct.c_void_p),
        ("freeMemory", ct.c_void_p),
        ("stepFinished", ct.c_void_p),
        ("componentEnvironment", ct.c_void_p),
    ]


@dataclass(frozen=True)
class Unpacked:
    folder: Path
    description: ModelDescription
    library: ct.CDLL

    @property
    def location(self) -> str:
        return (self.folder / "resources").as_uri()


class Fmu:
    """One instance of an unpacked FMU."""

    @staticmethod
    def unpack(path: Path, folder: Path, library: Path | None = None) -> Unpacked:
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder)
        description = read_model_description(str(folder))
        if library is None:
            library = (
                folder
                / "binaries"
                / (fmpy.platform if description.fmiVersion == "2.0" else fmpy.platform_tuple)
                / (description.coSimulation.modelIdentifier + fmpy.sharedLibraryExtension)
            )
        loaded = ct.CDLL(str(library))
        declare(loaded, int(description.fmiVersion[0]))
        return Unpacked(folder, description, loaded)

    def __init__(self, unpacked: Unpacked, *, name=b"it", kind=1, guid=None, location=None, logging=0) -> None:
        self.unpacked, self.kind, self.messages, self.categories = unpacked, kind, [], []
        library = unpacked.library
        self.logger = LOGGER(self._log)
        self.callbacks = Callbacks(self.logger, None, None, None, None)
        guid = unpacked.description.guid.encode() if guid is None else guid
        location = unpacked.location if location is None else location
        location = location.encode() if isinstance(location, str) else location
        self.c = ct.c_void_p(library.fmi2Instantiate(name, kind, guid, location, ct.byref(self.callbacks), 0, logging))
        self.reference = {v.name: v.valueReference for v in unpacked.description.modelVariables}

    def _log(self, _environment, _name, _status, category, message):
        self.categories.append(category.decode())
        self.messages.append(message.decode())

    def call(self, function: str, *arguments) -> int:
        return int(getattr(self.unpacked.library, function)(self.c, *arguments))

    def start(self, start: float = 0.0, stop: float | None = None) -> None:
        assert self.c.value, self.messages
        assert self.call("fmi2SetupExperiment", 0, 0.0, start, stop is not None, stop or 0.0) == OK
        assert self.call("fmi2EnterInitializationMode") == OK
        assert self.call("fmi2ExitInitializationMode") == OK

    def enter(self, phase: str) -> None:
        """Goes from instantiated to a phase of either interface, by way of those before it."""
        calls = {
            "initialization": [("SetupExperiment", 0, 0.0, 0.0, 0, 0.0), ("EnterInitializationMode",)],
            "stepping": [("ExitInitializationMode",)],
            "event": [("ExitInitializationMode",)],
            "continuous": [("NewDiscreteStates", (ct.c_double * 4)()), ("EnterContinuousTimeMode",)],
            "terminated": [("Terminate",)],
        }
        exchange = ["initialization", "event", "continuous", "terminated"]
        way = exchange if self.kind == 0 else ["initialization", "stepping", "terminated"]
        for step in way[: way.index(phase) + 1] if phase != "instantiated" else []:
            for function, *arguments in calls[step]:
                assert self.call(f"fmi2{function}", *arguments) == OK, self.messages

    def serialised(self) -> bytes:
        """The whole state, as bytes."""
        state, size = ct.c_void_p(), ct.c_size_t()
        assert self.call("fmi2GetFMUstate", ct.byref(state)) == OK, self.messages
        assert self.call("fmi2SerializedFMUstateSize", state, ct.byref(size)) == OK
        content = ct.create_string_buffer(size.value)
        assert self.call("fmi2SerializeFMUstate", state, content, size) == OK
        assert self.call("fmi2FreeFMUstate", ct.byref(state)) == OK
        return content.raw

    def references(self, names) -> ct.Array:
        numbers = [self.reference[n] if isinstance(n, str) else n for n in names]
        return (ct.c_uint * len(numbers))(*numbers)

    def set(self, values: dict) -> int:
        return self.call("fmi2SetReal", self.references(values), ct.c_size_t(len(values)), reals(values.values()))

    def set_slopes(self, values: dict, order: int = 1) -> int:
        orders = (ct.c_int * len(values))(*[order] * len(values))
        return self.call(
            "fmi2SetRealInputDerivatives",
            self.references(values),
            ct.c_size_t(len(values)),
            orders,
            reals(values.values()),
        )

    def get(self, names) -> np.ndarray:
        result, status = self.try_get(names)
        assert status == OK, self.messages
        return result

    def try_get(self, names) -> tuple[np.ndarray, int]:
        value = (ct.c_double * len(names))()
        status = self.call("fmi2GetReal", self.references(names), ct.c_size_t(len(names)), value)
        return np.array(value), status

    def step(self, t: float, h: float) -> int:
        return self.call("fmi2DoStep", t, h, 1)

    def run(self, inputs, values, h, outputs, *, slopes=None, start=0.0) -> np.ndarray:
        """Outputs (steps + 1, outputs): before the first and after each step; `values` is (steps, inputs)."""
        names, wanted = self.references(inputs), self.references(outputs)
        ones = (ct.c_int * len(inputs))(*[1] * len(inputs))
        out = np.empty((len(values) + 1, len(outputs)))
        value = np.ascontiguousarray(values, dtype=float)
        rows = value.ctypes.data
        library, c, n = self.unpacked.library, self.c, ct.c_size_t(len(inputs))
        slope = None if slopes is None else np.ascontiguousarray(slopes, dtype=float)
        for i in range(len(values)):
            at = ct.c_void_p(rows + i * value.strides[0])
            status = library.fmi2SetReal(c, names, n, at)
            if slope is not None:
                at = ct.c_void_p(slope.ctypes.data + i * slope.strides[0])
                status |= library.fmi2SetRealInputDerivatives(c, names, n, ones, at)
            to = ct.c_void_p(out.ctypes.data + i * out.strides[0])
            status |= library.fmi2GetReal(c, wanted, ct.c_size_t(len(outputs)), to)
            status |= library.fmi2DoStep(c, start + i * h, h, 1)
            assert status == OK, self.messages
        out[-1] = self.get(outputs)
        return out

    def free(self) -> None:
        if self.c.value:
            self.unpacked.library.fmi2FreeInstance(self.c)
            self.c = ct.c_void_p()


def reals(values) -> ct.Array:
    numbers = [float(v) for v in values]
    return (ct.c_double * len(numbers))(*numbers)
