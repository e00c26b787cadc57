"""Whatever an importer does wrong: an error, a sentence in the log, the old values kept, and no crash."""

import ctypes as ct
import math

import fmu_oracle as oracle
import numpy as np
import pytest
from fmu_driver import DISCARD, ERROR, OK, Fmu, reals

SHAKER, K11, K12 = "actuators.shaker", "bearing_1.stiffness[1,1]", "bearing_1.stiffness[1,2]"
ZETA = "gear_train.modal_damping"


def refused(fmu, status, words):
    assert status == ERROR
    assert words in fmu.messages[-1], fmu.messages[-1]
    assert fmu.messages[-1].rstrip().endswith(".")
    assert fmu.categories[-1] == "logStatusError"


@pytest.fixture
def fresh(unpacked):
    """An instance before initialisation."""
    instance = Fmu(unpacked)
    assert instance.c.value
    yield instance
    instance.free()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"guid": b"{wrong}"}, "does not belong to resources/model.bin"),
        ({"name": b""}, "instance name"),
        ({"name": None}, "instance name"),
        ({"kind": 2}, "co-simulation or model exchange"),
        ({"kind": -1}, "co-simulation or model exchange"),
        ({"location": b""}, "cannot be opened"),
        ({"location": b"file:///nowhere/at/all"}, "cannot be opened"),
        ({"location": b"file://elsewhere/share/resources"}, "another host"),
        ({"location": b"file:///tmp/%00/x"}, "zero byte"),
        ({"location": b"http://example.org/resources"}, "cannot be opened"),
    ],
)
def test_instantiate_refuses(unpacked, arguments, words):
    fmu = Fmu(unpacked, **arguments)
    assert fmu.c.value is None
    assert words in fmu.messages[-1]
    assert fmu.messages[-1].startswith("fmi2Instantiate: ")


def test_instantiate_with_null_pointers(unpacked):
    new = unpacked.library.fmi2Instantiate
    fmu = Fmu(unpacked)
    callbacks, guid = ct.byref(fmu.callbacks), unpacked.description.guid.encode()
    assert new(b"x", 1, None, unpacked.location.encode(), callbacks, 0, 0) is None
    assert "GUID is missing" in fmu.messages[-1]
    assert new(b"x", 1, guid, None, callbacks, 0, 0) is None
    assert "location is missing" in fmu.messages[-1]
    assert new(b"x", 1, guid, unpacked.location.encode(), None, 0, 0) is None
    fmu.free()


def test_null_instance_and_null_arrays(fmu):
    library, n, one = fmu.unpacked.library, ct.c_size_t(1), (ct.c_uint * 1)(0)
    for function in ("fmi2Terminate", "fmi2Reset", "fmi2EnterInitializationMode", "fmi2CancelStep"):
        assert getattr(library, function)(None) == ERROR
    assert library.fmi2GetReal(None, one, n, (ct.c_double * 1)()) == ERROR
    assert library.fmi2DoStep(None, 0.0, 1e-5, 1) == ERROR
    library.fmi2FreeInstance(None)
    for function in ("fmi2GetReal", "fmi2SetReal"):
        refused(fmu, fmu.call(function, None, n, (ct.c_double * 1)()), "missing")
        refused(fmu, fmu.call(function, one, n, None), "missing")
        assert fmu.call(function, None, ct.c_size_t(0), None) == OK
    refused(fmu, fmu.call("fmi2SetRealInputDerivatives", one, n, None, None), "missing")
    assert fmu.call("fmi2GetStatus", 0, None) == ERROR


def test_unknown_references(fmu):
    count = len(fmu.reference)
    for wrong in (count, 2**31, 2**32 - 1):
        refused(fmu, fmu.set({wrong: 1.0}), f"{wrong} does not exist")
        refused(fmu, fmu.try_get([wrong])[1], f"{wrong} does not exist")
        refused(fmu, fmu.set_slopes({wrong: 1.0}), f"{wrong} does not exist")


