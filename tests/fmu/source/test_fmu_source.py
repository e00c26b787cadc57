"""The gear mesh source in time: exact at steady speed, in run-ups, over a million revolutions, saved and restored."""

import ctypes as ct
import math
from fractions import Fraction

import numpy as np
import pytest
from fmi3_driver import Fmu3
from fmu_driver import OK, Fmu
from fmu_states import Keeper
from source_machine import (
    HARMONICS,
    MODELS,
    NAMES,
    OUT,
    SIDEBANDS,
    SPEED,
    TEETH,
    Machine,
    Tones,
    deviation,
    run_up_angle,
    tones,
    with_source,
)

import gearpath as gp

STEPS = [(1e-6, 1000), (1e-5, 1000), (1e-4, 300), (1e-3, 100), (2e-2, 20)]  # the last has hundreds of parts


def idle(fmu, names, h, steps, start=0.0):
    """Steps with all inputs at 0; outputs (steps + 1, names)."""
    return fmu.run(["mesh.force"], np.zeros((steps, 1)), h, names, start=start)


@pytest.mark.parametrize(("h", "steps"), STEPS)
def test_steady_speed(fmu, machine, h, steps):
    fmu.start()
    expected = machine.outputs(*machine.at_steady_speed(tones(), SPEED, h, steps))
    assert deviation(idle(fmu, machine.names, h, steps), expected, machine.names) < 1e-11


@pytest.mark.parametrize("speed", [-SPEED, 0.0, 17.3, 20_000.0])
def test_any_speed(fmu, machine, speed):
    """Backwards, at rest (a constant error), slowly and fast."""
    fmu.start()
    assert fmu.set({"mesh.speed": speed}) == OK
    expected = machine.outputs(*machine.at_steady_speed(tones(), speed, 1e-4, 300))
    assert deviation(idle(fmu, machine.names, 1e-4, 300), expected, machine.names) < 1e-11


@pytest.mark.parametrize(("h", "steps"), STEPS)
def test_after_a_joint_was_exchanged(fmu, model, h, steps):
    """The dense propagator."""
    K, C = np.array([[6e7, 2e5], [2e5, 3e4]]), np.array([[150.0, 1.0], [1.0, 0.05]])
    entries = {"[1,1]": (0, 0), "[1,2]": (0, 1), "[2,2]": (1, 1)}
    fmu.start()
    assert fmu.set({f"bearing_2.stiffness{name}": K[at] for name, at in entries.items()}) == OK
    assert fmu.set({f"bearing_2.damping{name}": C[at] for name, at in entries.items()}) == OK
    machine = Machine(model.replace({"joints.bearing_2.stiffness": K, "joints.bearing_2.damping": C}))
    expected = machine.outputs(*machine.at_steady_speed(tones(), SPEED, h, steps))
    assert deviation(idle(fmu, machine.names, h, steps), expected, machine.names) < 1e-11


def test_a_machine_that_drifts(tmp_path):
    """The helical gearbox in six degrees of freedom: its shafts turn freely, and axes couple in all directions."""
    model = with_source("helical_gearbox.toml")
    machine = Machine(model)
    fmu = Fmu(Fmu.unpack(gp.export_fmu(model, tmp_path / "helical.fmu"), tmp_path / "unpacked"))
    fmu.start()
    expected = machine.outputs(*machine.at_steady_speed(tones(), SPEED, 1e-4, 200))
    assert deviation(idle(fmu, machine.names, 1e-4, 200), expected, machine.names) < 1e-11
    fmu.free()


def test_steps_of_a_whole_cycle_of_a_mode_that_nothing_damps(tmp_path):
    """There the integral of the mode's motion over the step vanishes, which must not cost its higher moments."""
    none = {f"joints.bearing_{i}.damping": [[0.0, 0.0], [0.0, 0.0]] for i in range(1, 5)}
    none |= {f"joints.mount_{i}.damping": 0.0 for i in range(1, 5)}
    model = with_source(speed=100.0).replace(none | {"components.gear_train.modal_damping": 0.0})
    machine = Machine(model)
    unpacked = Fmu.unpack(gp.export_fmu(model, tmp_path / "undamped.fmu"), tmp_path / "unpacked")
    for hertz in gp.natural_frequencies(model)[::5][:8]:
        fmu = Fmu(unpacked)
        fmu.start()
        expected = machine.outputs(*machine.at_steady_speed(tones(), 100.0, 1 / hertz, 50))
        found = idle(fmu, machine.names, 1 / hertz, 50)
        fmu.free()
        assert deviation(found, expected, machine.names) < 1e-10


