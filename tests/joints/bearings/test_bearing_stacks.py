"""Pairs and stacks: sums of their rows by the oracle, the tilt of O and X arrangements, preload, mirror."""

from math import gcd, radians

import bearing_oracles as oracles
import numpy as np
import pytest
from bearing_cases import KINDS, random_pair, scaled

from gearpath.errors import InputError
from gearpath.joints.bearings import (
    BallBearing,
    BearingStack,
    RollerBearing,
    back_to_back,
    face_to_face,
    tandem,
)

BALL = BallBearing(14, 12.7e-3, 70e-3, 0.515, 0.525, radians(25))
TAPER = RollerBearing(18, 0.016, 0.04, radians(14))


@pytest.mark.parametrize("seed", range(30))
def test_stack_of_random_rows_against_the_oracle(seed):
    rng = np.random.default_rng(seed)
    rows = [random_pair(KINDS[rng.integers(5)], rng) for _ in range(int(rng.integers(1, 4)))]
    places, offsets = rng.uniform(-0.1, 0.1, len(rows)).tolist(), rng.uniform(-2e-5, 2e-5, len(rows)).tolist()
    stack = BearingStack(tuple(row for row, _ in rows), tuple(places), tuple(offsets))
    oracle = oracles.StackOracle([row for _, row in rows], places, offsets)
    q = rng.normal(size=6) * [2e-5, 2e-5, 2e-5, 2e-4, 2e-4, 1] + [1e-4, 0, 0, 0, 0, 0]
    K, f = stack.stiffness(q), stack.load(q)
    wanted = oracles.stiffness(oracle, q[:5])
    assert np.abs(wanted).max() > 0
    size = np.abs(scaled(wanted, stack.lever)).max()
    assert np.abs(scaled(K, stack.lever)[:5, :5] - scaled(wanted, stack.lever)).max() < 1e-10 * size
    np.testing.assert_allclose(f[:5], oracles.gradient(oracle, q[:5]), rtol=1e-9, atol=1e-10 * np.abs(f).max())
    assert stack.energy(q) == pytest.approx(oracles.energy(oracle, q[:5]).real, rel=1e-10)
    mirror = np.array([1.0, 1.0, -1.0, -1.0, -1.0, 1.0])
    other = stack.mirrored()
    np.testing.assert_allclose(other.load(mirror * q), mirror * f, rtol=1e-8, atol=1e-9 * np.abs(f).max())
    several = np.stack([q, 2 * q, -q])
    for i in range(3):
        np.testing.assert_allclose(stack.stiffness(several)[i], stack.stiffness(several[i]), rtol=1e-12, atol=1e-3)


@pytest.mark.parametrize("bearing", [BALL, BALL.mirrored(), TAPER, TAPER.mirrored()])
@pytest.mark.parametrize(("arrange", "sign"), [(back_to_back, 1), (face_to_face, -1)])
def test_tilt_stiffness_of_pairs(bearing, arrange, sign):
    """2 (Kyy L^2/4 +- L |Ky,thx| + Kthth) about the middle, + back to back; row signs of Ky,thx: O is +, -."""
    L, preload = 0.05, 4e-5
    pair = arrange(bearing, L, preload)
    single = BALL if isinstance(bearing, BallBearing) else TAPER
    K1, K = single.stiffness([0, 0, preload / 2, 0, 0, 0]), pair.stiffness(np.zeros(6))
    tilt = 2 * (K1[1, 1] * L**2 / 4 + sign * L * abs(K1[1, 3]) + K1[3, 3])
    assert K[3, 3] == pytest.approx(tilt, rel=1e-9)
    assert K[4, 4] == pytest.approx(tilt, rel=1e-9)
    assert K[2, 2] == pytest.approx(2 * K1[2, 2], rel=1e-9)
    assert abs(K[1, 3]) < 1e-9 * K[1, 1] * L
    left, right = pair.bearings
    assert pair.positions == (-L / 2, L / 2)
    assert sign * left.contact_angle > 0 > sign * right.contact_angle
    pressed = [row.stiffness([0, 0, offset, 0, 0, 0])[1, 3] for row, offset in zip(pair.bearings, pair.offsets)]
    assert sign * pressed[0] > 0 > sign * pressed[1]
    assert np.abs(pair.load(np.zeros(6))).max() < 1e-9 * single.load([0, 0, preload / 2, 0, 0, 0])[2]


def test_tandem_shares_the_load():
    row = BALL.equilibrium({"uz": 2000.0})
    three = tandem(BALL, 0.02, 3)
    assert three.positions == pytest.approx((-0.02, 0.0, 0.02))
    found = three.equilibrium({"uz": 6000.0})
    assert found.displacement[2] == pytest.approx(row.displacement[2], rel=1e-8)
    assert found.loaded == three.elements == 42
    np.testing.assert_allclose(found.element_loads, row.element_loads[0], rtol=1e-8)


def test_phase_average_of_a_stack_covers_the_whole_pitch_of_every_row():
    other = BallBearing(11, 12.7e-3, 70e-3, 0.515, 0.525, -radians(25))
    assert gcd(11, 14) == 1
    stack = BearingStack((BALL, other), (-0.02, 0.02), (1e-5, -1e-5))
    q = [2e-5, 0, 0, 0, 0, 0]
    rows = [b.phase_average([2e-5, 0, o, 0, 0, 0]) for b, o in zip(stack.bearings, stack.offsets)]
    np.testing.assert_allclose(stack.phase_average(q)[:3, :3], sum(rows)[:3, :3], rtol=1e-9, atol=1e-3)
    turned = stack.turned(0.1)
    assert [row.phase for row in turned.bearings] == [0.1, 0.1]


def test_notes_name_the_row():
    pair = back_to_back(BALL, 0.03)
    with pytest.warns(UserWarning, match="row at z") as caught:
        pair.equilibrium({"uz": 600.0}, speed=30000.0)
    words = [str(warning.message) for warning in caught]
    assert any(w.startswith("row at z = -0.015 m: at 30000 rev/min the centrifugal") for w in words)
    assert any(w.startswith("row at z = 0.015 m: carries no load") for w in words)
    assert back_to_back(BALL, 0.03, 3e-5).equilibrium({"uz": 600.0}).notes == ()


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: BearingStack((), ()), "bearings: "),
        (lambda: BearingStack((3,), (0.0,)), "bearings: "),
        (lambda: BearingStack((BALL,), (0.0, 1.0)), "positions: give one number (m) for each of the 1"),
        (lambda: BearingStack((BALL,), ("a",)), "positions: "),
        (lambda: BearingStack((BALL,), (float("nan"),)), "positions[0]: "),
        (lambda: BearingStack((BALL,), (0.0,), (1.0, 2.0)), "offsets: give one"),
        (lambda: back_to_back(BALL, 0.0), "distance: "),
        (lambda: back_to_back(BALL, 0.1, float("inf")), "preload: "),
        (lambda: face_to_face(BALL, -1.0), "distance: "),
        (lambda: face_to_face(RollerBearing(9, 0.01, 0.03, 0.0), 0.1), "contact angle"),
        (lambda: tandem(BALL, 0.01, 0), "count: 0"),
        (lambda: tandem(BALL, float("nan")), "distance: nan"),
    ],
)
def test_stacks_that_are_refused(make, words):
    with pytest.raises(InputError) as caught:
        make()
    assert words in str(caught.value)
