"""The fit against mobilities that were made without it: closed forms, random modal models, noise."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import gearpath as gp
from gearpath.errors import InputError
from gearpath.fitting import fit_mobility


def modal_sum(f, poles_hz, zeta, shapes, rigid=None):
    """Mobility (F, m, m) of real modes, one line at a time, by the dynamic stiffness of the modes."""
    out = []
    for w in 2 * np.pi * f:
        w_r = 2 * np.pi * np.asarray(poles_hz)
        Z = (w_r**2 - w**2 + 2j * np.asarray(zeta) * w_r * w) / (1j * w)
        Y = shapes @ np.diag(1 / Z) @ shapes.T
        out.append(Y if rigid is None else Y + rigid / (1j * w))
    return np.array(out)


def noisy(Y, level, seed):
    """Complex noise of the given root mean square, relative to each FRF's largest gain, every FRF on its own."""
    rng = np.random.default_rng(seed)
    n = rng.normal(size=Y.shape) + 1j * rng.normal(size=Y.shape)
    return Y + level / np.sqrt(2) * abs(Y).max(axis=0) * n


def synthetic(seed, modes, in_band, channels, lines, rigid=0):
    rng = np.random.default_rng(seed)
    f = np.linspace(10.0, 2000.0, lines)
    poles = np.concatenate([rng.uniform(40, 1950, in_band), rng.uniform(2050, 6000, modes - in_band)])
    zeta = np.exp(rng.uniform(np.log(0.002), np.log(0.03), modes))
    basis = rng.normal(size=(channels, rigid))
    return f, modal_sum(f, poles, zeta, rng.normal(size=(channels, modes)), basis @ basis.T), np.sort(poles[:in_band])


def in_band(fit):
    return fit.frequencies[(fit.frequencies >= fit.band[0]) & (fit.frequencies <= fit.band[1])]


def deviation(fit, f, Y):
    """Largest deviation of each FRF relative to its largest gain, (m, m)."""
    return (abs(fit.mobility(2 * np.pi * f) - Y) / abs(Y).max(axis=0)).max(axis=0)


@pytest.mark.slow
def test_eight_ports_thirty_six_modes():
    """The figures of the plan: 20 modes in the band, 16 above it, 2000 lines."""
    f, Y, poles = synthetic(1, 36, 20, 8, 2000, rigid=6)
    fit = fit_mobility(f, Y)
    assert 2 * fit.order <= 80
    assert fit.passive
    np.testing.assert_allclose(deviation(fit, f, Y), fit.error, atol=1e-12)
    assert fit.error.max() <= 1e-3
    assert fit.worst.value == fit.error.max()
    assert fit.in_band == 20
    np.testing.assert_allclose(in_band(fit), poles, rtol=1e-4)
    assert fit.notes == ()


@pytest.mark.parametrize(("level", "lines"), [(0.01, 1200), (0.05, 800)])
def test_noise_is_not_fitted(level, lines):
    """The error is the noise's; the model behind it is met several times better."""
    f, Y, poles = synthetic(3, 12, 8, 4, lines)
    fit = fit_mobility(f, noisy(Y, level, 5))
    assert fit.passive
    assert fit.in_band == 8
    np.testing.assert_allclose(in_band(fit), poles, rtol=2e-3)
    diagonal = np.diag(fit.rms)
    np.testing.assert_allclose(diagonal, level, rtol=0.1)  # the transfers' is less: mean of two
    assert fit.correlation < 0.1
    assert deviation(fit, f, Y).max() < 1.5 * level
    assert any("noise" in note for note in fit.notes)
    assert not any("reciprocal" in note or "passive" in note for note in fit.notes)


def test_one_mode_in_closed_form():
    f = np.linspace(50.0, 150.0, 101)
    fit = fit_mobility(f, modal_sum(f, [100.0], [0.02], np.array([[0.5]]))[:, 0, 0])
    assert fit.order == 1
    assert fit.frequencies[0] == pytest.approx(100.0, rel=1e-6)
    assert fit.damping_ratios[0] == pytest.approx(0.02, rel=1e-4)
    assert abs(fit.shapes[0, 0]) == pytest.approx(0.5, rel=1e-4)
    assert "1 modes (2 states)" in str(fit)


