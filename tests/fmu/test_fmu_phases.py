"""Every function of FMI 2 and FMI 3 in every phase: allowed or an error, and an error changes nothing."""

import struct

import pytest
from fmi3_driver import Fmu3
from fmi_signatures import signatures
from fmu_calls import ALLOWED, CO_SIMULATION, EXCHANGE, GOES_TO, NEVER, PHASES, TYPES, Calls, new
from fmu_driver import DISCARD, ERROR, OK

NOT_OF_AN_INSTANCE = {"GetVersion", "GetTypesPlatform", "FreeInstance"}
ROWS = [(version, row) for version in (2, 3) for row in ALLOWED[version]]
DISCARDED = {"GetIntegerStatus", "GetStringStatus"}  # in the phases of the other statuses: a status that does not exist
LETTER = {1: "I", 2: "N", 4: "E", 8: "C", 16: "S", 64: "T"}


@pytest.mark.parametrize("version", [2, 3])
def test_the_tables_are_complete(version):
    functions = {name for name in signatures(version) if not name.startswith("Instantiate")} - NOT_OF_AN_INSTANCE
    assert {row.split()[0] for row in ALLOWED[version]} == functions


def phase_in(state: bytes) -> str:
    return LETTER[int(struct.unpack_from("<d", state, 72)[0])]


@pytest.mark.parametrize("row", ROWS, ids=lambda r: f"fmi{r[0]}{r[1]}")
def test_every_function_in_every_phase(unpacked, unpacked3, row):
    version, function = row[0], row[1].split()[0]
    for exchange, phases in enumerate((CO_SIMULATION, EXCHANGE)):
        for phase in phases:
            fmu = new(unpacked3 if version == 3 else unpacked, version, bool(exchange))
            fmu.enter(PHASES[phase])
            if phase != "I":
                fmu.get(["casing.velocity_uy"])  # takes the parameters into use, as any first result does
            calls, before = Calls(fmu, version), fmu.serialised()
            calls.keep()
            messages = len(fmu.messages)
            status, where = calls.call(row[1]), (exchange, phase, fmu.messages)
            after = fmu.serialised()
            if phase in ALLOWED[version][row[1]][exchange]:
                assert status == OK, where
                assert len(fmu.messages) == messages, where
                assert phase_in(after) == GOES_TO.get(function, phase * 2)[exchange], where
                assert after == before or not function.startswith(("Get", "Serialize", "DeSer", "Deser", "Free")), where
            else:
                discarded = function in DISCARDED and not exchange and phase in "ST"
                assert status == (DISCARD if discarded else ERROR), where
                assert fmu.messages[-1].startswith(f"fmi{version}{function}: "), where
                assert fmu.messages[-1].endswith("."), where
                assert fmu.categories[-1] == "logStatusError"
                assert len(fmu.messages) == messages + 1, where
                assert after == before, where
            calls.free()
            fmu.free()


@pytest.mark.parametrize("within", ["A", "R"])
@pytest.mark.parametrize("row", ALLOWED[3])
def test_every_function_of_fmi3_within_a_step(unpacked3, row, within):
    """In the callback that asks for inputs, and in the one that gives results."""
    found, function = [], row.split()[0]

    def act(fmu, _time, asked, _readable):
        if asked == (within == "A"):
            found.append((calls.call(row), len(fmu.messages)))

    fmu, quiet = Fmu3(unpacked3, intermediate=act), Fmu3(unpacked3, intermediate=lambda *_: None)
    calls = Calls(fmu, 3)
    for instance in (fmu, quiet):
        instance.start()
        assert instance.set({"actuators.shaker": 2.0, "mesh.force": 1.0}) == OK
    calls.keep()
    for instance in (fmu, quiet):
        assert instance.step(0.0, 1e-5) == OK, fmu.messages
    ((status, messages),) = found
    if within in ALLOWED[3][row][0]:
        assert (status, messages) == (OK, 0), fmu.messages
        if function != "SetFloat64":
            assert fmu.serialised() == quiet.serialised()
    else:
        assert status == ERROR
        assert fmu.messages[-1].startswith(f"fmi3{function}: ")
        assert fmu.serialised() == quiet.serialised()
    calls.free()
    fmu.free()
    quiet.free()


def test_an_instance_is_not_freed_within_a_step(unpacked3):
    def act(fmu, *_):
        unpacked3.library.fmi3FreeInstance(fmu.c)

    fmu = Fmu3(unpacked3, intermediate=act)
    fmu.start()
    assert fmu.step(0.0, 1e-5) == OK
    assert [m for m in fmu.messages if m.startswith("fmi3FreeInstance: ")] == fmu.messages
    assert len(fmu.messages) == 2
    assert fmu.get(["casing.velocity_uy"])[0] == 0.0
    fmu.free()


@pytest.mark.parametrize("row", ROWS, ids=lambda r: f"fmi{r[0]}{r[1]}")
def test_null_pointers(unpacked, unpacked3, row):
    """Each pointer of each function NULL in turn: an error with a sentence and no change, in a phase that allows it."""
    version, name = row
    function = name.split()[0]
    allowed = ALLOWED[version][name]
    exchange = not allowed[0] and allowed != NEVER
    phase = (allowed[exchange] or "S")[-1 if function != "Terminate" else 0].replace("R", "T").replace("A", "S")
    fmu = new(unpacked3 if version == 3 else unpacked, version, exchange)
    fmu.enter(PHASES[phase])
    calls, before = Calls(fmu, version), fmu.serialised()
    calls.keep()
    harmless = {"FreeFMUstate", "FreeFMUState", "GetEventIndicators"}  # "the call is ignored"; there are no indicators
    for parameter in signatures(version)[function][1:]:
        if not parameter.pointer:
            continue
        status = calls.call(name, without=parameter.name)
        if function in harmless:
            assert status == OK
        else:
            assert status in ((ERROR, DISCARD) if function in DISCARDED else (ERROR,)), (parameter, fmu.messages)
            assert fmu.messages[-1].startswith(f"fmi{version}{function}: "), parameter
        assert fmu.serialised() == before, parameter
    instance, fmu.c = fmu.c, None
    assert calls.call(name) == ERROR  # no instance at all
    fmu.c = instance
    calls.free()
    fmu.free()


EMPTY = {  # with a count of 0, in step mode
    2: [
        *["GetReal", "SetReal", "SetRealInputDerivatives", "GetDirectionalDerivative", "SetDebugLogging"],
        *[f"{verb}{kind}" for verb in ("Get", "Set") for kind in ("Integer", "Boolean", "String")],
    ],
    3: [
        *["GetFloat64", "SetFloat64", "GetDirectionalDerivative", "GetAdjointDerivative", "SetDebugLogging"],
        *[f"{verb}{kind}" for verb in ("Get", "Set") for kind in TYPES],
    ],
}


@pytest.mark.parametrize("version", [2, 3])
def test_empty_sets_need_no_arrays(unpacked, unpacked3, version):
    fmu = new(unpacked3 if version == 3 else unpacked, version, False)
    fmu.enter("stepping")
    before = fmu.serialised()
    for function in EMPTY[version]:
        values = [None if p.pointer else 0 for p in signatures(version)[function][1:]]
        assert fmu.call(f"fmi{version}{function}", *values) == OK, (function, fmu.messages)
    assert fmu.serialised() == before
    fmu.free()
