"""The state of a linear system is kept, restored and carried to another instance; that of another is refused."""

import ctypes as ct

import numpy as np
import pytest
from fmu_driver import OK
from linear_cases import dotted, random_system, started, unpacked_of

H = 3e-5


def drive(fmu, names, u, t):
    for k, row in enumerate(u):
        assert fmu.set(dict(zip(names, row))) == OK
        assert fmu.step(t + k * H, H) == OK, fmu.messages


def restore(fmu, blob: bytes) -> int:
    version = 3 if hasattr(fmu, "shape") else 2
    state = ct.c_void_p()
    read = {2: "fmi2DeSerializeFMUstate", 3: "fmi3DeserializeFMUState"}[version]
    status = fmu.call(read, ct.create_string_buffer(blob, len(blob)), ct.c_size_t(len(blob)), ct.byref(state))
    if status != OK:
        return status
    done = fmu.call({2: "fmi2SetFMUstate", 3: "fmi3SetFMUState"}[version], state)
    assert fmu.call({2: "fmi2FreeFMUstate", 3: "fmi3FreeFMUState"}[version], ct.byref(state)) == OK
    return done


@pytest.mark.parametrize("fmi", ["2.0", "3.0"])
@pytest.mark.parametrize("n", [0, 5, 12])
def test_a_run_goes_on_bit_by_bit(n, fmi, tmp_path):
    """Ten steps, keep, ten steps; another instance takes over the state and makes the same ten steps."""
    system = random_system(n, seed=8)
    unpacked = unpacked_of(system, tmp_path, fmi)
    names, outputs = dotted(system.input_labels), dotted(system.output_labels)
    everything = [*outputs, *dotted(system.state_labels), *names]
    u = np.random.default_rng(1).normal(size=(20, 2))
    first, second = started(unpacked), started(unpacked)
    drive(first, names, u[:10], 0.0)
    blob, kept = first.serialised(), first.get(everything)
    drive(first, names, u[10:], 10 * H)
    ended = first.get(everything)
    assert kept.tolist() != ended.tolist()
    for fmu in (first, second):
        assert restore(fmu, blob) == OK, fmu.messages
        assert fmu.get(everything).tolist() == kept.tolist()
        drive(fmu, names, u[10:], 10 * H)
        assert fmu.get(everything).tolist() == ended.tolist()
        fmu.free()


def test_states_of_others_are_refused(tmp_path):
    """Of another system of the same size, cut short, or with a number that is none."""
    mine = started(unpacked_of(random_system(4, seed=1), tmp_path / "mine"))
    other = started(unpacked_of(random_system(4, seed=2), tmp_path / "other"))
    drive(mine, ["mount_1.force_uy"], np.ones((3, 1)), 0.0)
    before = mine.get(["act_1"])
    blob = mine.serialised()
    for wrong, why in ((other.serialised(), "another model"), (blob[:-8], "size"), (blob[:-1] + b"\x7f", "checksum")):
        assert restore(mine, wrong) != OK
        assert why in mine.messages[-1]
        assert mine.get(["act_1"]) == before
    for fmu in (mine, other):
        fmu.free()


def test_reset_begins_again(tmp_path):
    system = random_system(5, seed=9)
    fmu = started(unpacked_of(system, tmp_path))
    names = dotted(system.input_labels)
    drive(fmu, names, np.ones((5, 2)), 0.0)
    ended = fmu.get(["act_1", "filter.z_3"])
    assert fmu.call("fmi2Reset") == OK
    fmu.start()
    assert fmu.get(["act_1", "filter.z_3"]).tolist() == [0.0, 0.0]
    drive(fmu, names, np.ones((5, 2)), 0.0)
    assert fmu.get(["act_1", "filter.z_3"]).tolist() == ended.tolist()
    fmu.free()
