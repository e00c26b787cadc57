"""Load and stiffness of random bearings against complex steps of an energy that is written anew."""

import bearing_oracles as oracles
import numpy as np
import pytest
from bearing_cases import KINDS, random_displacement, random_pair, scaled
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from gearpath.errors import InputError
from gearpath.joints.bearings import RollerBearing, back_to_back


@pytest.mark.slow
@settings(max_examples=2000, deadline=None)
@given(st.sampled_from(KINDS), st.integers(0, 2**32 - 1))
@example("deep groove", 1848)  # one contact, 0.2 nm deep
def test_load_and_stiffness_are_the_derivatives_of_the_energy(kind, seed):
    rng = np.random.default_rng(seed)
    ours, oracle = random_pair(kind, rng)
    q = random_displacement(ours, rng)
    assume(not oracles.nearly_touching(oracle, q[:5]))
    K, f = ours.stiffness(q), ours.load(q)

    assert not K[5].any()
    assert not K[:, 5].any()
    assert f[5] == 0.0
    S, wanted = scaled(K, ours.lever)[:5, :5], scaled(oracles.stiffness(oracle, q[:5]), ours.lever)
    size = np.abs(wanted).max()
    assert np.abs(S - wanted).max() <= 1e-10 * size
    assert np.abs(S - S.T).max() <= 1e-12 * size
    assert np.linalg.eigvalsh(S).min() >= -1e-13 * size

    unit = np.array([1, 1, 1, ours.lever, ours.lever])
    gradient = oracles.gradient(oracle, q[:5]) / unit
    assert np.abs(f[:5] / unit - gradient).max() <= 1e-10 * np.abs(gradient).max()
    U = oracles.energy(oracle, q[:5]).real
    assert ours.energy(q) == pytest.approx(U, rel=1e-10, abs=0)


def test_the_random_cases_have_all_elements_in_contact_some_of_them_and_none():
    shares = []
    for seed in range(400):
        rng = np.random.default_rng(seed)
        ours, _ = random_pair(KINDS[seed % 5], rng)
        shares.append((ours.contacts(random_displacement(ours, rng)).load > 0).mean())
    shares = np.array(shares)
    assert (shares == 0).any()
    assert (shares == 1).sum() > 20
    assert ((shares > 0) & (shares < 1)).sum() > 100


@pytest.mark.parametrize("kind", KINDS)
def test_many_displacements_at_once_equal_single_ones(kind, monkeypatch):
    rng = np.random.default_rng(3)
    ours, _ = random_pair(kind, rng)
    q = np.array([[random_displacement(ours, rng) for _ in range(5)] for _ in range(4)])
    monkeypatch.setattr("gearpath.joints.bearings.rolling._CHUNK", 3 * ours.contact_count)  # several chunks
    assert ours.energy(q).shape == (4, 5)
    assert ours.load(q).shape == (4, 5, 6)
    assert ours.stiffness(q).shape == (4, 5, 6, 6)
    assert ours.contacts(q).load.shape == ours.contacts(q).angle.shape == (4, 5, ours.elements)
    assert ours.stiffness(np.zeros((0, 6))).shape == (0, 6, 6)
    assert ours.contacts(np.zeros((0, 6))).load.shape == (0, ours.elements)
    for i in np.ndindex(4, 5):
        for method in (ours.energy, ours.load, ours.stiffness):
            one = method(q[i])
            np.testing.assert_allclose(method(q)[i], one, rtol=1e-12, atol=1e-12 * np.abs(one).max())
        np.testing.assert_allclose(ours.contacts(q).load[i], ours.contacts(q[i]).load, rtol=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_element_loads_and_angles_add_up_to_the_force(kind):
    rng = np.random.default_rng(11)
    ours, _ = random_pair(kind, rng)
    q = random_displacement(ours, rng) * [1, 1, 1, 0, 0, 0]
    q[:2] += 2e-5
    found, f = ours.contacts(q), ours.load(q)
    psi = ours.phase + 2 * np.pi * np.arange(ours.elements) / ours.elements
    radial = found.load * np.cos(found.angle)
    size = found.load.sum()
    assert size > 0
    assert f[0] == pytest.approx((radial * np.cos(psi)).sum(), abs=1e-12 * size)
    assert f[1] == pytest.approx((radial * np.sin(psi)).sum(), abs=1e-12 * size)
    assert f[2] == pytest.approx((found.load * np.sin(found.angle)).sum(), abs=1e-12 * size)


def test_a_roller_that_touches_by_rounding_only_does_not_bear():
    """cos(pi / 2) = 6e-17 would lend the rollers at the sides a hundredth of the stiffness of the loaded ones."""
    four = RollerBearing(4, 0.02, 0.04, 0.0, slices=1, contact_stiffness=1e9)
    K = four.stiffness([1e-5, 0, 0, 0, 0, 0])
    assert K[1, 1] <= 1e-12 * K[0, 0]
    assert (four.contacts([1e-5, 0, 0, 0, 0, 0]).load > 0).tolist() == [True, False, False, False]


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (1.0, "six entries ux, uy, uz, rx, ry, rz"),
        (np.zeros(5), "not shape (5,)"),
        (np.zeros((6, 5)), "not shape (6, 5)"),
        ([0, 0, np.nan, 0, 0, 0], "must be finite"),
        ([0, 0, np.inf, 0, 0, 0], "must be finite"),
        ("abc", "six numbers"),
    ],
)
def test_a_displacement_of_another_shape_is_refused(value, words):
    rng = np.random.default_rng(0)
    ours, _ = random_pair("angular", rng)
    for bearing in (ours, back_to_back(ours, 0.05)):
        for method in (bearing.energy, bearing.load, bearing.stiffness, bearing.contacts):
            with pytest.raises(InputError) as caught:
                method(value)
            assert words in str(caught.value)
