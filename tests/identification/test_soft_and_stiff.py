"""Joints far softer and far stiffer than their neighbours: intervals that hold the truth, or a refusal."""

import numpy as np
import pytest
from machines import noisy

from gearpath.errors import AccuracyError, GearpathError, InputError
from gearpath.identification import identify
from gearpath.identification.bend import widening
from gearpath.identification.measurement import Measurement
from gearpath.identification.parameters import Unknowns

LINES = np.linspace(30.0, 2500.0, 60)
STIFF = "joint too stiff for its neighbours at this noise"
MATRIX, LOSS = np.array([[1e7, 2e6], [2e6, 3e6]]), np.array([[50.0, 0.0], [0.0, 20.0]])


def elastic(rng, dofs, rigid):
    """Mobilities (F, dofs, dofs) of a free part with some rigid motions and 12 modes in all, from its modal series."""
    w = 2.0 * np.pi * LINES[:, None]
    own = np.concatenate([np.zeros(rigid), np.sort(np.exp(rng.uniform(np.log(600.0), np.log(2e4), 12 - rigid)))])
    shape = rng.normal(size=(dofs, 12))
    return np.einsum("fr,ar,br->fab", 1j * w / (own**2 - w**2 + 0.02j * own * w), shape, shape)


def joined(seed, K, C):
    """Y of two elastic parts with a joint: (Y_A Y_B apart)^-1 + [[Z, -Z], [-Z, Z]], inverted as (1 + Y_0 Q)^-1 Y_0."""
    rng, n = np.random.default_rng(seed), len(K)
    apart = np.zeros((len(LINES), 2 * n, 2 * n), complex)
    apart[:, :n, :n], apart[:, n:, n:] = elastic(rng, n, 2), elastic(rng, n, 3)
    Z = K / (2j * np.pi * LINES)[:, None, None] + C
    return np.linalg.solve(np.eye(2 * n) + apart @ np.kron([[1.0, -1.0], [-1.0, 1.0]], Z), apart), apart


def trials(factor, count, dofs=1, seed=5, mirrored=False, **options):
    """Errors of K in standard errors, (returned, entries), standard errors relative to K, and refusals."""
    K, C = factor * MATRIX[:dofs, :dofs], factor * LOSS[:dofs, :dofs]
    Y, _ = joined(seed, K, C)
    upper, z, stated, refused = np.triu_indices(dofs), [], [], []
    for trial in range(count):
        measured = noisy(Y, 0.01, np.random.default_rng(trial))
        if mirrored:
            measured = np.triu(measured) + np.triu(measured, 1).swapaxes(1, 2)
        try:
            joint = identify(LINES, measured, {"b": ("uy", "rx")[:dofs]}, **options).joints["b"]
        except AccuracyError as error:
            refused.append(str(error))
            continue
        z.append(((joint.stiffness - K) / joint.stiffness_error)[upper])
        stated.append((joint.stiffness_error / np.abs(K))[upper])
    return np.array(z), np.array(stated), refused


@pytest.mark.parametrize("options", [{}, {"noise": 0.01}, {"mirrored": True}])
@pytest.mark.parametrize("factor", [1e-5, 1e-7])
def test_soft_joints(factor, options):
    """|Y_ab| is 1e-6 and 1e-8 of the own mobilities, yet known to 1 % of itself."""
    z, stated, refused = trials(factor, 20, **options)
    assert not refused
    assert np.mean(np.abs(z) < 1.96) >= 0.85
    assert 0.5 < np.std(z) < 1.4
    assert stated.max() < 0.005


def test_stiff_joint_is_still_found():
    """300 times the spring of the other tests, which moves its two sides apart by little more than the noise."""
    z, stated, refused = trials(300.0, 20)
    assert len(refused) <= 4
    assert np.mean(np.abs(z) < 1.96) >= 0.85
    assert 0.05 < np.median(stated) < 0.3


def test_interval_of_a_reciprocal():
    """A flexibility c measured with deviation s: K = 1/c reaches to 1 / (c - 1.96 s), and to no end below 1.96 s."""
    one = Unknowns.of({"b": ("uy",)})
    for c, s in ((2e-8, 1e-9), (2e-8, 6e-9), (2e-8, 1e-8)):
        upper = 1.0 / c + 1.96 * s / c**2 * widening(one, np.full(2, s / c))[0]
        assert upper == pytest.approx(1.0 / (c - 1.96 * s), rel=1e-3)
    assert np.isinf(widening(one, np.full(2, 0.6))).all()
    mixed = widening(Unknowns.of({"b": ("uy",), "c": ("uy", "rx")}), np.full(8, 0.1))
    np.testing.assert_allclose(mixed[[0, 4]], 1.0 / (1.0 - 0.196), rtol=1e-3)
    assert (mixed[[1, 2, 3, 5, 6, 7]] > 3.0).all()