def test_a_failed_set_changes_nothing(fmu):
    assert fmu.set({SHAKER: 1.0}) == OK
    refused(fmu, fmu.set({SHAKER: 2.0, 10**6: 1.0}), "does not exist")
    refused(fmu, fmu.set({SHAKER: 2.0, ZETA: 1.0}), "less than 1")
    assert fmu.get([SHAKER, ZETA]).tolist() == [1.0, 0.015]


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        (SHAKER, math.nan, "finite"),
        (SHAKER, math.inf, "finite"),
        ("frequency", math.inf, "finite"),
        (ZETA, -1e-9, "at least 0"),
        (ZETA, 1.0, "less than 1"),
        (ZETA, math.nan, "finite"),
        (K11, -1.0, "must not be negative"),
        (K12, math.nan, "finite"),
        ("mount_1.damping", -1.0, "must not be negative"),
        ("alpha", 0.5, "cannot be set"),
        ("casing.velocity_uy", 0.5, "cannot be set"),
        ("frf.casing.velocity_uy.re", 0.5, "cannot be set"),
    ],
)
def test_values_out_of_range(fmu, name, value, words):
    before = fmu.get([name])[0]
    refused(fmu, fmu.set({name: value}), words)
    assert fmu.get([name])[0] == before
    assert fmu.step(0.0, 1e-5) == OK


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
def test_wrong_steps(fmu, t, h, words):
    refused(fmu, fmu.step(t, h), words)
    assert fmu.step(0.0, 1e-5) == OK
    assert fmu.step(1e-5 + 1e-20, 1e-5) == OK  # rounding of the communication point is no error


def test_clock_over_many_steps(fmu):
    """The importer may multiply or accumulate; both clocks drift apart by far more than one rounding."""
    h, t = 1e-6, 0.0
    for _ in range(20000):
        assert fmu.step(t, h) == OK
        t += h
    assert t != 20000 * h
    assert fmu.step(20000 * h, h) == OK
    last = ct.c_double()
    assert fmu.call("fmi2GetRealStatus", 2, ct.byref(last)) == OK
    assert last.value == pytest.approx(20001 * h, rel=1e-15)


def test_stop_time(unpacked):
    fmu = Fmu(unpacked)
    fmu.start(start=1.0, stop=1.0 + 3e-5)
    for i in range(3):
        assert fmu.step(1.0 + i * 1e-5, 1e-5) == OK
    refused(fmu, fmu.step(1.0 + 3e-5, 1e-5), "after the stop time")
    fmu.free()


def test_set_up_experiment_refuses(fresh):
    for start, stop in ((0.0, -1.0), (math.nan, 1.0), (0.0, math.inf), (math.inf, 1.0)):
        assert fresh.call("fmi2SetupExperiment", 0, 0.0, start, 1, stop) == ERROR
    refused(fresh, fresh.call("fmi2SetupExperiment", 0, 0.0, 2.0, 1, 1.0), "before the start time")


def test_call_sequence(fresh):
    refused(fresh, fresh.step(0.0, 1e-5), "before initialisation")
    refused(fresh, fresh.call("fmi2ExitInitializationMode"), "before initialisation")
    refused(fresh, fresh.call("fmi2Terminate"), "before initialisation")
    refused(fresh, fresh.try_get(["alpha"])[1], "before initialisation")
    assert fresh.set({K11: 1.3e8, SHAKER: 3.0}) == OK  # start values may be set
    assert fresh.call("fmi2EnterInitializationMode") == OK
    refused(fresh, fresh.step(0.0, 1e-5), "in initialisation mode")
    refused(fresh, fresh.call("fmi2EnterInitializationMode"), "in initialisation mode")
    refused(fresh, fresh.call("fmi2SetupExperiment", 0, 0.0, 0.0, 0, 0.0), "in initialisation mode")
    assert np.isfinite(fresh.get(list(fresh.reference))).all()  # every variable
    assert fresh.get([K11, SHAKER]).tolist() == [1.3e8, 3.0]
    assert fresh.call("fmi2ExitInitializationMode") == OK
    refused(fresh, fresh.call("fmi2ExitInitializationMode"), "once the simulation runs")
    assert fresh.step(0.0, 1e-5) == OK
    assert fresh.call("fmi2Terminate") == OK
    assert np.isfinite(fresh.get(["alpha", "casing.velocity_uy"])).all()
    refused(fresh, fresh.step(1e-5, 1e-5), "after terminating")
    refused(fresh, fresh.set({SHAKER: 1.0}), "after terminating")
    assert fresh.call("fmi2Reset") == OK
    fresh.start()
    assert fresh.get([K11, SHAKER])[1] == 0.0


