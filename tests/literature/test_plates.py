"""Plates of the literature: Leissa's free square plate, the NAFEMS benchmark, the plates and source of the experiment.

Tolerances are those of the sources: Leissa's values are upper bounds of a 36-term Ritz solution, up to 1.1 % high; the
lists of the experimental set-up are finite element results, converged within 0.3 %.
"""

import numpy as np
import pytest
from scipy.sparse.linalg import eigsh

from gearpath.components import DOFS, BarSection, Footprint, Frame, FrameBeam, Material, Plate

STEEL = Material(2.07e11, 0.3, 7850.0)
KAPPA = 0.886


def elastic(part, count, about):
    """Elastic frequencies, Hz, of a free structure whose lowest lies about there."""
    structure = part.structure(DOFS, {})
    shift = -((2 * np.pi * about) ** 2)  # far enough from the rigid modes to be well conditioned
    values = np.sort(eigsh(structure.stiffness, count + 6, structure.mass, sigma=shift, return_eigenvectors=False))
    assert abs(values[:6]).max() < 1e-6 * values[6]
    return np.sqrt(values[6:]) / (2 * np.pi)


def thin_square(n):
    """omega a^2 sqrt(rho h / D) of the first seven modes on an n x n grid; h / a = 1/1000: bending is all there is."""
    h = 1e-3
    scale = np.sqrt(7850.0 * h / (2.07e11 * h**3 / (12 * (1 - 0.3**2))))
    return 2 * np.pi * scale * elastic(Plate(STEEL, (0.0, 0.0, 0.0), (1.0, 1.0), h, (n, n)), 7, 13.5 / scale / 6.28)


def test_leissa_free_square_plate():
    """nu = 0.3 (Leissa 1973): upper bounds."""
    leissa = np.array([13.489, 19.789, 24.432, 35.024, 35.024, 61.526, 61.526])
    found = thin_square(40)
    np.testing.assert_allclose(found, leissa, rtol=1.1e-2)
    assert np.all(found < leissa)


def test_converged_free_square_plate():
    """The same by a series solution that converges (Gorman 1978)."""
    exact = np.array([13.468, 19.596, 24.270, 34.801, 34.801, 61.093, 61.093])
    coarse, fine = (thin_square(n) / exact - 1 for n in (20, 40))
    assert abs(fine).max() < 5e-3
    assert np.all(fine < coarse / 3)


def test_nafems_free_thin_square_plate():
    """NAFEMS FV12, 10 m square, 50 mm thick: reference 1.622 2.360 2.922 4.233 4.233 7.416 Hz."""
    plate = Plate(Material(2.0e11, 0.3, 8000.0), (0.0, 0.0, 0.0), (10.0, 10.0), 0.05, (40, 40))
    np.testing.assert_allclose(elastic(plate, 6, 1.6), [1.622, 2.360, 2.922, 4.233, 4.233, 7.416], rtol=1.2e-2)


@pytest.mark.parametrize(
    ("lengths", "elements", "expected"),
    [
        ((0.330, 0.432), (36, 48), [147.2, 179.2, 321.4, 349.9, 423.2, 521.3, 671.6, 706.8]),
        ((0.127, 0.229), (24, 43), [641.3, 709.7, 1581.0, 1771.0, 2138.0]),
    ],
)
def test_plates_of_the_experiment(lengths, elements, expected):
    plate = Plate(STEEL, (0.0, 0.0, 0.0), lengths, 0.00635, elements, shear_coefficient=KAPPA)
    np.testing.assert_allclose(elastic(plate, len(expected), expected[0]), expected, rtol=3e-3)


def source():
    """The small plate with two shafts on its rigid footprints; the force point has its grid lines."""
    feet = {name: Footprint((0.0, y, 0.0), (0.0127, 0.0127)) for name, y in (("upper", 0.0762), ("lower", -0.0762))}
    feet["force"] = Footprint((-0.0635, 0.0381, 0.0))
    plate = Plate(STEEL, (0.0, 0.0, 0.0), (0.127, 0.229), 0.00635, (12, 21), footprints=feet, shear_coefficient=KAPPA)
    ends = {"upper": (0.0, 0.0762, 0.381), "lower": (0.0, -0.0762, 0.381)}
    shafts = {name: FrameBeam((f"plate.{name}", name), STEEL, BarSection.round(0.0127), KAPPA, 16) for name in ends}
    return Frame(ends, shafts, {"plate": plate}, loss_factor=0.01)


def test_source_of_the_experiment():
    expected = [53.0, 63.3, 120.3, 211.0, 336.3, 365.9, 397.4, 478.5]
    np.testing.assert_allclose(elastic(source(), 8, expected[0]), expected, rtol=5e-3)
