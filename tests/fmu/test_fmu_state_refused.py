"""States that do not belong, are damaged or are handled wrongly: refused with a sentence, and nothing is changed."""

import ctypes as ct
import zlib
from dataclasses import replace

import numpy as np
import pytest
from fmu_driver import ERROR, OK, Fmu
from fmu_exchange import Exchange
from fmu_helpers import export
from fmu_networks import CHANGES, gearbox
from fmu_states import Keeper, Run, new

HEADER, EXTRA = 72, 6  # bytes, and doubles of the session; as gp_state.h says


@pytest.fixture(params=[2, 3])
def version(request):
    """Of FMI."""
    return request.param


@pytest.fixture(scope="module")
def fmus(unpacked, unpacked3):
    return {2: unpacked, 3: unpacked3}


@pytest.fixture
def run(fmus, version):
    """On its way after a change of joints."""
    it = Run(new(fmus[version]))
    it.fmu.start()
    it.set(CHANGES)
    for _ in range(5):
        it.step(1e-5)
    yield it
    it.fmu.free()


@pytest.fixture(scope="module")
def foreign(tmp_path_factory):
    """A model of the same size with other numbers, and one of another size."""
    folder = tmp_path_factory.mktemp("foreign")
    start = gearbox()
    return {
        (name, version): Fmu.unpack(
            export(network, folder / f"{name}{version}.fmu", fmi=f"{version}.0"), folder / f"{name}{version}"
        )
        for name, network in {"other": gearbox(2), "smaller": replace(start, loads=start.loads[:2])}.items()
        for version in (2, 3)
    }


def refused(run, status, words):
    assert status == ERROR
    assert words in run.fmu.messages[-1]
    assert run.fmu.messages[-1].startswith("fmi")


@pytest.mark.parametrize("which", ["other", "smaller"])
def test_of_another_model(run, foreign, version, which):
    """By handle and by bytes, from another FMU and from the other version of this one."""
    before, keeper = run.fmu.serialised(), Keeper(run.fmu)
    other = new(foreign[which, version])
    other.start()
    theirs = Keeper(other)
    state, content = theirs.keep(), other.serialised()
    refused(run, keeper.restore(state), "belongs to another model")
    status, place = keeper.load(content)
    refused(run, status, "belongs to another model")
    assert place.value is None
    if which == "smaller":  # no room for ours, whose handle theirs cannot overwrite either
        assert keeper.call("Get", ct.byref(state)) == ERROR
        assert keeper.load(before, state)[0] == ERROR
    assert other.serialised() == content
    assert theirs.restore(state) == OK
    assert run.fmu.serialised() == before
    keeper.free(state)
    other.free()


def test_of_the_other_version_of_fmi(run, fmus, version):
    before = run.fmu.serialised()
    other = new(fmus[5 - version])
    other.start()
    refused(run, Keeper(run.fmu).take(other.serialised()), "belongs to another model")
    assert run.fmu.serialised() == before
    other.free()


