"""The studies' figures against those of an independent implementation, to the digits that it printed."""

import numpy as np
import pytest

from gearpath.network.assemble import assemble
from gearpath.network.reference import reference_solution
from gearpath.study.paper import fig05, fig07, fig08, fig09, fig11, fig12, fig13, fig14, fig15
from gearpath.study.paper.effect import GRID, by_band, effects
from gearpath.study.paper.fig09 import relative_motion
from gearpath.study.paper.machine import (
    bearings,
    masked_bearings,
    scaled_joints,
    shifted_casing,
    shifted_gears,
    shifted_mounts,
    shipped,
)

NEAR = 0.05  # dB
MODULES = {module.__name__[-5:]: module for module in (fig05, fig07, fig08, fig09, fig11, fig12, fig13, fig14, fig15)}


@pytest.fixture(scope="module")
def studies():
    done = {}

    def get(key):
        if key not in done:
            done[key] = MODULES[key].study()
        return done[key]

    return get


@pytest.mark.parametrize(
    ("key", "which", "part", "statistic", "expected"),
    [
        ("fig08", 0, "force", "median", 1.05),
        ("fig08", 1, "force", "median", 1.38),
        ("fig09", 0, "alpha", "means", [-0.6, -0.8, -1.0, -1.7]),
        ("fig09", 1, "alpha", "means", [-0.7, -1.2, 0.9, -7.4]),
        ("fig09", 2, "alpha", "means", [0.7, 1.4, -0.4, 1.9]),
        ("fig11", 0, "force", "median", 0.00),
        ("fig11", 0, "moment", "mean", 2.88),
        ("fig11", 0, "moment", "means", [10.8, 4.0, 0.1, -0.2]),
        ("fig12", 0, "force", "median", 0.97),
        ("fig12", 0, "moment", "mean", 7.92),
        ("fig12", 0, "moment", "means", [21.3, 5.0, -1.6, 7.5]),
        ("fig13", 0, "force", "median", 0.27),
        ("fig13", 0, "moment", "median", 3.54),
        ("fig14", 0, "force", "median", 0.00),
        ("fig14", 0, "moment", "means", [11.6, -1.0, 0.2, 0.1]),
        ("fig15", 0, "force", "median", 0.74),
        ("fig15", 0, "moment", "means", [16.8, -0.8, -0.3, -0.1]),
    ],
)
def test_figures_are_the_printed_ones(studies, key, which, part, statistic, expected):
    found = getattr(studies(key).effects[which], statistic)(part)
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=NEAR)


def test_bands_hold_their_lower_edge_and_the_last_one_both():
    parts = by_band(GRID, GRID)
    assert [part[0] for part in parts] == [10.0, 1000.0, 2000.0, 3000.0]
    assert [part[-1] for part in parts] == [990.0, 1990.0, 2990.0, 5000.0]
    assert sum(map(len, parts)) == len(GRID) == 500


@pytest.mark.parametrize("which", [0, 1])
def test_without_coupling_no_moment_power_is_left_and_none_is_drawn(studies, which):
    study = studies("fig08")
    effect = study.effects[which]
    assert not effect.changed.ratio("moment").any()
    assert effect.means("moment") == (-np.inf,) * 4
    (figure,) = study.figures
    panels = [trace["yaxis"] for trace in figure.data if trace["name"] == effect.name]
    assert panels == ["y"]  # the force panel only
    assert f"there is no curve, for: {study.effects[0].name}" in figure.caption


def test_the_peak_at_2_2_khz_needs_the_coupling_term(studies):
    """A line at the peak and two beside it, without any peak finder."""
    study = studies("fig08")
    near, peak = (GRID > 2000.0) & (GRID < 2450.0), (GRID >= 2200.0) & (GRID <= 2280.0)
    for machine, rises in ((study.effects[0].original, True), *((e.changed, False) for e in study.effects)):
        level = machine.level("force")
        assert (level[peak].max() - np.median(level[near]) > 5.0) == rises
    assert "none; radial stiffness only none" in study.remarks[0]


def test_relative_motion_is_not_little(studies):
    study = studies("fig09")
    motion = relative_motion(study.effects[0].original)
    np.testing.assert_allclose(motion[0], 0.39, atol=0.005)
    np.testing.assert_allclose(motion[2:], 1.0, atol=0.05)
    (claim,) = [claim for claim in study.claims if "relative motion" in claim.says]
    assert claim.verdict == "does not hold"


def test_synthesis_equals_the_direct_solution_and_guyan_only_at_low_frequency(studies):
    exact, guyan = studies("fig05").claims
    assert all(item.values[0] < 1e-9 for item in exact.items)
    low, middle, high, highest = (item.values[0] for item in guyan.items)
    assert max(low, middle) < 0.015
    assert high < 0.5
    assert 0.5 < highest < 1.5
    assert guyan.verdict == "holds only at 0–2 kHz"


def test_guyan_keeps_a_quarter_of_the_source():
    network = assemble(fig05._with_masters(shipped()).system)
    assert network.structures["gear_train"].size == 69
    assert len(fig05.masters(network)) == 17


def test_reduced_integration_is_the_one_near_timoshenko(studies):
    """Linear elements with full integration lock in shear: stiffer than Timoshenko's, by more than Euler's."""
    study = studies("fig07")
    euler, reduced, full = (effect.median("alpha") for effect in study.effects)
    assert reduced < 0.1 < 0.4 < min(euler, full)
    assert study.claims[0].verdict == "does not hold"


CHANGES = {
    "damping": lambda m: scaled_joints(m, bearings(m), damping=3.0),
    "soft": lambda m: scaled_joints(m, bearings(m), stiffness=0.5),
    "diagonal": lambda m: masked_bearings(m, np.eye(2)),
    "casing": lambda m: shifted_casing(m, x=0.04),
    "gears": lambda m: shifted_gears(m, 0.01),
    "mounts": lambda m: shifted_mounts(m, z=0.04),
}


@pytest.mark.parametrize("name", CHANGES)
def test_effects_agree_with_the_unsynthesised_solution(name):
    """D of both paths from the directly solved machines, at a few lines."""
    model, lines = shipped(), slice(40, None, 90)
    (effect,) = effects(model, {name: CHANGES[name](model)})[1]
    levels = []
    for machine in (model, model.replace(CHANGES[name](model))):
        network = assemble(machine.system)
        solved = reference_solution(network, 2.0 * np.pi * GRID[lines])
        rows = [dof if joint.name in network.paths else "" for joint in network.joints for dof in joint.dofs]
        powers = [solved.path_power[[row == dof for row in rows]].sum(axis=0) for dof in ("uy", "rx")]
        with np.errstate(divide="ignore"):
            levels.append([10.0 * np.log10(abs(power / solved.input_power)) for power in powers])
    (force, moment), (changed_force, changed_moment) = levels
    np.testing.assert_allclose(effect.difference("force")[lines], changed_force - force, atol=1e-6)
    if name == "diagonal":
        assert np.all(changed_moment < moment - 100.0)
    else:
        np.testing.assert_allclose(effect.difference("moment")[lines], changed_moment - moment, atol=1e-5)