def test_two_masses_on_springs():
    """m1 - k - m2 free: its rigid-body line is 1 / (i w (m1 + m2)), its mode sqrt(k (1/m1 + 1/m2))."""
    m1, m2, k = 2.0, 3.0, 4.0e5
    f = np.linspace(5.0, 200.0, 300)
    out = []
    for w in 2 * np.pi * f:
        c = 30.0
        D = np.array([[k - w**2 * m1, -k], [-k, k - w**2 * m2]]) + 1j * w * c * np.array([[1, -1], [-1, 1]])
        out.append(1j * w * np.linalg.inv(D))
    fit = fit_mobility(f, np.array(out), tolerance=1e-6)
    assert fit.order == 2
    assert fit.eigenvalues[0] == 0.0
    np.testing.assert_allclose(np.outer(fit.shapes[:, 0], fit.shapes[:, 0]), np.full((2, 2), 1 / (m1 + m2)), rtol=1e-5)
    assert fit.eigenvalues[1] == pytest.approx(k * (1 / m1 + 1 / m2), rel=1e-6)
    assert fit.damping_ratios[1] == pytest.approx(30.0 * (1 / m1 + 1 / m2) / 2 / np.sqrt(fit.eigenvalues[1]), rel=1e-5)


def random_model(seed, modes, channels, rigid, damping):
    rng = np.random.default_rng(seed)
    f = np.linspace(20.0, 1000.0, 400)
    poles, zeta = rng.uniform(30, 1400, modes), 10 ** rng.uniform(-2.3, damping, modes)
    basis = rng.normal(size=(channels, rigid))
    return f, modal_sum(f, poles, zeta, rng.normal(size=(channels, modes)), basis @ basis.T)


@pytest.mark.parametrize(
    ("seed", "modes", "channels", "rigid"),
    [(496174, 4, 4, 3), (36545, 2, 4, 3), (286438, 6, 2, 1), (785491, 7, 1, 1), (375387, 2, 2, 0), (445224, 5, 2, 2)],
)
def test_random_models_without_noise(seed, modes, channels, rigid):
    """Modes in and above the band, damping ratios up to 0.2: no more modes than the model has."""
    f, Y = random_model(seed, modes, channels, rigid, -0.7)
    fit = fit_mobility(f, Y)
    assert fit.passive
    assert fit.error.max() <= 1e-3
    assert fit.order <= modes + rigid + 1


@settings(max_examples=15, deadline=None)
@given(
    seed=st.integers(0, 2**20),
    modes=st.integers(1, 6),
    channels=st.integers(1, 3),
    rigid=st.integers(0, 2),
    damping=st.sampled_from([-2.0, -1.5, -1.0]),
    level=st.sampled_from([0.0, 0.02]),
)
def test_any_fit_is_passive_and_states_its_error(seed, modes, channels, rigid, damping, level):
    f, Y = random_model(seed, modes, channels, rigid, damping)
    Y = noisy(Y, level, seed) if level else Y
    fit = fit_mobility(f, Y)
    assert fit.passive
    mean = (Y + Y.swapaxes(1, 2)) / 2
    np.testing.assert_allclose(deviation(fit, f, mean), fit.error, rtol=1e-6, atol=1e-9)
    assert fit.error.max() <= 1e-3 or fit.notes
    resistance = np.linalg.eigvalsh(fit.mobility(2 * np.pi * np.geomspace(0.1, 1e5, 500)).real)
    assert np.all(resistance[:, 0] >= -1e-12 * resistance[:, -1])


def test_close_modes():
    """Two modes a tenth of their width apart, of different shape: both are found where the shapes tell them apart."""
    f = np.linspace(50.0, 200.0, 600)
    shapes = np.array([[1.0, 0.3], [-0.4, 1.0]])
    fit = fit_mobility(f, modal_sum(f, [100.0, 100.2], [0.01, 0.012], shapes), tolerance=1e-5)
    assert fit.order == 2
    np.testing.assert_allclose(fit.frequencies, [100.0, 100.2], rtol=1e-5)
    np.testing.assert_allclose(fit.damping_ratios, [0.01, 0.012], rtol=1e-3)


