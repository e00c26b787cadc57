"""FMI 3: whatever an importer does wrong gives an error, a sentence in the log and the old values, and no crash."""

import ctypes as ct
import math

import numpy as np
import pytest
from fmi3_driver import Fmu3
from fmu_calls import TYPES
from fmu_driver import ERROR, OK, reals

SHAKER, MESH, ZETA, MOUNT, K = (
    "actuators.shaker",
    "mesh.transmission_error",
    "gear_train.modal_damping",
    "mount_1.stiffness",
    "bearing_1.stiffness",
)
GOOD = [[1e8, 1e6], [1e6, 5e4]]


def refused(fmu, status, words):
    assert status == ERROR
    assert words in fmu.messages[-1], fmu.messages[-1]
    assert fmu.messages[-1].endswith(".")
    assert fmu.categories[-1] == "logStatusError"


BOTH = [
    ({"token": b"{wrong}"}, "instantiation token) does not belong"),
    ({"token": b""}, "token is missing"),
    ({"name": b""}, "instance name is missing"),
    ({"location": b""}, "resource path is missing"),
    ({"location": b"/nowhere/at/all"}, "cannot be opened"),
    ({"location": b"file:///nowhere"}, "cannot be opened"),
]
STEPPING = [
    ({"event_mode": True}, "no event mode"),
    ({"required": None, "count": 1}, "required intermediate variables are missing"),
    ({"required": [10**6]}, "does not exist"),
    ({"required": [2, 4]}, "cannot be an intermediate variable"),  # a stiffness matrix
]


CASES = [(x, *c) for x in (False, True) for c in BOTH] + [(False, *c) for c in STEPPING]


@pytest.mark.parametrize(("exchange", "arguments", "words"), CASES)
def test_instantiate_refuses(unpacked3, exchange, arguments, words):
    fmu = Fmu3(unpacked3, exchange=exchange, **arguments)
    assert fmu.c.value is None
    assert words in fmu.messages[-1]
    assert fmu.categories == ["logStatusError"]
    assert fmu.messages[-1].startswith(f"fmi3Instantiate{'ModelExchange' if exchange else 'CoSimulation'}: ")


def test_instantiate_accepts(unpacked3):
    """Required variables that exist, an early return that is allowed but never made, and a URI for a path."""
    for changes in (
        {"required": [0, 2, 25]},
        {"required": None, "count": 0},
        {"early_return": True},
        {"location": unpacked3.location},
        {"logging": True},
    ):
        fmu = Fmu3(unpacked3, **changes)
        fmu.start()
        assert fmu.step(0.0, 1e-5) == OK
        fmu.free()


def test_no_scheduled_execution(unpacked3):
    fmu = Fmu3(unpacked3)
    token, path = unpacked3.description.instantiationToken.encode(), str(unpacked3.folder / "resources").encode()
    new = unpacked3.library.fmi3InstantiateScheduledExecution
    assert new(b"it", token, path, False, True, None, fmu.logger, None, None, None) is None
    assert "no scheduled execution" in fmu.messages[-1]
    assert new(None, None, None, False, True, None, None, None, None, None) is None  # no logger either
    fmu.free()


def test_no_logger(unpacked3):
    fmu = Fmu3(unpacked3)
    token, path = unpacked3.description.instantiationToken.encode(), str(unpacked3.folder / "resources").encode()
    c = unpacked3.library.fmi3InstantiateModelExchange(b"it", token, path, False, True, None, None)
    assert c
    assert unpacked3.library.fmi3Terminate(c) == ERROR
    unpacked3.library.fmi3FreeInstance(c)
    assert unpacked3.library.fmi3InstantiateModelExchange(b"it", b"x", path, False, True, None, None) is None
    assert unpacked3.library.fmi3FreeInstance(None) is None
    assert fmu.messages == []
    fmu.free()


def test_unknown_references(fmu3):
    before = fmu3.serialised()
    for wrong in (len(fmu3.reference), 2**31, 2**32 - 1):
        refused(fmu3, fmu3.set({SHAKER: 5.0, wrong: 1.0}), f"{wrong} does not exist")
        refused(fmu3, fmu3.try_get([wrong])[1], f"{wrong} does not exist")
        for kind in ("Directional", "Adjoint"):
            for unknown, known in ((wrong, 0), (25, wrong)):
                one = [(ct.c_uint * 1)(unknown), 1, (ct.c_uint * 1)(known), 1]
                status = fmu3.call(f"fmi3Get{kind}Derivative", *one, reals([1.0]), 1, reals([0.0]), 1)
                refused(fmu3, status, f"{wrong} does not exist")
    assert fmu3.serialised() == before


