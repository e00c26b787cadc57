"""Directional and adjoint derivatives by the source's speed, angle, amplitudes, phases and tooth count."""

import ctypes as ct
from dataclasses import replace

import numpy as np
import pytest
from fmu_driver import OK, Fmu, reals
from source_machine import NAMES, SPEED, TEETH, deviation, run_up_angle, tones

import gearpath as gp

H, STEPS = 1e-4, 123
TINY = 1e-30  # of a complex step, which has no rounding


def directional(fmu, unknowns, known, seed=1.0):
    """Of an FMI 2 instance."""
    result = (ct.c_double * len(unknowns))()
    status = fmu.call(
        "fmi2GetDirectionalDerivative",
        fmu.references(unknowns), len(unknowns), fmu.references([known]), 1, reals([seed]), result,
    )  # fmt: skip
    assert status == OK, fmu.messages
    return np.array(result)


def error_along(known):
    """d e / d known at the angle turned so far, by a complex step of the definition."""
    t, angle = tones(), complex(run_up_angle(SPEED, 0.0, H * STEPS))
    part, _, what = known.rpartition(".")
    if known == "mesh.angle":
        angle += 1j * TINY
    elif known == "mesh.teeth":
        t = replace(t, teeth=TEETH + 1j * TINY)
    elif known == "mesh.speed":
        return 0.0
    else:
        bump = 1j * TINY * (np.arange(len(NAMES)) == NAMES.index(part))
        t = replace(t, **{what: getattr(t, what) + bump})
    return t.at(angle).imag / TINY


KNOWNS = ["mesh.speed", "mesh.angle", "mesh.teeth", "mesh.harmonic_2.amplitude", "mesh.sideband_2.phase"]


@pytest.fixture
def moving(fmu):
    fmu.start()
    fmu.run(["mesh.force"], np.zeros((STEPS, 1)), H, ["alpha"])
    return fmu


@pytest.mark.parametrize("known", KNOWNS)
def test_outputs_over_time(moving, machine, known):
    change = error_along(known)
    found = directional(moving, machine.names, known)
    y = dict(zip(machine.names, moving.get(machine.names)))
    expected = dict(zip(machine.linear, machine.d * change))
    for power, pairs in machine.powers.items():
        expected[power] = sum(expected[f] * y[v] + y[f] * expected[v] for f, v in pairs)
    wanted = [list(expected.values())]
    if known == "mesh.speed":
        assert not found.any()
    else:
        assert abs(change) > 0
        assert deviation([found], wanted, machine.names) < 1e-11


@pytest.mark.parametrize("known", KNOWNS)
def test_derivatives_of_the_states(moving, machine, known):
    states = [v.name for v in moving.unpacked.description.modelVariables if v.name.startswith("der(gear_train")]
    found = directional(moving, states, known)
    names = list(moving.reference)
    rows = [names.index(name) - names.index("der(gear_train.mode_1.x)") for name in states]
    expected = machine.b[rows] * error_along(known)
    np.testing.assert_allclose(found, expected, atol=1e-11 * abs(machine.b).max() * abs(error_along(known)), rtol=0)
    of_angle = directional(moving, ["der(mesh.angle)"], known)[0]
    assert of_angle == pytest.approx(2 * np.pi / 60 if known == "mesh.speed" else 0.0, rel=1e-15, abs=0)


@pytest.mark.parametrize("known", ["mesh.harmonic_1.amplitude", "mesh.sideband_1.phase"])
def test_against_differences_of_the_fmu_itself(moving, machine, known):
    found = directional(moving, machine.linear, known)
    start, step = moving.get([known])[0], 1e-8 if known.endswith("amplitude") else 1e-5
    values = []
    for at in (start + step, start - step):
        assert moving.set({known: at}) == OK
        values.append(moving.get(machine.linear))
    difference = (values[0] - values[1]) / (2 * step)
    # a feedthrough that is 0 but for rounding has no derivative to compare
    size = np.abs(difference).max(initial=0.0)
    real = abs(machine.d) > 1e-9 * abs(machine.d).max()
    assert size > 0
    np.testing.assert_allclose(found[real], difference[real], rtol=1e-5)


def test_orders_by_speed_and_teeth(fmu, model):
    """Against differences of the power flow over frequency."""
    fmu.start()
    frequency, step = tones().order * SPEED / 60, 1e-3
    up, down = (gp.power_flow(model, frequency + sign * step) for sign in (1, -1))
    scale = (tones().amplitude / gp.api.amplitude(model)) ** 2
    slope = {
        "frequency": np.ones(len(NAMES)),
        "alpha": (up.alpha.values - down.alpha.values) / (2 * step),
        "power": (up.transmitted_power.values - down.transmitted_power.values) / (2 * step) * scale,
    }
    for known, hertz in (("mesh.speed", tones().order / 60), ("mesh.teeth", tones().harmonic * SPEED / 60)):
        for part, change in slope.items():
            found = directional(fmu, [f"{name}.{part}" for name in NAMES], known)
            np.testing.assert_allclose(found, change * hertz, rtol=1e-6)


def test_orders_by_amplitude_and_stiffness(fmu):
    fmu.start()
    powers, known = [f"{name}.power" for name in NAMES], "mesh.harmonic_2.amplitude"
    found, power = directional(fmu, powers, known), fmu.get(powers)
    assert found[1] == pytest.approx(2 * power[1] / tones().amplitude[1], rel=1e-13)
    assert not found[[0, 2, 3, 4]].any()
    assert not directional(fmu, powers, "mesh.harmonic_2.phase").any()
    stiffness = "bearing_1.stiffness[1,1]"
    found, start, values = directional(fmu, powers, stiffness), fmu.get([stiffness])[0], []
    for factor in (1 + 1e-5, 1 - 1e-5):
        assert fmu.set({stiffness: factor * start}) == OK
        values.append(fmu.get(powers))
    np.testing.assert_allclose(found, (values[0] - values[1]) / (2e-5 * start), rtol=1e-5)


def test_backwards_the_frequency_falls_with_the_speed(fmu):
    fmu.start()
    assert fmu.set({"mesh.speed": -SPEED}) == OK
    found = directional(fmu, [f"{name}.frequency" for name in NAMES], "mesh.speed")
    np.testing.assert_allclose(found, -tones().order / 60, rtol=1e-14)


def test_fmi_3_and_its_adjoint(fmu3, machine, source2):
    """The same derivatives by the array of states, and their transpose."""
    other = Fmu(source2)
    fmu3.start()
    other.start()
    for k in range(STEPS):
        assert fmu3.step(k * H, H) == OK
        assert other.step(k * H, H) == OK
    n, m = fmu3.shape["state"][0], len(machine.names)
    seed = np.zeros(n)
    seed[-1] = 1.0
    found = (ct.c_double * m)()
    arguments = (fmu3.references(machine.names), m, fmu3.references(["state"]), 1, reals(seed), n, found, m)
    assert fmu3.call("fmi3GetDirectionalDerivative", *arguments) == OK, fmu3.messages
    np.testing.assert_array_equal(np.array(found), directional(other, machine.names, "mesh.angle"))
    weight, back = np.random.default_rng(1).normal(size=m), (ct.c_double * n)()
    arguments = (fmu3.references(machine.names), m, fmu3.references(["state"]), 1, reals(weight), m, back, n)
    assert fmu3.call("fmi3GetAdjointDerivative", *arguments) == OK, fmu3.messages
    assert back[n - 1] == pytest.approx(weight @ np.array(found), rel=1e-12)
    other.free()
