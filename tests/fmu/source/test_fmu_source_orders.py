"""Order outputs: each tone's frequency, alpha and power against the power flow and against the measured power."""

from dataclasses import replace

import numpy as np
import pytest
from fmu_driver import OK, Fmu
from source_machine import NAMES, SPEED, tones, with_source

import gearpath as gp

BEARINGS = [f"bearing_{i}.power" for i in range(1, 5)]


def of(fmu, part):
    return fmu.get([f"{name}.{part}" for name in NAMES])


def off(fmu, *but):
    assert fmu.set({f"{name}.amplitude": 0.0 for name in NAMES if name not in but}) == OK


@pytest.mark.parametrize("speed", [SPEED, 611.7, -SPEED, 20.0])
def test_frequency_alpha_and_power_are_those_of_the_power_flow(fmu, fmu3, model, speed):
    frequency = abs(tones().order * speed / 60)
    flow = gp.power_flow(model, frequency)
    power = flow.transmitted_power.values * (tones().amplitude / gp.api.amplitude(model)) ** 2
    for instance in (fmu, fmu3):
        instance.start()
        assert instance.set({"mesh.speed": speed}) == OK
        np.testing.assert_allclose(of(instance, "frequency"), frequency, rtol=1e-14)
        np.testing.assert_allclose(of(instance, "alpha"), flow.alpha.values, rtol=1e-9)
        np.testing.assert_allclose(of(instance, "power"), power, rtol=1e-9)


def test_they_follow_speed_and_teeth_at_once(fmu, model):
    """Back and forth: a tone's value is kept for one frequency only."""
    fmu.start()
    for speed, teeth in ((SPEED, 37), (900.0, 37), (900.0, 20), (SPEED, 37)):
        assert fmu.set({"mesh.speed": speed, "mesh.teeth": float(teeth)}) == OK
        frequency = replace(tones(), teeth=teeth).order * speed / 60
        np.testing.assert_allclose(of(fmu, "alpha"), gp.power_flow(model, frequency).alpha.values, rtol=1e-9)


def test_they_follow_parameters_at_once(fmu, model):
    fmu.start()
    of(fmu, "alpha")
    values = {"mount_1.stiffness": 3e7, "gear_train.modal_damping": 0.03, "mesh.teeth": 41.0}
    assert fmu.set(values | {"mesh.harmonic_1.amplitude": 3e-6, "mesh.speed": 1111.0}) == OK
    changed = model.replace({"joints.mount_1.stiffness": 3e7, "components.gear_train.modal_damping": 0.03})
    frequency = np.array([41.0, 82.0, 40.0, 41.98, 82 - 2.413]) * 1111.0 / 60
    flow = gp.power_flow(changed, frequency)
    np.testing.assert_allclose(of(fmu, "frequency"), frequency, rtol=1e-14)
    np.testing.assert_allclose(of(fmu, "alpha"), flow.alpha.values, rtol=1e-9)
    assert of(fmu, "power")[0] == pytest.approx(9.0 * flow.transmitted_power.values[0], rel=1e-9)


def test_at_rest_nothing_flows(fmu):
    fmu.start()
    assert fmu.set({"mesh.speed": 0.0}) == OK
    for part in ("frequency", "alpha", "power"):
        assert not of(fmu, part).any()


def mean_power(fmu, samples, period):
    """Mean of the power through all bearings over one period, after transients; exact for a band-limited signal."""
    fmu.run(["mesh.force"], np.zeros((1500, 1)), 1e-3, BEARINGS)
    found = fmu.run(["mesh.force"], np.zeros((samples, 1)), period / samples, BEARINGS, start=1.5)
    return found[:-1].sum(axis=1).mean()


@pytest.mark.parametrize("name", NAMES)
def test_power_of_a_tone_is_what_the_bearings_carry(fmu, name):
    """The outputs over time, averaged over a period of the steady state, against the output over frequency."""
    fmu.start()
    off(fmu, name)
    expected = fmu.get([f"{name}.power"])[0]
    period = 1.0 / fmu.get([f"{name}.frequency"])[0]
    assert expected > 0
    assert mean_power(fmu, 32, period) == pytest.approx(expected, rel=1e-6)


def test_powers_of_tones_add_up(fmu):
    """Over a whole revolution tones of different whole orders do not disturb each other."""
    fmu.start()
    off(fmu, *NAMES[:3])
    assert mean_power(fmu, 500, 60 / SPEED) == pytest.approx(of(fmu, "power").sum(), rel=1e-6)


def test_of_another_mesh_than_the_excitation(tmp_path):
    """The excitation of the model is a force; the orders go by the transmission error of the source's mesh."""
    model = with_source().replace({"excitation.point": "casing", "excitation.dof": "uy"})
    fmu = Fmu(Fmu.unpack(gp.export_fmu(model, tmp_path / "point.fmu"), tmp_path / "unpacked"))
    fmu.start()
    frequency = tones().order * SPEED / 60
    flow = gp.power_flow(with_source(), frequency)
    np.testing.assert_allclose(of(fmu, "alpha"), flow.alpha.values, rtol=1e-9)
    assert fmu.set({"frequency": frequency[0]}) == OK
    assert fmu.get(["alpha"])[0] == pytest.approx(gp.power_flow(model, frequency[:1]).alpha.values[0], rel=1e-9)
    fmu.free()