def test_truncated(run):
    before, keeper = run.fmu.serialised(), Keeper(run.fmu)
    for size in (0, 1, 7, 8, 71, 72, 73, len(before) // 2, len(before) - 8, len(before) - 1):
        status, place = keeper.load(before[:size])
        refused(run, status, "The state cannot be used")
        assert place.value is None
    assert run.fmu.serialised() == before
    assert keeper.take(before + bytes(100)) == OK  # more room than it needs


def test_altered(run):
    """Every byte of the header and a thousand others: one bit is enough."""
    before, keeper = run.fmu.serialised(), Keeper(run.fmu)
    places = np.random.default_rng(1).permutation(np.arange(HEADER, len(before)))[:1000]
    for at in [*range(HEADER), *places]:
        altered = bytearray(before)
        altered[at] ^= 1 << int(at) % 8
        status, place = keeper.load(bytes(altered))
        assert status == ERROR, at
        assert place.value is None
        assert "The state cannot be used" in run.fmu.messages[-1]
    assert run.fmu.serialised() == before


def forged(content: bytes, at: int, value: float) -> bytes:
    """The state with another number and the right checksum."""
    numbers = np.frombuffer(content, "<f8", offset=HEADER).copy()
    numbers[at] = value
    rest = content[32:HEADER] + numbers.tobytes()
    return content[:24] + zlib.crc32(rest).to_bytes(4, "little") + content[28:32] + rest


def layout(network) -> dict[str, int]:
    """Where the parts of a state begin, in doubles, as gp_state.c writes them."""
    blocks = sum(len(joint.dofs) ** 2 for joint in network.joints)
    sizes = {
        "session": EXTRA,
        "frequency": 8,
        "flags": 3,
        "steps": 2,
        "torque": 3,
        "sizes": 8,
        "changed": len(network.joints),
        "K": blocks,
        "C": blocks,
        "valid_K": blocks,
        "valid_C": blocks,
        "zeta": 1,
        "valid_zeta": 1,
        "inputs": 2 * len(network.loads),
        "states": 2 * len(network.eigenvalues),
    }
    return dict(zip([*sizes, "end"], np.cumsum([0, *sizes.values()]).tolist()))


def test_forged(run, network):
    """Numbers that no instance can have, under the right checksum."""
    before, keeper, at = run.fmu.serialised(), Keeper(run.fmu), layout(network)
    assert len(before) == HEADER + 8 * at["end"]
    assert keeper.take(forged(before, at["states"], 1e-7)) == OK  # so that it is not the checksum that is refused
    assert run.fmu.serialised() == forged(before, at["states"], 1e-7)
    assert keeper.take(before) == OK
    wrong = [
        *((i, np.nan) for i in range(at["end"])),
        (at["states"] + 3, np.inf),
        (0, 3.0), (0, 4.0), (0, 8.0), (0, 32.0), (0, 128.0), (0, 0.0),  # phases that do not exist, or not here
        (1, 1.0), (1, 2.0),  # the interface
        (4, 0.5),  # whether there is a stop time
        (5, 0.5),
        (at["flags"], 1.0),  # modal coordinates with parameters that are not those of the start
        (at["flags"] + 1, 0.5), (at["flags"] + 2, 2.0),
        (at["steps"], -1.0), (at["steps"], 1.5), (at["steps"], 1e300),
        (at["sizes"], -1e-5), (at["sizes"] + 1, 0.25),
        (at["changed"], 2.0),
        (at["K"] + 1, 77.0), (at["valid_K"] + 2, 77.0), (at["valid_C"], -1.0), (at["valid_K"] + 3, 0.0),
        (at["zeta"], -0.1), (at["zeta"], 1.0), (at["valid_zeta"], 1.5),
    ]  # fmt: skip
    for place, value in wrong:
        status, handle = keeper.load(forged(before, place, value))
        assert status == ERROR, (place, value)
        assert handle.value is None
        words = ("cannot be used", "other kind of interface")
        assert any(word in run.fmu.messages[-1] for word in words), run.fmu.messages[-1]
    assert run.fmu.serialised() == before


def test_model_exchange_and_co_simulation(fmus, version):
    """Not interchangeable, in whatever phase they were kept."""
    kept = []
    for exchange, phases in ((False, ["stepping"]), (True, ["event", "continuous"])):
        for phase in ("instantiated", "initialization", *phases, "terminated"):
            fmu = new(fmus[version], exchange=exchange)
            fmu.enter(phase)
            kept.append((exchange, phase, fmu, Keeper(fmu).keep(), fmu.serialised()))
    for exchange, phase, fmu, _, content in kept:
        for of_exchange, of_phase, _, state, theirs in kept:
            if of_exchange != exchange:
                assert Keeper(fmu).restore(state) == ERROR, (phase, of_phase)
                assert "other kind of interface" in fmu.messages[-1]
                status, place = Keeper(fmu).load(theirs)
                assert (status, place.value) == (ERROR, None)
                assert fmu.serialised() == content
    for exchange, _, fmu, _, content in kept:  # but from any phase to any other of the same kind
        for of_exchange, _, _, state, theirs in kept:
            if of_exchange == exchange:
                assert Keeper(fmu).restore(state) == OK
                assert fmu.serialised() == theirs
                assert Keeper(fmu).take(content) == OK
    for _, _, fmu, state, _ in kept:
        Keeper(fmu).free(state)
        fmu.free()


def test_handles(run, version):
    """Overwritten, freed twice and freed where there is none; in rooms too small."""
    keeper = Keeper(run.fmu)
    state = keeper.keep()
    first, content = state.value, run.fmu.serialised()
    run.step(1e-5)
    later = run.fmu.serialised()
    assert keeper.keep(state).value == first
    size = ct.c_size_t()
    assert keeper.call("Set", state) == OK
    assert run.fmu.serialised() == later
    status, place = keeper.load(content, state)  # bytes into a handle that exists
    assert (status, place.value) == (OK, first)
    assert keeper.restore(state) == OK
    assert run.fmu.serialised() == content
    name = "SerializedFMUstateSize" if version == 2 else "SerializedFMUStateSize"
    assert run.fmu.call(f"fmi{version}{name}", state, ct.byref(size)) == OK
    assert size.value == len(content)
    room = ct.create_string_buffer(b"\x55" * len(content))
    refused(run, keeper.call("Serialize", state, room, len(content) - 1), "too small")
    assert room.raw[: len(content)] == b"\x55" * len(content)
    keeper.free(state)
    keeper.free(state)
    assert keeper.call("Free", None) == OK
    refused(run, keeper.restore(state), "missing")
    refused(run, keeper.call("Get", None), "missing")


def test_a_handle_outlives_its_instance(fmus, version):
    first, second = new(fmus[version]), new(fmus[version])
    first.start()
    run = Run(first)
    run.step(1e-5)
    state, content = Keeper(first).keep(), first.serialised()
    first.free()
    assert Keeper(second).restore(state) == OK
    assert second.serialised() == content
    Keeper(second).free(state)
    second.free()


def test_time_and_phase_come_back(fmus, version):
    """The clock and its stop time, and whether the run had ended."""
    fmu = new(fmus[version])
    fmu.start(2.0, 2.5)
    run, keeper = Run(fmu, time=2.0), Keeper(fmu)
    run.step(0.125)
    state = keeper.keep()
    run.step(0.25)
    assert fmu.call(f"fmi{version}Terminate") == OK
    assert fmu.step(run.time, 1e-3) == ERROR
    assert keeper.restore(state) == OK
    assert fmu.step(2.375, 0.125) == ERROR  # the time of the run that was left
    assert fmu.step(2.125, 0.5) == ERROR  # beyond the stop time
    assert fmu.step(2.125, 0.375) == OK
    keeper.free(state)
    fmu.free()


def in_event_mode(fmus, version):
    fmu = new(fmus[version], exchange=True)
    fmu.enter("continuous")
    it = Exchange(fmu, version)
    it.set({"mesh.transmission_error": 1e-6, "mesh.force": 30.0})
    it.states = np.random.default_rng(3).normal(size=it.n) * it.vector("GetNominalsOfContinuousStates")
    it.ok("EnterEventMode")
    return it


def test_model_exchange_goes_on(fmus, version):
    """States, derivatives, outputs and time of a continuous-time mode, in an instance that was somewhere else."""
    it, other = in_event_mode(fmus, version), new(fmus[version], exchange=True)
    it.set(CHANGES)
    it.update()
    it.ok("EnterContinuousTimeMode")
    it.ok("SetTime", 0.75)
    x, slope, outputs = it.states, it.derivatives, Run(it.fmu).outputs
    assert Keeper(other).take(it.fmu.serialised()) == OK
    there = Exchange(other, version)
    assert np.array_equal(there.states, x)
    assert np.array_equal(there.derivatives, slope)
    assert np.array_equal(other.get(outputs), it.fmu.get(outputs))
    there.states = x
    assert other.serialised() == it.fmu.serialised()
    it.fmu.free()
    other.free()


@pytest.mark.parametrize("read", [False, True])
def test_an_event_that_moves_states(fmus, version, read):
    """Kept between a change of damping and its update: that the states have changed is still to be said, once."""
    it, other = in_event_mode(fmus, version), new(fmus[version], exchange=True)
    it.set({"gear_train.modal_damping": 0.2})
    if read:
        it.fmu.get(["alpha"])
    assert Keeper(other).take(it.fmu.serialised()) == OK
    there = Exchange(other, version)
    assert it.update() is True
    assert there.update() is True
    assert there.update() is False
    assert np.array_equal(there.states, it.states)
    it.fmu.free()
    other.free()
