"""The default gearbox: the numbers that an independent implementation found, to all printed digits."""

from dataclasses import replace

import numpy as np
import pytest
from systems import BEARING, default_gearbox, scaled

from gearpath.components import modes
from gearpath.network.assemble import assemble
from gearpath.network.natural import natural_frequencies
from gearpath.network.power import is_moment_path, power_flow
from gearpath.network.reference import reference_solution

GRID = 2 * np.pi * np.arange(10.0, 5001.0, 10.0)


def test_source_modes(network):
    found = modes(network.structures["gear_train"]).frequencies
    assert np.all(found[:4] == 0.0)
    assert [round(f, 2) for f in found[4:9]] == [1509.19, 1585.14, 3383.51, 3426.32, 3682.29]


def test_equivalent_mass(network):
    assert round(network.structures["gear_train"].meshes["mesh"].equivalent_mass, 5) == 0.38530


def test_assembled_natural_frequencies(modal):
    found = natural_frequencies(modal)
    assert [round(f, 2) for f in found[:5]] == [206.63, 231.42, 295.59, 518.88, 699.38]
    assert [round(f, 1) for f in found[5:7]] == [2149.2, 2245.6]


def test_alpha(modal):
    alpha = power_flow(modal, 2 * np.pi * np.array([100.0, 1000.0, 3000.0])).share()
    assert [f"{a:.6g}" for a in alpha] == ["0.922844", "0.0312096", "0.000380829"]


def test_moment_part_is_small(modal):
    flow = power_flow(modal, GRID)
    moment, force = flow.share(is_moment_path), flow.share(lambda path: not is_moment_path(path))
    assert 1e-4 < np.median(abs(moment) / abs(force)) < 1e-3


def test_synthesis_against_direct_solution(network, modal):
    omega = GRID[::10]
    reference, flow = reference_solution(network, omega), power_flow(modal, omega)
    for row, force in enumerate(flow.force):
        assert np.max(abs(force - reference.force[row]) / abs(reference.force[row])) < 1e-9
    np.testing.assert_allclose(flow.share(), reference.alpha, rtol=1e-8)
    np.testing.assert_allclose(flow.input_power, reference.input_power, rtol=1e-8)


def test_ratios_do_not_depend_on_the_amplitude(modal):
    one, other = power_flow(modal, GRID[:20], 1.0), power_flow(modal, GRID[:20], 3e-6)
    np.testing.assert_allclose(other.share(), one.share(), rtol=1e-14)
    np.testing.assert_allclose(other.input_power, 9e-12 * one.input_power, rtol=1e-14)


def test_mirrored_coupling_leaves_no_moment_path():
    """Coupling of opposite sign at the two ends mirrors the machine about its middle plane: no tilt, no moment."""
    system = default_gearbox()
    joints = dict(system.joints)
    for k in (2, 4):
        (a, b), (_, d) = BEARING
        mirrored = ((a, -b), (-b, d))
        joints[f"bearing_{k}"] = replace(joints[f"bearing_{k}"], stiffness=mirrored, damping=scaled(mirrored, 1e-6))
    flow = power_flow(assemble(replace(system, joints=joints)).modal(), GRID)
    assert np.max(abs(flow.share(is_moment_path))) < 1e-12 * np.max(abs(flow.share()))


@pytest.mark.parametrize(("tilt", "tolerance"), [(1e-2, 1e-9), (1e-4, 1e-11)])
def test_radial_only_bearings_are_the_limit_of_small_tilt_stiffness(tilt, tolerance):
    """K_yth = K_thth = 0 is singular; small K_thth tends to it linearly."""
    radial = ((1.2e8, 0.0), (0.0, 0.0))
    nearly = ((1.2e8, 0.0), (0.0, tilt))
    exact, limit = (power_flow(assemble(default_gearbox(K)).modal(), GRID) for K in (radial, nearly))
    deviation = np.max(abs(limit.share() - exact.share()) / exact.share())
    assert 0.0 < deviation < tolerance * 1e4
    assert np.all(exact.force[1::2] == 0.0)


def test_no_bearing_damping_and_no_source_damping_transmits_everything():
    system = default_gearbox(damping=((0.0, 0.0), (0.0, 0.0)))
    train = replace(system.components["gear_train"], modal_damping=0.0)
    lossless = replace(system, components={**system.components, "gear_train": train})
    flow = power_flow(assemble(lossless).modal(), GRID)
    np.testing.assert_allclose(flow.share(), 1.0, rtol=1e-6)
