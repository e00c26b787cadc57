"""States: kept, restored, serialised, and carried to other instances and processes: runs go on bit by bit."""

import os
import subprocess
import sys
from dataclasses import replace

import fmu_states
import numpy as np
import pytest
from fmu_driver import ERROR, OK, Fmu
from fmu_helpers import export
from fmu_networks import CHANGES, gearbox
from fmu_states import INPUTS, STEPS, Keeper, Run, new

from gearpath.network.records import MeshSource, Tone

EITHER = pytest.mark.parametrize("version", [2, 3])
START = gearbox()


@pytest.fixture(scope="module")
def fmus(unpacked, unpacked3):
    return {2: unpacked, 3: unpacked3}


def steps(run, count=5):
    for h in STEPS[:count]:
        run.step(h)


def modal(run):
    steps(run)


def dense(run):
    run.set(CHANGES)
    steps(run)


def pending(run):
    """A change that nobody has asked about yet."""
    steps(run)
    run.set(CHANGES)


def pending_damping(run):
    steps(run)
    run.set({"gear_train.modal_damping": 0.2})


def back(run):
    """Start values again, but no step yet that could go back to modal coordinates."""
    dense(run)
    joints = {joint.name: joint for joint in START.joints}
    run.set({n: getattr(joints[n.split(".")[0]], n.split(".")[1]) for n in CHANGES if "modal" not in n})
    run.set({"gear_train.modal_damping": START.modal_damping["gear_train"]})


def back_and_read(run):
    back(run)
    run.fmu.get(run.outputs)


def returned(run):
    back(run)
    steps(run)


def many_sizes(run):
    steps(run, len(STEPS))


def sloping(run):
    """Input derivatives given for the coming step, the frequency's too (FMI 2)."""
    steps(run)
    assert run.fmu.set_slopes({n: 1e3 * INPUTS[n] for n in run.inputs} | {"frequency": 1e5}) == OK


def not_begun(_run):
    pass


SITUATIONS = {
    f.__name__: f
    for f in (modal, dense, pending, pending_damping, back, back_and_read, returned, many_sizes, sloping, not_begun)
}
CASES = [(version, name) for version in (2, 3) for name in SITUATIONS if (version, name) != (3, "sloping")]


def prepared(unpacked, name) -> Run:
    fmu = new(unpacked)
    if name == "many_sizes":  # and a state of one's own to begin with
        values = np.random.default_rng(1).normal(size=54) * 1e-5
        states = [v.derivative.name for v in unpacked.description.modelVariables if v.derivative is not None]
        assert fmu.set({"state": values} if states == ["state"] else dict(zip(states, values))) == OK
    fmu.start()
    run = Run(fmu)
    SITUATIONS[name](run)
    return run


def same(first, second):
    assert np.array_equal(first[0], second[0])
    assert first[1] == second[1]


@pytest.mark.parametrize(("version", "name"), CASES)
def test_a_run_goes_on_bit_by_bit(fmus, version, name):
    """The same instance, another one, and one that was somewhere else; and keeping a state does no harm."""
    plain = prepared(fmus[version], name)
    wanted = plain.go_on()
    assert (wanted[0][-1] != 0).any()
    run = prepared(fmus[version], name)
    keeper, made, time = Keeper(run.fmu), run.made, run.time
    state, content = keeper.keep(), run.fmu.serialised()
    same(run.go_on(), wanted)
    assert keeper.restore(state) == OK
    assert run.fmu.serialised() == content
    same(Run(run.fmu, made=made, time=time).go_on(), wanted)

    fresh = new(fmus[version])  # straight from instantiation, by the handle of another instance
    assert Keeper(fresh).restore(state) == OK
    same(Run(fresh, made=made, time=time).go_on(), wanted)

    elsewhere = prepared(fmus[version], "dense")
    elsewhere.set({"bearing_3.stiffness": np.diag([1e8, 1e4]), "frequency": 123.0})
    steps(elsewhere)
    keeper.free(state)
    assert Keeper(elsewhere.fmu).take(content) == OK
    assert elsewhere.fmu.serialised() == content
    same(Run(elsewhere.fmu, made=made, time=time).go_on(), wanted)
    for fmu in (plain.fmu, run.fmu, fresh, elsewhere.fmu):
        fmu.free()