def test_adds_to_the_input(fmu, machine):
    """Transmission error and force from outside go on acting beside the source."""
    h, steps = 1e-5, 500
    u = np.random.default_rng(3).normal(size=(steps, 2)) * [1e-6, 10.0]
    without = {f"{name}.amplitude": 0.0 for name in NAMES}
    fmu.start()
    both = fmu.run([OUT, "mesh.force"], u, h, machine.linear)
    other = Fmu(fmu.unpacked)
    other.start()
    assert other.set(without) == OK
    inputs = other.run([OUT, "mesh.force"], u, h, machine.linear)
    other.free()
    source = machine.outputs(*machine.at_steady_speed(tones(), SPEED, h, steps))[:, : len(machine.linear)]
    assert deviation(both - inputs, source, machine.linear) < 1e-11


@pytest.fixture(scope="module")
def run_up(machine):
    """0 to 6000 rev/min in 0.1 s: every 10 us, by quadrature."""
    x, e = machine.in_run_up(tones(), 0.0, 6e4, 1e-5, 10_000)
    return machine.outputs(x, e)


@pytest.mark.parametrize("h", [1e-5, 1e-4, 1e-3])
def test_run_up(fmu, machine, run_up, h):
    every, steps = round(h / 1e-5), round(0.1 / h)
    speed = 6e4 * h * np.arange(steps)[:, None]
    fmu.start()
    found = fmu.run(["mesh.speed"], speed, h, machine.names, slopes=np.full((steps, 1), 6e4))
    assert deviation(found, run_up[::every], machine.names) < 1e-9
    assert fmu.get(["mesh.angle"])[0] == pytest.approx(run_up_angle(0.0, 6e4, 0.1), rel=1e-13)


def test_run_down_through_standstill(fmu, machine):
    """From 1500 to -1500 rev/min."""
    h, steps, rate = 1e-4, 500, -6e4
    x, e = machine.in_run_up(tones(), 1500.0, rate, 1e-5, 10 * steps)
    speed = 1500.0 + rate * h * np.arange(steps)[:, None]
    fmu.start()
    found = fmu.run(["mesh.speed"], speed, h, machine.names, slopes=np.full((steps, 1), rate))
    assert deviation(found, machine.outputs(x, e)[::10], machine.names) < 1e-9


@pytest.mark.parametrize(("start", "stop"), [(0.0, 6000.0), (6000.0, 0.0), (4000.0, -4000.0)])
def test_all_of_it_in_one_step(fmu, machine, start, stop):
    """20 ms in one step: its parts resolve the fastest tone wherever in the step that is."""
    h, rate = 0.02, (stop - start) / 0.02
    x, e = machine.in_run_up(tones(), start, rate, 1e-5, 2000)
    expected = machine.outputs(x, e)
    fmu.start()
    fmu.run(["mesh.speed"], [[start]], h, machine.names, slopes=[[rate]])
    found = fmu.get(machine.names)
    assert (abs(found - expected[-1]) / abs(expected).max(axis=0)).max() < 1e-9


def test_run_up_in_fmi_3(source3, machine, run_up):
    """The speed at the end of a step is given in the intermediate update."""
    h, steps = 1e-4, 1000

    def give_end(fmu, time, asked, _readable):
        if asked:
            assert fmu.set({"mesh.speed": 6e4 * time}) == OK

    reference = {v.name: v.valueReference for v in source3.description.modelVariables}
    fmu = Fmu3(source3, required=[reference["mesh.speed"]], intermediate=give_end)
    fmu.start()
    assert fmu.set({"mesh.speed": 0.0}) == OK
    found = [fmu.get(machine.names)]
    for k in range(steps):
        assert fmu.step(k * h, h) == OK, fmu.messages
        found.append(fmu.get(machine.names))
    assert deviation(found, run_up[::10], machine.names) < 1e-9
    fmu.free()


def test_steady_speed_in_fmi_3(fmu3, machine):
    h, steps = 1e-4, 200
    fmu3.start()
    found = [fmu3.get(machine.names)]
    for k in range(steps):
        assert fmu3.step(k * h, h) == OK
        found.append(fmu3.get(machine.names))
    expected = machine.outputs(*machine.at_steady_speed(tones(), SPEED, h, steps))
    assert deviation(found, expected, machine.names) < 1e-11
    assert fmu3.get(["state"])[-1] == pytest.approx(2 * np.pi * SPEED / 60 * h * steps, rel=1e-14)


