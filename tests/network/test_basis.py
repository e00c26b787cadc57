"""The basis of a sparse component: accurate up to the band without being told how many vectors that takes."""

import numpy as np
import pytest

from gearpath.components import Footprint, Material, Plate
from gearpath.components.mobility import mobility_direct, modal_response
from gearpath.errors import AccuracyError
from gearpath.network import basis
from gearpath.network.basis import basis_of

STEEL = Material(2.07e11, 0.3, 7850.0)
DOFS = ("ux", "uy", "uz", "rx", "ry", "rz")
PLATE = Plate(
    STEEL,
    (0.0, 0.0, 0.0),
    (0.2, 0.3),
    0.005,
    (6, 9),
    footprints={"seat": Footprint((0.03, 0.02, 0.0), (0.02, 0.02)), "corner": Footprint((-0.1, -0.15, 0.0))},
    footprint_elements=2,
    loss_factor=0.01,
)


@pytest.fixture(scope="module")
def structure():
    return PLATE.structure(DOFS, {"seat": "seat", "corner": "corner"})


def mobility(structure, chosen, omega):
    rows = np.vstack(list(structure.ports.values()))
    shapes = rows @ chosen.shapes
    h = modal_response((1 + 0.01j) * chosen.eigenvalues, np.zeros_like(chosen.eigenvalues), omega)
    return np.einsum("mr,rf,kr->fmk", shapes, h, shapes), mobility_direct(structure, rows, omega)


@pytest.mark.parametrize("band", [300.0, 3000.0, 9000.0])
def test_mobility_up_to_the_band(structure, band):
    """Against direct solutions of the full matrices (Eq. 6), each entry by its two driving points."""
    chosen = basis_of(structure, band, None)
    assert chosen.shapes.shape[1] < structure.size / 2
    found, exact = mobility(structure, chosen, 2 * np.pi * np.array([0.05, 0.31, 0.6, 1.0]) * band)
    size = np.sqrt(abs(np.einsum("fmm->fm", exact)))
    assert np.max(abs(found - exact) / (size[:, :, None] * size[:, None, :])) < 1e-4
    assert np.max(abs(found - exact)[:2] / (size[:, :, None] * size[:, None, :])[:2]) < 1e-6


def test_rigid_body_modes_are_exact(structure):
    chosen = basis_of(structure, 500.0, None)
    assert np.count_nonzero(chosen.eigenvalues == 0.0) == 6


def test_number_of_vectors_can_be_chosen(structure):
    """12 port coordinates and 10 vectors; fewer are less accurate."""
    omega = 2 * np.pi * np.array([900.0])
    errors = []
    for vectors in (10, 40):
        chosen = basis_of(structure, 3000.0, vectors)
        assert len(chosen.eigenvalues) == 12 + vectors
        found, exact = mobility(structure, chosen, omega)
        errors.append(abs(found - exact).max() / abs(exact).max())
    assert errors[1] < 1e-3 * errors[0]


def test_a_band_that_would_take_too_many_vectors_is_refused(structure, monkeypatch):
    monkeypatch.setattr(basis, "_MOST", 50)
    with pytest.raises(AccuracyError, match=r"50 vectors leave the mobility .* give a lower frequency.stop"):
        basis_of(structure, 2e4, None)