def test_heavy_damping():
    f = np.linspace(10.0, 400.0, 400)
    shapes = np.array([[1.0, 0.8, 0.5], [0.6, -1.0, 0.7]])
    fit = fit_mobility(f, modal_sum(f, [60.0, 120.0, 250.0], [0.3, 0.5, 0.2], shapes), tolerance=1e-4)
    assert fit.passive
    assert fit.error.max() <= 1e-4
    assert fit.order == 3
    np.testing.assert_allclose(fit.damping_ratios, [0.3, 0.5, 0.2], rtol=0.05)


def test_missing_lines():
    """Lines need not be even: a gap between modes, and a coarse part."""
    f = np.concatenate([np.linspace(20.0, 90.0, 150), np.linspace(160.0, 400.0, 120)])
    fit = fit_mobility(f, modal_sum(f, [50.0, 200.0, 330.0], [0.01, 0.01, 0.02], np.array([[1.0, 0.5, -0.8]])))
    np.testing.assert_allclose(in_band(fit), [50.0, 200.0, 330.0], rtol=1e-3)
    assert fit.error.max() <= 1e-3


def test_quantities_are_one_another():
    """Accelerance, mobility and receptance of one structure have one fit."""
    f, Y, _ = synthetic(7, 3, 3, 2, 300)
    w = (2j * np.pi * f)[:, None, None]
    fits = [fit_mobility(f, H, quantity=q) for q, H in (("mobility", Y), ("accelerance", Y * w), ("receptance", Y / w))]
    for fit in fits[1:]:
        np.testing.assert_allclose(fit.eigenvalues, fits[0].eigenvalues, rtol=1e-8)


def test_units_of_channels_do_not_matter():
    """A rotation in rad beside a translation in m: scaling a channel scales its shapes and nothing else."""
    f, Y, _ = synthetic(8, 4, 4, 2, 400)
    D = np.diag([1.0, 1e4])
    one, other = fit_mobility(f, Y), fit_mobility(f, D @ Y @ D)
    np.testing.assert_allclose(other.frequencies, one.frequencies, rtol=1e-6)
    np.testing.assert_allclose(other.error, one.error, atol=1e-6)


def non_proportional(f):
    """Two masses, one dashpot to the ground at the first alone: complex modes."""
    M, K, C = np.diag([1.0, 1.2]), np.array([[2e5, -1e5], [-1e5, 1.9e5]]), np.diag([250.0, 0.0])
    return np.array([1j * w * np.linalg.inv(K - w**2 * M + 1j * w * C) for w in 2 * np.pi * f])


def test_complex_modes_are_named():
    f = np.linspace(20.0, 140.0, 400)
    fit = fit_mobility(f, non_proportional(f), modes=2)
    assert fit.passive
    assert fit.error.max() > 0.03
    note = next(note for note in fit.notes if "complex modes" in note)
    assert float(note.split("leave ")[1].split(" in place of")[0]) < fit.error.max() / 2


def test_modes_limits_the_order():
    f, Y, _ = synthetic(9, 8, 8, 3, 500)
    fit = fit_mobility(f, Y, modes=5)
    assert fit.order <= 5
    assert fit.error.max() > 1e-3
    assert any("allow more" in note for note in fit.notes)


def test_progress_tells_modes_and_the_error_they_leave():
    f, Y, _ = synthetic(10, 6, 6, 2, 400)
    told = []
    fit = fit_mobility(f, Y, progress=lambda modes, error: told.append((modes, error)))
    modes, error = told[-1]
    assert modes >= fit.order  # those that the fit can do without are taken out after the last word
    assert error < told[0][1]
    assert fit.error.max() < 1e-3