@EITHER
def test_a_run_goes_on_in_another_process(fmus, fmu_path, fmu3_path, version, tmp_path):
    """Every situation at once, from the bytes alone."""
    os.symlink({2: fmu_path, 3: fmu3_path}[version], tmp_path / "it.fmu")
    wanted = {}
    for name in [n for v, n in CASES if v == version]:
        run = prepared(fmus[version], name)
        (tmp_path / f"{name}.state").write_bytes(run.fmu.serialised())
        np.save(tmp_path / f"{name}.at.npy", [run.made, run.time])
        wanted[name] = run.go_on()
        run.fmu.free()
    done = subprocess.run([sys.executable, fmu_states.__file__, tmp_path], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    for name, expected in wanted.items():
        same((np.load(tmp_path / f"{name}.npy"), (tmp_path / f"{name}.end").read_bytes()), expected)


@EITHER
def test_a_gear_mesh_source_goes_on(version, tmp_path):
    """Its angle, speed and tones, on the way of a run-up where FMI 2 lets the speed have a slope."""
    tones = (Tone("mesh.one", 1.0, 0.0, 1e-6, 0.3), Tone("mesh.two", 2.0, -0.7, 2e-7, -1.0))
    network = replace(START, source=MeshSource("mesh.transmission_error", 2000.0, 31, tones))
    path = export(network, tmp_path / "it.fmu", fmi=f"{version}.0")
    unpacked = Fmu.unpack(path, tmp_path / "it")
    run = Run(new(unpacked))
    run.fmu.start()
    for i, h in enumerate([1e-4, 0.3, 1e-3, 1e-5]):
        run.set({"mesh.speed": 1500.0 + 400 * i, "mesh.one.phase": 0.1 * i})
        run.step(h)
    if version == 2:
        assert run.fmu.set_slopes({"mesh.speed": 1e4}) == OK
    content, made, time = run.fmu.serialised(), run.made, run.time
    wanted = run.go_on()
    other = new(unpacked)
    assert Keeper(other).take(content) == OK
    same(Run(other, made=made, time=time).go_on(), wanted)
    run.fmu.free()
    other.free()


def test_an_entry_that_waits_for_the_others(unpacked):
    """A matrix that is half set, and indefinite as yet, is carried over as such (FMI 2)."""
    run, alphas = prepared(unpacked, "modal"), []
    start = run.fmu.serialised()
    run.set({"bearing_1.stiffness[1,2]": 1e7})
    content = run.fmu.serialised()
    assert content != start
    other = Fmu(unpacked)
    assert Keeper(other).take(content) == OK
    for fmu in (run.fmu, other):
        assert fmu.set({"bearing_1.stiffness[2,2]": 5e6}) == OK
        alphas.append(fmu.get(["alpha", "bearing_1.stiffness[1,2]"]))
    assert np.array_equal(*alphas)
    assert alphas[0][1] == 1e7
    assert Keeper(other).take(content) == OK  # without the rest it falls back, as it does anywhere
    assert other.try_get(["alpha"])[1] == ERROR or other.step(run.time, 1e-5) == ERROR
    assert other.get(["bearing_1.stiffness[1,2]"])[0] == START.joints[0].stiffness[0, 1]
    run.fmu.free()
    other.free()


@EITHER
@pytest.mark.parametrize("frequency", [0.0, -700.0])
def test_a_state_at_any_frequency(fmus, version, frequency):
    fmu = new(fmus[version])
    fmu.start()
    assert fmu.set({"frequency": frequency}) == OK
    content = fmu.serialised()
    assert Keeper(fmu).take(content) == OK, fmu.messages
    assert fmu.serialised() == content
    fmu.free()


@pytest.mark.parametrize("end", [0.3])
def test_a_state_past_the_stop_time_by_rounding(fmus, end):
    """Three steps of 0.1 s end at 0.30000000000000004 s."""
    fmu = new(fmus[2])
    fmu.start(stop=end)
    for i in range(3):
        assert fmu.step(i * 0.1, 0.1) == OK, fmu.messages
    content = fmu.serialised()
    assert Keeper(fmu).take(content) == OK, fmu.messages
    assert fmu.serialised() == content
    fmu.free()
