"""The gear train: mobilities by two routes, the mesh, free spin, rigid-body modes, damping."""

import numpy as np
import pytest
import scipy.linalg
from systems import default_gear_train

from gearpath.components import DOFS, Disk, GearTrain, ShaftPoint, modes
from gearpath.components.mobility import mobility_direct, mobility_modal, modal_damping_matrix
from gearpath.errors import InputError

PLANAR = ("uy", "rx")
STATIONS = {"a": ShaftPoint("input", 0.0), "b": ShaftPoint("output", 0.25)}


@pytest.fixture(scope="module")
def train():
    return default_gear_train().structure(PLANAR, STATIONS)


def rows_of(structure):
    return np.vstack([structure.ports[name][[1, 3]] for name in STATIONS])


def test_direct_and_modal_mobilities_agree(train):
    """Eq. 6 against Eq. 7 with the complete basis, zero-frequency modes included."""
    omega = 2 * np.pi * np.array([20.0, 100.0, 1500.0, 4000.0])
    direct = mobility_direct(train, rows_of(train), omega)
    modal = mobility_modal(modes(train), rows_of(train), train.modal_damping, omega)
    np.testing.assert_allclose(modal, direct, rtol=1e-7, atol=1e-9 * abs(direct).max(axis=(1, 2)).min())


def test_leaving_out_the_zero_frequency_modes_spoils_the_mobility(train):
    """The remark on Eq. 7: without them the error is about 100 % at 100 Hz."""
    omega, basis = 2 * np.pi * np.array([100.0]), modes(train)
    rows = rows_of(train)[:1]
    whole = mobility_modal(basis, rows, 0.015, omega)
    elastic = type(basis)(basis.eigenvalues[4:], basis.shapes[:, 4:])
    assert abs(mobility_modal(elastic, rows, 0.015, omega) / whole - 1)[0, 0, 0] > 0.9


def test_modes_are_orthonormal_and_reproduce_the_stiffness(train):
    basis = modes(train)
    np.testing.assert_allclose(basis.shapes.T @ train.mass @ basis.shapes, np.eye(69), atol=1e-11)
    inner = basis.shapes.T @ train.stiffness @ basis.shapes
    scale = np.sqrt(np.outer(*[np.maximum(basis.eigenvalues, basis.eigenvalues[4])] * 2))
    np.testing.assert_allclose(inner / scale, np.diag(basis.eigenvalues > 0), atol=1e-9)


def test_damping_matrix_gives_every_elastic_mode_the_same_ratio(train):
    """C M^-1 C = 4 zeta^2 K, which needs no modes."""
    C = modal_damping_matrix(train)
    product = C @ scipy.linalg.solve(train.mass, C, assume_a="pos")
    expected = 4 * 0.015**2 * train.stiffness
    np.testing.assert_allclose(product, expected, atol=1e-9 * abs(expected).max())


def test_static_mesh_force_deflects_by_the_mesh_spring(train):
    """A force pair along the line of action and the spins that balance it: only the mesh spring deforms."""
    d = train.meshes["mesh"].displacement
    np.testing.assert_allclose(d @ train.stiffness @ d, 1.5e8, rtol=1e-12)


def test_rigid_modes_deform_nothing(train):
    assert train.rigid_modes.shape[1] == 4
    np.testing.assert_allclose(train.stiffness @ train.rigid_modes, 0.0, atol=1e-5)


def test_six_degrees_of_freedom_have_eleven_rigid_modes():
    structure = default_gear_train().structure(DOFS, STATIONS)
    basis = modes(structure)
    assert np.count_nonzero(basis.eigenvalues == 0.0) == 11
    d = structure.meshes["mesh"].displacement
    np.testing.assert_allclose(d @ structure.stiffness @ d, 1.5e8, rtol=1e-8)


def test_an_idler_couples_the_spins_of_its_two_meshes():
    """Two meshes on one idler: (T J^-1 T^T)^-1 has an off-diagonal mass; total kinetic energy is that of the disks."""
    base = default_gear_train()
    third = type(base.shafts["output"])(
        base.shafts["output"].material,
        (0.15, 0.0, -0.125),
        base.shafts["output"].sections,
        0.886,
        (8,),
        (Disk("last", 0.125, 1.0, 1e-3, 2e-3),),
    )
    mesh = type(base.meshes["mesh"])((("output", "wheel"), ("third", "last")), 1e8, (0.05025, 0.05))
    train = GearTrain({**base.shafts, "third": third}, {**base.meshes, "mesh_2": mesh}, 0.015)
    M = train.structure(PLANAR, {}).mass[-2:, -2:]
    J = np.array([1.8884e-3, 1.9655e-3, 2e-3])
    T = np.array([[0.04975, 0.05025, 0.0], [0.0, 0.05025, 0.05]])
    np.testing.assert_allclose(M @ (T / J) @ T.T, np.eye(2), atol=1e-12)


def test_wrong_number_of_spans_is_explained():
    with pytest.raises(InputError, match="elements has 3 entries for 2 spans"):
        default_gear_train((8, 8, 8)).structure(PLANAR, STATIONS)