def test_tone_switched_on_while_running(fmu, machine):
    """All off, then two tones on: their phases are those of the angle turned until then."""
    h, quiet, steps = 1e-4, 333, 300
    fmu.start()
    assert fmu.set({f"{name}.amplitude": 0.0 for name in NAMES}) == OK
    assert not idle(fmu, machine.names, h, quiet).any()
    assert fmu.set({f"{NAMES[i]}.amplitude": tones().amplitude[i] for i in (0, 3)}) == OK
    found = idle(fmu, machine.names, h, steps, start=quiet * h)
    expected = machine.outputs(*machine.at_steady_speed(tones().only(0, 3), SPEED, h, steps, first=quiet))
    assert deviation(found, expected, machine.names) < 1e-11


def test_teeth_and_phase_changed_while_running(fmu, machine):
    """The motion goes on from its state with the other transmission error."""
    h, before, steps = 1e-4, 200, 300
    first, _ = machine.at_steady_speed(tones(), SPEED, h, before)
    fmu.start()
    idle(fmu, machine.names, h, before)
    assert fmu.set({"mesh.teeth": 41.0, "mesh.harmonic_1.phase": -0.4}) == OK
    found = idle(fmu, machine.names, h, steps, start=before * h)
    t = tones()
    changed = Tones(t.harmonic, t.shift, t.amplitude, np.concatenate([[-0.4], t.phase[1:]]), 41)
    expected = machine.outputs(*machine.at_steady_speed(changed, SPEED, h, steps, start=first[-1], first=before))
    assert deviation(found, expected, machine.names) < 1e-11


def test_a_million_revolutions_lose_no_phase(fmu, machine):
    """Against exact rational arithmetic on the very doubles that the FMU was given."""
    h, speed, steps = 0.05, 3001.7, 400_000
    output = machine.linear[int(np.argmax(abs(machine.d)))]
    gain = machine.d[machine.linear.index(output)]  # the state stays 0 while all tones are off: output = gain * e
    fmu.start()
    assert fmu.set({f"{name}.amplitude": 0.0 for name in NAMES} | {"mesh.speed": speed}) == OK
    t, step, c = 0.0, fmu.unpacked.library.fmi2DoStep, fmu.c
    for _ in range(steps):
        assert step(c, t, h, 1) == OK
        t += h
    turns = steps * Fraction(h) * Fraction(speed) / 60
    assert turns > 1_000_000
    for i, (harmonic, shift) in enumerate([(h, 0.0) for h, *_ in HARMONICS] + [(h, s) for h, s, *_ in SIDEBANDS]):
        wave = []
        for phase in (0.0, -math.pi / 2):
            assert fmu.set({f"{NAMES[i]}.amplitude": 1e-3, f"{NAMES[i]}.phase": phase}) == OK
            wave.append(fmu.get([output])[0] / gain / 1e-3)
        assert fmu.set({f"{NAMES[i]}.amplitude": 0.0}) == OK
        cycles = (harmonic * TEETH + Fraction(shift)) * turns
        angle = 2 * math.pi * float(cycles - cycles.__floor__())
        slip = math.remainder(math.atan2(wave[1], wave[0]) - angle, 2 * math.pi)
        assert abs(slip) < 1e-9
    assert fmu.get(["mesh.angle"])[0] == pytest.approx(2 * math.pi * float(turns), rel=1e-15)


def test_state_saved_and_restored_in_a_run_up(fmu, source2, machine):
    """Bit for bit, in the same instance and in a new one, with a slope pending."""
    h, speed, slope = 1e-4, 1234.5, 4e4

    def on(instance, start):
        out = []
        for k in range(50):
            assert instance.step(start + k * h, h) == OK
            assert instance.set({"mesh.speed": speed + slope * (k + 1) * h}) == OK
            assert instance.set_slopes({"mesh.speed": slope}) == OK
            out.append(instance.get([*machine.names, "mesh.angle"]))
        return np.array(out)

    fmu.start()
    idle(fmu, machine.names, h, 77)
    assert fmu.set({"mesh.speed": speed, "mesh.sideband_2.amplitude": 4e-7}) == OK
    assert fmu.set_slopes({"mesh.speed": slope}) == OK
    state, content = ct.c_void_p(), fmu.serialised()
    assert fmu.call("fmi2GetFMUstate", ct.byref(state)) == OK
    first = on(fmu, 77 * h)
    assert fmu.call("fmi2SetFMUstate", state) == OK
    np.testing.assert_array_equal(on(fmu, 77 * h), first)
    assert fmu.call("fmi2FreeFMUstate", ct.byref(state)) == OK
    other, place = Fmu(source2), ct.c_void_p()
    other.start()
    assert other.call("fmi2DeSerializeFMUstate", content, len(content), ct.byref(place)) == OK, other.messages
    assert other.call("fmi2SetFMUstate", place) == OK
    np.testing.assert_array_equal(on(other, 77 * h), first)
    assert other.call("fmi2FreeFMUstate", ct.byref(place)) == OK
    other.free()