def test_active_data_give_a_passive_fit_and_are_named():
    """A channel whose sign is wrong gives negative driving-point resistance."""
    f = np.linspace(20.0, 400.0, 300)
    Y = modal_sum(f, [100.0, 250.0], [0.01, 0.01], np.array([[1.0, 0.5], [0.4, -0.9]]))
    wrong = Y.copy()
    wrong[:, 1, 1] *= -1
    fit = fit_mobility(f, wrong)
    assert fit.passive
    assert fit.data.resistance < -0.5
    assert any("not passive" in note for note in fit.notes)


def test_data_that_are_not_reciprocal_are_named():
    f = np.linspace(20.0, 400.0, 300)
    Y = modal_sum(f, [100.0, 250.0], [0.01, 0.01], np.array([[1.0, 0.5], [0.4, -0.9]]))
    wrong = Y.copy()
    wrong[:, 0, 1] *= 1.2
    fit = fit_mobility(f, wrong)
    assert fit.data.skew.value == pytest.approx(0.2 / 1.2, rel=1e-6)
    assert any("not reciprocal" in note for note in fit.notes)
    np.testing.assert_allclose(deviation(fit, f, (wrong + wrong.swapaxes(1, 2)) / 2), fit.error, atol=1e-9)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"frf": np.ones((3, 2, 2))}, "do not fit"),
        ({"frequencies_hz": np.arange(20.0)}, "positive and increasing"),
        ({"frf": np.full((20, 1, 1), np.nan)}, "not finite"),
        ({"frf": np.zeros((20, 1, 1))}, "no driving point responds"),
        ({"frequencies_hz": [1.0, 2.0], "frf": [1.0, 1.0]}, "too few"),
        ({"quantity": "impedance"}, "there is no 'impedance'"),
        ({"modes": 0}, "give a whole number from 1 up"),
        ({"modes": 2.5}, "2.5 is not a number of modes"),
        ({"modes": True}, "True is not a number of modes"),
        ({"tolerance": 0.0}, "above 0 and below 1"),
        ({"tolerance": "a"}, "tolerance 'a' is not allowed"),
        (
            {"frf": np.tile([[1.0, 0.5], [0.5, 0.0]], (20, 1, 1))},
            "channel 1 answers to others and not to its own force",
        ),
        ({"frf": "text"}, "not numbers"),
    ],
)
def test_unusable_data(change, words):
    data = {"frequencies_hz": np.arange(1.0, 21.0), "frf": np.ones((20, 1, 1))}
    with pytest.raises(InputError, match=words):
        gp.fit_mobility(**{**data, **change})


@pytest.mark.parametrize(("power", "words"), [(1, "they would do as accelerance"), (None, "conjugate the data")])
def test_another_quantity_and_other_phasors_are_named(power, words):
    f = np.linspace(20.0, 900.0, 300)
    s = 2j * np.pi * f
    Y = sum(s / (w**2 + 0.04 * w * s + s**2) for w in 2 * np.pi * np.array([110.0, 300.0, 610.0]))
    notes = gp.fit_mobility(f, Y.conj() if power is None else Y * s, modes=4).notes
    assert words in notes[0]


def test_noise_in_proportion_to_each_value_ends_the_fit():
    """A free body: the noise of its rigid motions at the lowest lines is no reason for modes."""
    rng = np.random.default_rng(0)
    f = np.linspace(10.0, 3000.0, 400)
    s, shapes = 2j * np.pi * f, rng.normal(size=(8, 5))
    w = 2 * np.pi * np.array([0.0, 0.0, 700.0, 1500.0, 2600.0])
    lines = s[:, None] / (w**2 + 0.02 * w * s[:, None] + s[:, None] ** 2)
    Y = np.einsum("ar,fr,br->fab", shapes, lines, shapes)
    noisy = Y * (1 + 0.01 * (rng.normal(size=Y.shape) + 1j * rng.normal(size=Y.shape)) / np.sqrt(2))
    fit = gp.fit_mobility(f, noisy)
    assert fit.order <= 12
    assert (abs(fit.mobility(2 * np.pi * f) - Y) / abs(Y).max(axis=0)).max() < 0.01
    assert "is noise" in fit.notes[0]