def test_indefinite_matrix_rolls_back(fmu, network):
    """The joint keeps its last valid matrices; other changes of the same time are taken."""
    good = network.joints[0].stiffness
    assert fmu.set({K12: 10 * good[0, 1], "mount_1.stiffness": 5e6}) == OK  # not used yet
    refused(fmu, fmu.step(0.0, 1e-5), "stiffness matrix of bearing_1 is not positive semidefinite")
    assert fmu.get([K12, "mount_1.stiffness"]).tolist() == [good[0, 1], 5e6]
    assert fmu.step(0.0, 1e-5) == OK
    assert fmu.set({"bearing_2.damping[1,2]": 1e9}) == OK
    _, status = fmu.try_get(["casing.velocity_uy"])
    refused(fmu, status, "damping matrix of bearing_2")
    assert fmu.try_get(["casing.velocity_uy"])[1] == OK
    # an indefinite state on the way is fine
    assert fmu.set({K12: 3 * good[0, 1]}) == OK
    assert fmu.set({"bearing_1.stiffness[2,2]": 10 * good[1, 1]}) == OK
    assert fmu.step(1e-5, 1e-5) == OK


def test_indefinite_matrix_at_initialisation(fresh):
    assert fresh.set({K12: 1e9}) == OK
    assert fresh.call("fmi2EnterInitializationMode") == OK
    refused(fresh, fresh.call("fmi2ExitInitializationMode"), "stiffness matrix of bearing_1")
    assert fresh.call("fmi2ExitInitializationMode") == OK


@pytest.mark.parametrize(
    ("matrix", "definite"),
    [
        ([1e8, 0.0, 0.0], True),  # radial only
        ([0.0, 0.0, 0.0], True),
        ([1e8, 1e6, 1e4], True),  # singular
        ([1e8, 1e6 * (1 + 1e-15), 1e4], True),  # singular but for rounding
        ([1e8, 1e6 * (1 + 1e-9), 1e4], False),
        ([1e8, 1.0, 0.0], False),
        ([0.0, 1e-9, 0.0], False),
        ([1e-300, 0.9e-300, 1e-300], True),
    ],
)
def test_semidefinite_up_to_rounding(fmu, matrix, definite):
    names = [f"bearing_1.stiffness[{i},{k}]" for i, k in ((1, 1), (1, 2), (2, 2))]
    assert fmu.set(dict(zip(names, matrix))) == OK
    assert (fmu.step(0.0, 1e-5) == OK) == definite, fmu.messages


def test_input_derivatives_refused(fmu):
    for order in (0, 2, -1):
        refused(fmu, fmu.set_slopes({SHAKER: 1.0}, order), "order 1 only")
    refused(fmu, fmu.set_slopes({K11: 1.0}), "not an input")
    refused(fmu, fmu.set_slopes({SHAKER: math.nan}), "finite")
    assert fmu.set_slopes({"frequency": 1e308}) == OK
    refused(fmu, fmu.step(0.0, 100.0), "frequency overflows")
    assert fmu.set_slopes({"frequency": 0.0}) == OK
    assert fmu.step(0.0, 1e-5) == OK


