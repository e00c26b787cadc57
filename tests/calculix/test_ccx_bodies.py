"""CalculiX and our decks for it, checked themselves: bodies whose natural frequencies have another known source."""

import numpy as np
import pytest
import scipy.linalg
import solid_rig as rig
from ccx_deck import Deck, read_frequencies
from ccx_solids import plate, round_bar
from numpy.polynomial import legendre

pytestmark = pytest.mark.xdist_group("calculix")

YOUNG, POISSON, DENSITY = rig.YOUNG, rig.POISSON, rig.DENSITY
SHEAR = YOUNG / (2 * (1 + POISSON))


def free_beam(length, diameter, wanted, kappa=0.886, count=24):
    """Bending of a free round Timoshenko beam, Hz: Ritz with Legendre polynomials for deflection and rotation."""
    x, weights = legendre.leggauss(count + 2)
    P = legendre.legvander(x, count - 1)
    D = np.stack([legendre.legval(x, legendre.legder(c)) for c in np.eye(count)], axis=1) * 2 / length
    area, moment = np.pi * diameter**2 / 4, np.pi * diameter**4 / 64
    none = np.zeros_like(P)
    shear, turn = np.hstack([D, -P]), np.hstack([none, D])
    terms = [(shear, kappa * SHEAR * area), (turn, YOUNG * moment)]
    masses = [(np.hstack([P, none]), DENSITY * area), (np.hstack([none, P]), DENSITY * moment)]
    K, M = (sum(f * a.T @ (weights[:, None] * length / 2 * a) for a, f in pairs) for pairs in (terms, masses))
    values = scipy.linalg.eigh(K, M, eigvals_only=True, subset_by_index=[0, wanted + 1])
    return np.sqrt(values[2:]) / (2 * np.pi)


def test_free_round_bar(calculix, tmp_path):
    """Four bending pairs as Timoshenko's beam, first torsion sqrt(G/rho)/2L, of the rig's shaft."""
    deck = Deck(YOUNG, POISSON)
    deck.add("BAR", round_bar(rig.SHAFT, (0.0, 0.0, 0.0), rig.SHAFT_LENGTH, 20), DENSITY)
    bending = np.repeat(free_beam(rig.SHAFT_LENGTH, rig.SHAFT, 4), 2)
    torsion = np.sqrt(SHEAR / DENSITY) / (2 * rig.SHAFT_LENGTH)
    np.testing.assert_allclose(deck.frequencies(calculix, tmp_path, 9), [*bending, torsion], rtol=2e-3)


def test_free_square_plate(calculix, tmp_path):
    """A thin free square plate, nu = 0.3: w a^2 sqrt(rho h / D) by a converged series (Gorman 1978)."""
    side, thickness = 0.5, 0.0025
    lines = np.linspace(-side / 2, side / 2, 17)
    deck = Deck(YOUNG, POISSON)
    deck.add("PLATE", plate(lines, lines, 0.0, thickness), DENSITY)
    D = YOUNG * thickness**3 / (12 * (1 - POISSON**2))
    number = 2 * np.pi * side**2 * np.sqrt(DENSITY * thickness / D) * deck.frequencies(calculix, tmp_path, 5)
    np.testing.assert_allclose(number, [13.468, 19.596, 24.270, 34.801, 34.801], rtol=5e-3)


@pytest.mark.slow
def test_the_rig_needs_no_finer_grid(calculix, tmp_path):
    """Half the spacing everywhere moves no frequency of the small plate with footprints by 0.5 %.

    Those of the source and the assembly move by 0.16 % at most (measured once: it takes a minute).
    """
    coarse, fine = (
        rig.free_plate(rig.SMALL, True, grid).frequencies(calculix, _empty(tmp_path / name), 8)
        for name, grid in (("coarse", rig.Grid()), ("fine", rig.Grid().refined()))
    )
    np.testing.assert_allclose(coarse, fine, rtol=5e-3)


def test_decks_are_deterministic_and_number_all_nodes_once():
    first, second = (rig.assembly(rig.Grid()) for _ in range(2))
    assert first.text(10) == second.text(10)
    numbers = np.concatenate([part.first + np.arange(len(part.nodes)) for part in first.parts])
    np.testing.assert_array_equal(numbers, 1 + np.arange(first.size))
    shared = np.concatenate([nodes for nodes, _ in first.rigid])
    assert len(set(shared)) == len(shared)  # a node in two rigid bodies would lock them together


def test_reading_the_table_of_eigenvalues():
    text = """
     E I G E N V A L U E   O U T P U T

 MODE NO    EIGENVALUE                       FREQUENCY
                                     REAL PART            IMAGINARY PART
                           (RAD/TIME)      (CYCLES/TIME     (RAD/TIME)

      1  -0.2E-03   0.0000000E+00   0.0000000E+00   0.1414214E-01
      2   0.3947842E+06   0.6283185E+03   0.1000000E+03   0.0000000E+00

     P A R T I C I P A T I O N   F A C T O R S

MODE NO.   X-COMPONENT
      1   0.1E+01   0.2E+01   0.3E+01   0.4E+01
"""
    np.testing.assert_array_equal(read_frequencies(text), [0.0, 100.0])


def _empty(folder):
    folder.mkdir()
    return folder