@pytest.mark.parametrize("names", [[SHAKER], [K], [SHAKER, K, ZETA], ["bearing_1.force", "alpha"], ["state"]])
def test_sizes_that_do_not_match(fmu3, names):
    before, right = fmu3.serialised(), sum(fmu3.sizes(names))
    for wrong in (0, right - 1, right + 1, 2**40, 2**64 - 1):
        room = reals([7.0] * (right + 1))
        references = fmu3.references(names)
        words = f"have {right} values in all, but room for"
        refused(fmu3, fmu3.call("fmi3GetFloat64", references, len(names), room, wrong), words)
        assert list(room) == [7.0] * (right + 1)
        status = fmu3.call("fmi3SetFloat64", references, len(names), room, wrong)
        refused(fmu3, status, words if names[-1] not in ("alpha", "state") else "can")
    assert fmu3.serialised() == before


def test_sizes_of_derivatives(fmu3):
    references = [fmu3.references(["bearing_1.force"]), 1, fmu3.references([MESH]), 1]
    for function, seeds, results in (("Directional", 1, 2), ("Adjoint", 2, 1)):
        for wrong in ((seeds + 1, results), (seeds, results + 1), (0, results), (seeds, 0), (seeds, 2**60)):
            arguments = (reals([0] * 9), wrong[0], reals([0] * 9), wrong[1])
            status = fmu3.call(f"fmi3Get{function}Derivative", *references, *arguments)
            refused(fmu3, status, "do not match the sizes")
        arguments = (reals([0] * 9), seeds, reals([0] * 9), results)
        assert fmu3.call(f"fmi3Get{function}Derivative", *references, *arguments) == OK


BAD_VALUES = [
    (SHAKER, math.nan, "finite"),
    (SHAKER, -math.inf, "finite"),
    ("frequency", math.nan, "finite"),
    (ZETA, -1e-9, "at least 0"),
    (ZETA, 1.0, "less than 1"),
    (MOUNT, -1.0, "must not be negative"),
    (MOUNT, math.nan, "finite"),
    (K, [[1e8, 1e6], [1.1e6, 5e4]], "symmetric"),
    (K, [[1e8, 1e6], [-1e6, 5e4]], "symmetric"),
    (K, [[1e8, 1e7], [1e7, 5e4]], "positive semidefinite"),
    (K, [[0.0, 1.0], [1.0, 5e4]], "positive semidefinite"),
    (K, [[1e8, 1e6], [1e6, -5e4]], "must not be negative"),
    (K, [[1e8, math.nan], [math.nan, 5e4]], "finite"),
    ("bearing_2.damping", [[1.0, 2.0], [2.0, 1.0]], "positive semidefinite"),
    ("alpha", 0.5, "is a result"),
    ("casing.velocity_uy", 0.5, "is a result"),
    ("bearing_1.force", [1.0, 2.0], "is a result"),
    ("system.D", np.zeros((21, 3)), "is a result"),
    ("der(state)", np.zeros(54), "is a result"),
    ("time", 1.0, "is a result"),
]


@pytest.mark.parametrize(("name", "value", "words"), BAD_VALUES)
def test_values_out_of_range(fmu3, name, value, words):
    """The old value is kept, also those of what was set rightly in the same call."""
    old, before = fmu3.get([name]), fmu3.serialised()
    refused(fmu3, fmu3.set({MESH: 1e-6, name: value}), words)
    assert f"{name} (value reference {fmu3.reference[name]})" in fmu3.messages[-1]
    assert np.array_equal(fmu3.get([name]), old)
    assert fmu3.serialised() == before
    assert fmu3.step(0.0, 1e-5) == OK


@pytest.mark.parametrize("matrix", [GOOD, [[1e8, 0], [0, 0]], [[0, 0], [0, 0]], [[1e8, 1e6], [1e6, 1e4]]])
def test_semidefinite_matrices_are_taken(fmu3, matrix):
    assert fmu3.set({K: matrix}) == OK
    assert np.array_equal(fmu3.array(K), matrix)
    assert fmu3.step(0.0, 1e-5) == OK


