"""FMI 3 through ctypes: thin enough to make wrong calls on purpose."""

import ctypes as ct
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from fmu_driver import OK, Unpacked, reals

LOGGER = ct.CFUNCTYPE(None, ct.c_void_p, ct.c_int, ct.c_char_p, ct.c_char_p)
UPDATE = ct.CFUNCTYPE(
    None,
    ct.c_void_p,
    ct.c_double,
    *[ct.c_bool] * 4,
    ct.POINTER(ct.c_bool),
    ct.POINTER(ct.c_double),
)
Intermediate = Callable[["Fmu3", float, bool, bool], None]  # (instance, time, inputs asked for, results readable)


class Fmu3:
    """One instance of an unpacked FMI 3 FMU, for model exchange or co-simulation."""

    def __init__(
        self, unpacked: Unpacked, *, exchange=False, name=b"it", token=None, location=None, logging=False,
        event_mode=False, early_return=False, required: Sequence[int] | None = (), count: int | None = None,
        intermediate: Intermediate | None = None,
    ) -> None:  # fmt: skip
        """`required`: intermediate variables, a NULL pointer where None; `count`: their number where it is wrong."""
        self.unpacked, self.exchange, self.messages, self.categories = unpacked, exchange, [], []
        self.calls: list[tuple[float, tuple[bool, ...]]] = []  # of the intermediate update
        self.intermediate = intermediate
        self.logger, self.update = LOGGER(self._log), UPDATE(self._update if intermediate else 0)
        token = unpacked.description.instantiationToken.encode() if token is None else token
        location = str(unpacked.folder / "resources") if location is None else location
        location = location.encode() if isinstance(location, str) else location
        common = (name or None, token or None, location or None, False, logging)
        if exchange:
            new = unpacked.library.fmi3InstantiateModelExchange(*common, None, self.logger)
        else:
            wanted = None if required is None else (ct.c_uint * len(required))(*required)
            size = len(required or ()) if count is None else count
            new = unpacked.library.fmi3InstantiateCoSimulation(
                *common, event_mode, early_return, wanted, size, None, self.logger, self.update
            )
        self.c = ct.c_void_p(new)
        self.variables = {v.name: v for v in unpacked.description.modelVariables}
        self.reference = {v.name: v.valueReference for v in unpacked.description.modelVariables}
        self.shape = {v.name: tuple(d.start for d in v.dimensions) for v in unpacked.description.modelVariables}

    def _log(self, _environment, _status, category, message) -> None:
        self.categories.append(category.decode())
        self.messages.append(message.decode())

    def _update(self, _environment, time, asked, readable, finished, early, _requested, _early_time) -> None:
        self.calls.append((time, (asked, readable, finished, early)))
        self.intermediate(self, time, asked, readable)

    def call(self, function: str, *arguments) -> int:
        return int(getattr(self.unpacked.library, function)(self.c, *arguments))

    def enter(self, phase: str) -> None:
        """Goes from instantiated to a phase of either interface, by way of those before it."""
        flags = (ct.c_double * 6)()  # room for whatever is written
        calls = {
            "initialization": [("EnterInitializationMode", False, 0.0, 0.0, False, 0.0)],
            "stepping": [("ExitInitializationMode",)],
            "event": [("ExitInitializationMode",)],
            "continuous": [
                ("UpdateDiscreteStates", *[ct.byref(flags, 8 * i) for i in range(6)]),
                ("EnterContinuousTimeMode",),
            ],
            "terminated": [("Terminate",)],
        }
        exchange = ["initialization", "event", "continuous", "terminated"]
        way = exchange if self.exchange else ["initialization", "stepping", "terminated"]
        for step in way[: way.index(phase) + 1] if phase != "instantiated" else []:
            for function, *arguments in calls[step]:
                assert self.call(f"fmi3{function}", *arguments) == OK, self.messages

    def start(self, start: float = 0.0, stop: float | None = None) -> None:
        """To step mode, or through event mode to continuous-time mode."""
        assert self.c.value, self.messages
        arguments = (False, 0.0, start, stop is not None, stop or 0.0)
        assert self.call("fmi3EnterInitializationMode", *arguments) == OK, self.messages
        assert self.call("fmi3ExitInitializationMode") == OK, self.messages
        if self.exchange:
            self.update_states()
            assert self.call("fmi3EnterContinuousTimeMode") == OK, self.messages

    def update_states(self) -> bool:
        """fmi3UpdateDiscreteStates: whether the states have changed; the other flags are always false."""
        flags, time = (ct.c_bool * 5)(*[True] * 5), ct.c_double(1.0)
        places = [ct.byref(flags, i) for i in range(5)]
        assert self.call("fmi3UpdateDiscreteStates", *places, ct.byref(time)) == OK, self.messages
        assert [flags[i] for i in (0, 1, 2, 4)] == [False] * 4
        return bool(flags[3])

    def references(self, names) -> ct.Array:
        numbers = [self.reference[n] if isinstance(n, str) else n for n in names]
        return (ct.c_uint * len(numbers))(*numbers)

    def sizes(self, names) -> list[int]:
        return [int(np.prod(self.shape[n])) if isinstance(n, str) else 1 for n in names]

    def set(self, values: Mapping) -> int:
        flat = [float(x) for value in values.values() for x in np.ravel(value)]
        return self.call("fmi3SetFloat64", self.references(values), len(values), reals(flat), len(flat))

    def get(self, names: Sequence[str]) -> np.ndarray:
        """All values of some variables, arrays row by row."""
        result, status = self.try_get(names)
        assert status == OK, self.messages
        return result

    def array(self, name: str) -> np.ndarray:
        return self.get([name]).reshape(self.shape[name])

    def try_get(self, names) -> tuple[np.ndarray, int]:
        value = (ct.c_double * sum(self.sizes(names)))()
        status = self.call("fmi3GetFloat64", self.references(names), len(names), value, len(value))
        return np.array(value), status

    def step(self, t: float, h: float) -> int:
        """fmi3DoStep; where it succeeds it must end where it should, without an event or an early return."""
        flags, last = (ct.c_bool * 3)(*[True] * 3), ct.c_double(np.nan)
        places = [ct.byref(flags, i) for i in range(3)]
        status = self.call("fmi3DoStep", t, h, True, *places, ct.byref(last))
        if status == OK:
            assert list(flags) == [False] * 3
            assert last.value == t + h
        return status

    def vector(self, function: str) -> np.ndarray:
        """fmi3GetContinuousStates, fmi3GetContinuousStateDerivatives or fmi3GetNominalsOfContinuousStates."""
        values = (ct.c_double * self.shape["state"][0])()
        assert self.call(function, values, len(values)) == OK, self.messages
        return np.array(values)

    def set_states(self, x) -> int:
        return self.call("fmi3SetContinuousStates", reals(x), len(x))

    def serialised(self) -> bytes:
        """The whole state, as bytes."""
        state, size = ct.c_void_p(), ct.c_size_t()
        assert self.call("fmi3GetFMUState", ct.byref(state)) == OK, self.messages
        assert self.call("fmi3SerializedFMUStateSize", state, ct.byref(size)) == OK
        content = ct.create_string_buffer(size.value)
        assert self.call("fmi3SerializeFMUState", state, content, size) == OK
        assert self.call("fmi3FreeFMUState", ct.byref(state)) == OK
        return content.raw

    def free(self) -> None:
        if self.c.value:
            self.unpacked.library.fmi3FreeInstance(self.c)
            self.c = ct.c_void_p()