def test_stiff_joint_has_a_wider_interval_than_linear_equations_say():
    Y, _ = joined(5, 300.0 * MATRIX[:1, :1], 300.0 * LOSS[:1, :1])
    found = identify(LINES, noisy(Y, 0.01, np.random.default_rng(0)), {"b": ("uy",)})
    assert found.joints["b"].stiffness_error[0, 0] > 1.1 * np.sqrt(found.covariance[0, 0])


@pytest.mark.parametrize("factor", [1e3, 1e4, 1e6])
def test_too_stiff_joint_is_refused(factor):
    z, _, refused = trials(factor, 20)
    assert sum(STIFF in error for error in refused) >= 18
    assert (np.abs(z) < 1.96).all()


def test_too_stiff_joint_is_refused_where_nothing_tells_the_noise():
    z, _, refused = trials(1e4, 5, mirrored=True)
    assert len(refused) >= 4
    assert all("too stiff for" in error for error in refused)
    assert (np.abs(z) < 1.96).all()


def test_stiff_matrices():
    """Starting values for stiff joints lead where the usual ones do not; the intervals hold the truth."""
    z, stated, refused = trials(100.0, 8, dofs=2)
    assert len(refused) <= 1
    assert np.mean(np.abs(z) < 1.96) >= 0.85
    assert np.median(stated) < 0.2


def test_one_stiff_joint_beside_a_soft_one():
    """The other joint is found; the stiff one has no interval, or all is refused."""
    Y, _ = joined(5, np.diag([1e10, 3e6]), np.diag([30.0, 9.0]))
    returned, refused = 0, []
    for trial in range(4):
        try:
            found = identify(LINES, noisy(Y, 0.01, np.random.default_rng(trial)), {"b": ("uy",), "c": ("uy",)})
        except AccuracyError as error:
            refused.append(str(error))
            continue
        returned += 1
        assert np.isinf(found.joints["b"].stiffness_error).all()
        assert found.joints["c"].stiffness[0, 0] == pytest.approx(3e6, rel=0.02)
        assert any(STIFF in note and "b.stiffness[1,1]" in note for note in found.notes)
        assert not any("conjugate" in note for note in found.notes)
    assert returned
    assert all("too stiff for" in error for error in refused)


def test_too_stiff_with_the_machine_without_it():
    Y, without = joined(5, 1e6 * MATRIX, 1e6 * LOSS)
    with pytest.raises(AccuracyError, match=STIFF):
        identify(LINES, noisy(Y, 0.01, np.random.default_rng(1)), {"b": ("uy", "rx")}, without=without)


def test_direct_mobility_that_is_only_noise_does_not_lower_the_floor():
    """A floor below what is measured would take additive noise for a mobility known to 1 %."""
    Y, _ = joined(5, 1e-6 * MATRIX[:1, :1], 1e-6 * LOSS[:1, :1])
    assert Measurement.of(LINES, noisy(Y, 0.01, np.random.default_rng(1)), None).floor < 1e-7
    added = Y + 1e-6 * np.abs(Y[:, :1, :1]) * np.random.default_rng(2).normal(size=Y.shape)
    added[:, 0, 1] *= 1.0 + 1e-3
    assert Measurement.of(LINES, added, None).floor == 1e-4


def test_noise_needs_more_lines_than_unknowns():
    Y, _ = joined(5, MATRIX[:1, :1], LOSS[:1, :1])
    with pytest.raises(InputError, match=r"10 lines are too few for 2 unknown .* at least 11"):
        identify(LINES[:10], Y[:10], {"b": ("uy",)})
    assert identify(LINES[:11], Y[:11], {"b": ("uy",)}).lines == 11


def test_permuted_channels_are_named_as_a_cause():
    """The source sides of two joints exchanged: no K and C fit, and the message says where to look."""
    Y, _ = joined(5, np.diag([1e7, 3e6]), np.diag([30.0, 9.0]))
    order = [1, 0, 2, 3]
    with pytest.raises(GearpathError, match=r"missing from `joints`.*order of `joints`"):
        identify(LINES, noisy(Y, 0.01, np.random.default_rng(1))[:, order][:, :, order], {"b": ("uy",), "c": ("uy",)})