def test_overflow_of_a_step_is_refused(fmu):
    assert fmu.set({SHAKER: 1.7e308}) == OK
    assert fmu.set_slopes({SHAKER: 1.7e308}) == OK
    refused(fmu, fmu.step(0.0, 1.0), "overflows")
    assert fmu.set({SHAKER: 0.0}) == OK
    assert fmu.set_slopes({SHAKER: 0.0}) == OK
    assert fmu.step(0.0, 1.0) == OK
    assert np.isfinite(fmu.get(list(fmu.reference))).all()


def test_overflow_of_an_output_is_refused(fmu, network):
    """An output D u is right up to the largest double and refused beyond, whatever its parts are inside."""
    _, _, _, D, names = oracle.time_system(network)
    for name in ("sensors.gear", "casing.acceleration_uy", "bearing_2.force_rx"):
        gain = D[names.index(name), 0]
        assert abs(gain) > 1.1  # so that the input itself is representable
        largest = np.finfo(float).max / abs(gain)
        for part, fits in ((0.9, True), (1.1, False)):
            assert fmu.set({"mesh.transmission_error": part * largest}) == OK
            value, status = fmu.try_get([name])
            if fits:
                assert status == OK, fmu.messages
                assert value[0] == pytest.approx(part * largest * gain, rel=1e-9)
            else:
                refused(fmu, status, f"{name} (value reference {fmu.reference[name]}) overflows")


@pytest.mark.parametrize("function", ["fmi2GetRealOutputDerivatives", "fmi2CancelStep"])
def test_unsupported_functions_say_so(fmu, function):
    arguments = [] if function == "fmi2CancelStep" else [fmu.references([SHAKER]), 1, (ct.c_int * 1)(1), reals([0.0])]
    refused(fmu, fmu.call(function, *arguments), function)


def test_status_that_does_not_exist_is_discarded(fmu):
    """FMI 2.0.4, 4.2.3: a status that cannot be given is fmi2Discard, no error."""
    room = (ct.c_double * 1)()
    given = {"": 0, "Real": 2, "Boolean": 3, "Integer": None, "String": None}
    for what, right in given.items():
        for kind in {0, 1, 2, 3} - {right}:
            assert fmu.call(f"fmi2Get{what}Status", kind, room) == DISCARD
            assert "has no value" in fmu.messages[-1]


@pytest.mark.parametrize("type_", ["Integer", "Boolean", "String"])
def test_other_types_have_no_variables(fmu, type_):
    one = (ct.c_uint * 1)(0)
    for verb in ("Get", "Set"):
        refused(fmu, fmu.call(f"fmi2{verb}{type_}", one, ct.c_size_t(1), (ct.c_longlong * 1)()), "are Real")


def test_debug_logging(fmu):
    names = (ct.c_char_p * 2)(b"logEvents", b"logStatusError")
    assert fmu.call("fmi2SetDebugLogging", 1, ct.c_size_t(2), names) == OK
    assert fmu.step(0.0, 1e-5) == OK
    assert fmu.categories[-1] == "logEvents"
    assert fmu.call("fmi2SetDebugLogging", 1, ct.c_size_t(1), (ct.c_char_p * 1)(b"nonsense")) == ERROR
    assert fmu.call("fmi2SetDebugLogging", 1, ct.c_size_t(1), None) == ERROR


def test_no_logger(unpacked):
    """A NULL logger is allowed; failures stay errors."""
    fmu = Fmu(unpacked)
    fmu.callbacks.logger = type(fmu.logger)()
    fmu.free()
    c = ct.c_void_p(
        unpacked.library.fmi2Instantiate(
            b"x",
            1,
            unpacked.description.guid.encode(),
            unpacked.location.encode(),
            ct.byref(fmu.callbacks),
            0,
            1,
        )
    )
    assert c.value
    assert unpacked.library.fmi2DoStep(c, 0.0, 1e-5, 1) == ERROR
    unpacked.library.fmi2FreeInstance(c)
