"""A measured component: its lines, what lies between them, its channels."""

import numpy as np
import pytest

from gearpath.components import Measured
from gearpath.errors import InputError

OMEGA = 2 * np.pi * np.array([10.0, 12.0, 20.0, 21.0])


def random_mobility(seed, lines=OMEGA):
    """Passive at every line: a positive definite real part, a symmetric imaginary one."""
    rng = np.random.default_rng(seed)
    R = rng.normal(size=(len(lines), 3, 3))
    X = rng.normal(size=(len(lines), 3, 3))
    return R @ R.swapaxes(1, 2) + 1j * (X + X.swapaxes(1, 2))


def component(mobility, **more):
    return Measured(OMEGA, mobility, {"seat": {"ux": 0, "uy": 2}, "foot": {"rx": 1}}, **more)


def test_lines_are_the_data():
    Y = random_mobility(0)
    found = component(Y).at(OMEGA[[2, 0, 3, 1]])
    np.testing.assert_allclose(np.moveaxis(found, -1, 0), Y[[2, 0, 3, 1]], rtol=1e-14)


def test_between_lines_a_rigid_body_is_exact():
    rigid = np.full((4, 1, 1), 1 / 3.0) / (1j * OMEGA)[:, None, None]
    w = np.linspace(OMEGA[0], OMEGA[-1], 37)
    found = Measured(OMEGA, rigid, {"p": {"uy": 0}}).at(w)
    np.testing.assert_allclose(found[0, 0], 1 / (3j * w), rtol=1e-13)


def test_between_lines_it_stays_passive_and_reciprocal():
    w = np.random.default_rng(1).uniform(OMEGA[0], OMEGA[-1], 200)
    found = np.moveaxis(component(random_mobility(2)).at(w), -1, 0)
    assert np.linalg.eigvalsh(found.real).min() > 0.0
    np.testing.assert_allclose(found, found.swapaxes(1, 2), atol=1e-14)


def test_the_error_between_lines_falls_with_their_distance_squared():
    def deviation(lines):
        w = 2 * np.pi * np.linspace(50.0, 150.0, lines)
        between = (w[1:] + w[:-1]) / 2

        def Y(w):
            return (1j * w / ((2 * np.pi * 100.0) ** 2 - w**2 + 2j * 0.05 * 2 * np.pi * 100.0 * w))[:, None, None]

        return abs(Measured(w, Y(w), {"p": {"uy": 0}}).at(between)[0, 0] - Y(between)[:, 0, 0]).max()

    assert np.log2(deviation(201) / deviation(401)) == pytest.approx(2.0, abs=0.1)


def test_reciprocity_by_the_mean():
    Y = random_mobility(3)
    skew = Y + np.array([[0.0, 0.2, 0.0], [-0.2, 0.0, 0.0], [0.0, 0.0, 0.0]])
    np.testing.assert_allclose(component(skew).at(OMEGA), component(Y).at(OMEGA), atol=1e-14)


def test_off_the_band():
    measured = component(random_mobility(4))
    assert measured.band == pytest.approx((10.0, 21.0))
    with pytest.raises(InputError, match="9 Hz is outside 10 to 21 Hz"):
        measured.at(2 * np.pi * np.array([9.0, 15.0]))
    with pytest.raises(InputError, match="22 Hz is outside"):
        measured.at(2 * np.pi * np.array([22.0, 15.0]))
    measured.at(OMEGA * (1 + 1e-12))


def test_rows_of_ports():
    structure = component(random_mobility(5)).structure(("ux", "uy"), {"a": "seat"}, {"b": "foot"})
    wanted = np.zeros((6, 3))
    wanted[0, 0] = wanted[1, 2] = 1.0
    np.testing.assert_array_equal(structure.ports["a"], wanted)
    assert not structure.ports["b"].any()  # rx is not active
    with pytest.raises(InputError, match="no port 'hand'"):
        component(random_mobility(5)).structure(("ux",), {"a": "hand"})


def test_equal_by_content():
    Y = random_mobility(6)
    one, other = component(Y), component(Y.copy())
    assert one == other
    assert hash(one) == hash(other)
    for changed in (component(Y * (1 + 1e-15 + 1e-14)), component(Y, tolerance=1e-2), component(Y, modes=5)):
        assert changed != one
    assert one != "text"
