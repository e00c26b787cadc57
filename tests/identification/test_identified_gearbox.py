"""The four bearings of the default gearbox, whose rigid casing makes eight receiver-side motions three."""

import numpy as np
import pytest
from machines import noisy, reference_mobility, worst

from gearpath.errors import AccuracyError
from gearpath.identification import identify, joint_mobility

NAMES = [f"bearing_{k}" for k in (1, 2, 3, 4)]
JOINTS = dict.fromkeys(NAMES, ("uy", "rx"))
TRUTH = [(np.array([[1.2e8, 1.8e6], [1.8e6, 6e4]]), np.array([[120.0, 1.8], [1.8, 0.06]]))] * 4


@pytest.fixture(scope="module")
def lines():
    return np.linspace(20.0, 5000.0, 13)


@pytest.fixture(scope="module")
def mobility(network, lines):
    return reference_mobility(network, NAMES, 2.0 * np.pi * lines)


def test_receiver_side_is_singular(mobility):
    """Why Y cannot simply be inverted."""
    values = np.linalg.svd(mobility[:, 8:, 8:], compute_uv=False)
    assert (values[:, 3] < 1e-9 * values[:, 0]).all()


def test_without_noise_every_entry_is_found(mobility, lines):
    found = identify(lines, mobility, JOINTS)
    assert worst(found, TRUTH) < 1e-8
    assert not found.discarded
    assert not found.undetermined
    assert found.condition < 10.0
    assert found.cross_talk.value < 1e-9
    assert not found.notes


@pytest.mark.slow
def test_intervals_hold_the_truth_at_one_percent(mobility, lines):
    """100 trials: every entry of K and C in its 95 % interval in at least 90, all of K jointly in 88."""
    rng = np.random.default_rng(2)
    inside, deviations, together = [], [], 0
    i, j = np.triu_indices(2)
    for _ in range(100):
        found = identify(lines, noisy(mobility, 0.01, rng), JOINTS)
        hits, apart, off = [], [], []
        for joint, truth in zip(found.joints.values(), TRUTH):
            K = truth[0]
            for right, (low, high) in zip(truth, (joint.stiffness_interval(), joint.damping_interval())):
                hits += [*((right >= low) & (right <= high))[i, j]]
            apart += [*((joint.stiffness - K) / joint.stiffness_error)[i, j]]
            off += [*(joint.stiffness - K)[i, j]]
            assert np.abs(joint.stiffness[0, 0] / K[0, 0] - 1.0) < 0.02
        inside.append(hits)
        deviations.append(apart)
        m = len(off)
        together += off @ np.linalg.solve(found.covariance[:m, :m], off) < 21.03  # chi-squared, 12 entries, 95 %
        assert found.noise == pytest.approx(0.01, rel=0.1)
    z = np.array(deviations)
    assert min(np.sum(inside, axis=0)) >= 90
    assert together >= 88
    assert np.abs(z.mean(axis=0)).max() < 0.35  # unbiased: 3.5 standard errors of the mean
    assert 0.85 < z.std() < 1.15


def test_five_percent_noise_is_still_told_honestly(modal):
    f = np.linspace(500.0, 5000.0, 24)
    Y, rng = joint_mobility(modal, 2.0 * np.pi * f, NAMES), np.random.default_rng(3)
    apart = []
    for _ in range(8):
        found = identify(f, noisy(Y, 0.05, rng), JOINTS)
        assert found.noise == pytest.approx(0.05, rel=0.1)
        for joint, (K, _) in zip(found.joints.values(), TRUTH):
            apart.append(((joint.stiffness - K) / joint.stiffness_error)[np.triu_indices(2)])
            assert joint.stiffness_error[0, 0] < 0.01 * K[0, 0]
    assert 0.7 < np.std(apart) < 1.3
    assert np.mean(np.abs(apart) < 1.96) > 0.88


def test_lines_near_a_resonance_that_hides_the_joints_are_left_out(modal):
    f = np.array([20.0, 150.0, 230.0, 275.0, 1000.0, 1500.0, 2000.0, 2500.0])
    Y = joint_mobility(modal, 2.0 * np.pi * f, NAMES)
    found = identify(f, noisy(Y, 0.05, np.random.default_rng(4)), JOINTS)
    assert 275.0 in found.discarded
    assert "hidden by noise" in found.discarded[275.0]
    assert found.lines == 8 - len(found.discarded)
    with pytest.raises(AccuracyError, match="noise hides"):
        identify(f[1:4], noisy(Y, 0.1, np.random.default_rng(4))[1:4], JOINTS)


def test_a_missing_bearing_is_noticed(mobility, lines):
    """Three of four bearings measured: what is left over and the stiffness across joints both say so."""
    rng = np.random.default_rng(5)
    kept = [0, 1, 2, 3, 4, 5, 8, 9, 10, 11, 12, 13]
    part = noisy(mobility, 0.01, rng)[:, kept][:, :, kept]
    found = identify(lines, part, {name: JOINTS[name] for name in NAMES[:3]})
    assert found.misfit > 3.0
    assert found.cross_talk.probability < 1e-6
    assert any("misses a connection" in note for note in found.notes)
    whole = identify(lines, noisy(mobility, 0.01, rng), JOINTS)
    assert whole.misfit == pytest.approx(1.0, abs=0.15)
    assert whole.cross_talk.probability > 1e-3
    assert not any("connection" in note for note in whole.notes)


def test_one_bearing_alone_with_the_machine_without_it(modal, mobility, lines):
    """With known mobilities without the joint the others need not be measured, and intervals are narrower."""
    here = [2, 3, 10, 11]
    without = joint_mobility(modal, 2.0 * np.pi * lines, ["bearing_2"], connected=False)
    exact = identify(lines, mobility[:, here][:, :, here], {"bearing_2": ("uy", "rx")}, without=without)
    assert worst(exact, TRUTH[:1]) < 1e-8
    rng = np.random.default_rng(6)
    apart = []
    for _ in range(30):
        part = noisy(mobility[:, here][:, :, here], 0.01, rng)
        joint = identify(lines, part, {"bearing_2": ("uy", "rx")}, without=without).joints["bearing_2"]
        apart.append(((joint.stiffness - TRUTH[0][0]) / joint.stiffness_error)[np.triu_indices(2)])
        assert joint.stiffness_error[0, 0] < 5e-4 * 1.2e8
    assert 0.8 < np.std(apart) < 1.2
    assert np.abs(np.mean(apart, axis=0)).max() < 0.65


def test_given_noise_widens_the_intervals(mobility, lines):
    """A larger noise than the data show is believed; a smaller one is not."""
    Y = noisy(mobility, 0.01, np.random.default_rng(7))

    def error(noise):
        return identify(lines, Y, JOINTS, noise=noise).joints["bearing_1"].stiffness_error[0, 0]

    found, errors = error(None), [error(noise) for noise in (0.001, 0.01, 0.03)]
    assert errors[0] == pytest.approx(found, rel=0.05)
    assert errors[1] == pytest.approx(found, rel=0.15)
    assert errors[2] == pytest.approx(3.0 * found, rel=0.15)