def test_rounding_of_a_symmetric_matrix_is_forgiven(fmu3):
    """Of two entries that differ by rounding the lower is used, for both."""
    wobbly = np.array(GOOD)
    wobbly[0, 1] *= 1 + 1e-15
    assert wobbly[0, 1] != wobbly[1, 0]
    assert fmu3.set({K: wobbly}) == OK
    assert np.array_equal(fmu3.array(K), GOOD)


def test_parameters_in_continuous_time_mode(exchange3):
    before = exchange3.serialised()
    for name, value in ((K, GOOD), (ZETA, 0.1), (MOUNT, 1e6), ("bearing_3.damping", GOOD)):
        refused(exchange3, exchange3.set({SHAKER: 4.0, name: value}), "event mode only")
    assert exchange3.serialised() == before
    assert exchange3.call("fmi3EnterEventMode") == OK
    assert exchange3.set({SHAKER: 4.0, K: GOOD, ZETA: 0.1}) == OK


@pytest.mark.parametrize("kind", TYPES)
def test_other_types_have_no_variables(fmu3, kind):
    sizes = [reals([0.0])] if kind == "Binary" else []
    counts = [] if kind == "Clock" else [1]
    for verb in ("Get", "Set"):
        status = fmu3.call(f"fmi3{verb}{kind}", fmu3.references([SHAKER]), 1, *sizes, reals([0.0]), *counts)
        refused(fmu3, status, "are Float64")


@pytest.mark.parametrize(
    ("t", "h", "words"),
    [
        (0.0, 0.0, "positive"),
        (0.0, -1e-5, "positive"),
        (0.0, math.nan, "positive"),
        (0.0, math.inf, "positive"),
        (1e-5, 1e-5, "last step ended at 0 s"),
        (-1e-5, 1e-5, "last step ended"),
        (math.nan, 1e-5, "last step ended"),
        (2e-11, 1e-5, "last step ended"),
    ],
)
def test_wrong_steps(fmu3, t, h, words):
    before = fmu3.serialised()
    refused(fmu3, fmu3.step(t, h), words)
    assert fmu3.serialised() == before
    assert fmu3.step(0.0, 1e-5) == OK


def test_a_refused_step_asks_for_no_inputs(unpacked3):
    fmu = Fmu3(unpacked3, intermediate=lambda *_: None)
    fmu.start()
    assert fmu.step(0.0, -1.0) == ERROR
    assert fmu.call("fmi3DoStep", 0.0, 1e-5, True, None, None, None, None) == ERROR
    assert fmu.calls == []
    assert fmu.call("fmi3Terminate") == OK
    refused(fmu, fmu.step(0.0, 1e-5), "after terminating")
    assert fmu.calls == []
    fmu.free()


def test_stop_time(unpacked3):
    fmu = Fmu3(unpacked3)
    for start, stop in ((0.0, -1.0), (math.nan, 1.0), (0.0, math.inf), (math.inf, 1.0)):
        assert fmu.call("fmi3EnterInitializationMode", False, 0.0, start, True, stop) == ERROR
    fmu.start(start=1.0, stop=1.0 + 3e-5)
    for i in range(3):
        assert fmu.step(1.0 + i * 1e-5, 1e-5) == OK
    refused(fmu, fmu.step(1.0 + 3e-5, 1e-5), "after the stop time")
    fmu.free()


def test_debug_logging(fmu3):
    names = (ct.c_char_p * 2)(b"logEvents", b"logStatusError")
    assert fmu3.call("fmi3SetDebugLogging", True, 2, names) == OK
    assert fmu3.step(0.0, 1e-5) == OK
    assert fmu3.categories[-1] == "logEvents"
    assert fmu3.call("fmi3SetDebugLogging", False, 0, None) == OK
    assert fmu3.step(1e-5, 2e-5) == OK
    assert len(fmu3.messages) == 1
    refused(fmu3, fmu3.call("fmi3SetDebugLogging", True, 1, (ct.c_char_p * 1)(b"nonsense")), "Only the categories")
    refused(fmu3, fmu3.call("fmi3SetDebugLogging", True, 1, (ct.c_char_p * 1)(None)), "Only the categories")