def test_reset_and_run_again(fmu, machine):
    fmu.start()
    first = idle(fmu, machine.names, 1e-4, 50)
    assert fmu.set({"mesh.speed": 100.0, "mesh.harmonic_1.phase": 1.0, "mesh.teeth": 12.0}) == OK
    idle(fmu, machine.names, 1e-4, 50, start=50e-4)
    assert fmu.call("fmi2Reset") == OK
    fmu.start()
    np.testing.assert_array_equal(idle(fmu, machine.names, 1e-4, 50), first)


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"mesh.teeth": 20.5}, "is a tooth count and must be a whole number from 1 to 1,000,000."),
        ({"mesh.teeth": 0.0}, "is a tooth count and must be a whole number from 1 to 1,000,000."),
        ({"mesh.speed": np.nan}, "must be set to a finite number."),
        ({"mesh.harmonic_1.amplitude": np.inf}, "must be set to a finite number."),
        ({"mesh.harmonic_1.frequency": 100.0}, "is a result and cannot be set."),
    ],
)
def test_what_is_refused(fmu, values, sentence):
    fmu.start()
    before = fmu.serialised()
    assert fmu.set(values) != OK
    assert sentence in fmu.messages[-1]
    assert fmu.serialised() == before


@pytest.mark.parametrize("amplitude", [0.0, 1e-6])
def test_a_step_that_turns_on_without_limit_is_refused(fmu, amplitude):
    fmu.start()
    assert fmu.set({f"{name}.amplitude": amplitude for name in NAMES} | {"mesh.speed": 1e308}) == OK
    assert fmu.set_slopes({"mesh.speed": 1e308}) == OK
    before = fmu.serialised()
    assert fmu.step(0.0, 10.0) != OK
    assert "smaller step" in fmu.messages[-1] or "without limit" in fmu.messages[-1]
    assert fmu.serialised() == before
    assert fmu.set({"mesh.speed": SPEED}) == OK
    assert fmu.set_slopes({"mesh.speed": 0.0}) == OK
    assert fmu.step(0.0, 1e-3) == OK


def test_without_the_table_there_is_no_source(tmp_path):
    """No variable of it in the FMU, and not one byte."""
    plain = gp.export_fmu(gp.load(MODELS / "gearbox.toml"), tmp_path / "plain.fmu")
    names = {v.name for v in Fmu.unpack(plain, tmp_path / "plain").description.modelVariables}
    assert not {name for name in names if name.startswith((*NAMES, "mesh.speed", "mesh.teeth", "mesh.angle"))}
    again = gp.export_fmu(with_source().replace({"source": None}), tmp_path / "again.fmu")
    assert again.read_bytes() == plain.read_bytes()


@pytest.mark.parametrize("turns", [10**6, -(10**12)])
def test_a_phase_of_many_turns(fmu, turns):
    """A phase p is the phase of its place in the circle; the doubles nearest to both differ by what is known here."""
    pi = Fraction("3.14159265358979323846264338327950288419716939937510")
    large = float(2 * pi * turns + Fraction(0.7))
    small = float(Fraction(large) - 2 * pi * turns)
    assert abs(small - 0.7) < 1e-3
    ends = []
    for phase in (large, small):
        if ends:
            assert fmu.call("fmi2Reset") == OK
        fmu.start()
        assert fmu.set({"mesh.harmonic_1.phase": phase}) == OK
        assert fmu.step(0.0, 1e-3) == OK
        ends.append(fmu.get(["bearing_1.force_uy", "casing.velocity_uy"]))
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-11)


def test_a_state_with_a_huge_angle_is_taken_back(fmu):
    assert fmu.set({"mesh.angle": 1e18}) == OK  # before the simulation, as any state
    fmu.start()
    assert fmu.get(["mesh.angle"])[0] == 1e18
    content = fmu.serialised()
    assert Keeper(fmu).take(content) == OK, fmu.messages
    assert fmu.serialised() == content
