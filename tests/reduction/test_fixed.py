"""Reductions with the interface held: exact statics, rigid motion, bounds, moments, convergence."""

import numpy as np
import pytest
import scipy.linalg
from hypothesis import given, settings
from hypothesis import strategies as st
from sources import KEPT, bampton, beam_shaft, chain, free, random_source

from gearpath.components import modes
from gearpath.errors import InputError
from gearpath.reduction import (
    constraint_modes,
    craig_bampton,
    free_interface,
    guyan,
    interface_rows,
    lanczos,
    port_rows,
    reduced_modes,
    reduced_structure,
)

METHODS = {
    "constraint modes": lambda structure, _: constraint_modes(structure),
    "lanczos": lanczos,
    "mesh start": lambda structure, count: lanczos(structure, count, start="mesh"),
    "craig-bampton": bampton,
    "free": lambda structure, count: free(structure, count, residual=False),
    "residual": lambda structure, count: free(structure, count, residual=True),
}
STATIC = {name: METHODS[name] for name in ("constraint modes", "lanczos", "craig-bampton")}


@pytest.mark.parametrize("name", METHODS)
def test_the_record_is_a_congruence(source, name):
    found = METHODS[name](source, 7)
    T = found.basis
    np.testing.assert_allclose(found.mass, T.T @ source.mass @ T, atol=1e-12 * abs(found.mass).max())
    scale = np.sqrt(np.diag(abs(T.T) @ abs(source.stiffness) @ abs(T)))
    assert np.all(abs(found.stiffness - T.T @ source.stiffness @ T) <= 1e-13 * np.outer(scale, scale))
    assert found.size == T.shape[1] == found.mass.shape[0]


@pytest.mark.parametrize("name", METHODS)
@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), count=st.integers(0, 6))
def test_definiteness_rigid_motion_and_bounds(name, seed, count):
    """M_r > 0, K_r >= 0, rigid modes exactly free and in the basis, eigenvalues bounded from below by the complete."""
    source = random_source(seed)
    found = METHODS[name](source, count)
    unit = 1.0 / np.sqrt(np.diag(found.mass))
    assert scipy.linalg.eigvalsh(found.mass * np.outer(unit, unit)).min() > 0.0
    values = scipy.linalg.eigvalsh(found.stiffness, found.mass)
    assert values.min() > -1e-9 * max(values.max(), 1.0)
    basis = reduced_modes(source, found)
    rigid = source.rigid_modes.shape[1]
    assert np.all(basis.eigenvalues[:rigid] == 0.0)
    assert np.all(basis.eigenvalues[rigid:] > 0.0)
    size = abs(source.rigid_modes).max(axis=0)
    span = scipy.linalg.lstsq(basis.shapes[:, :rigid], source.rigid_modes / size)[0]
    np.testing.assert_allclose(basis.shapes[:, :rigid] @ span, source.rigid_modes / size, atol=1e-9)
    exact = modes(source).eigenvalues[: found.size]
    assert np.all(basis.eigenvalues >= exact * (1.0 - 1e-7))
    gram = basis.shapes.T @ source.mass @ basis.shapes
    np.testing.assert_allclose(gram, np.eye(found.size), atol=1e-8)


@pytest.mark.parametrize("name", STATIC)
def test_statics_of_the_supported_source_are_exact(source, name):
    """On springs at its ports, loaded at ports and mesh: the least energy solution of the full system."""
    found = STATIC[name](source, 9)
    L, ports = interface_rows(source).toarray(), port_rows(source).toarray()
    support = ports.T @ (np.geomspace(1e5, 1e8, len(ports))[:, None] * ports)
    exact = np.linalg.solve(source.stiffness + support, L.T)
    T = found.basis
    reduced = T @ np.linalg.solve(found.stiffness + T.T @ support @ T, T.T @ L.T)
    deviation = abs(L @ (reduced - exact)) / np.sqrt(np.outer(np.diag(L @ exact), np.diag(L @ exact)))
    assert deviation.max() < 1e-8


@pytest.mark.parametrize("elements", [40, 1000])
def test_a_finely_divided_shaft_keeps_its_lowest_modes(elements):
    """Free-free slender beam, beta L = 4.7300, 7.8532, ...: element stiffness up to 1e9 times that of the shaft."""
    shaft = beam_shaft(elements)
    found = reduced_modes(shaft, lanczos(shaft, 12))
    assert np.all(found.eigenvalues[:2] == 0.0)
    roots = np.array([4.730040744862704, 7.853204624095838, 10.995607838001671])
    area, inertia = np.pi * 0.01**2 / 4, np.pi * 0.01**4 / 64
    thin = roots**2 * np.sqrt(2.07e11 * inertia / (7850.0 * area)) / (2 * np.pi)
    np.testing.assert_allclose(found.frequencies[2:5], thin, rtol=2.5e-3)  # shear and rotary inertia lower them
    assert np.all(found.frequencies[2:5] < thin)


def test_spins_that_the_boundary_holds_add_nothing(source):
    """With p and both gears among the boundary the spin d is a combination of constraint modes."""
    assert constraint_modes(source, np.eye(69)[KEPT]).size == 17
    assert constraint_modes(source).size == 10


def test_fixed_interface_modes_of_a_chain_are_those_of_the_string():
    """n - 1 masses held at one end, free at the other: w_k = 2 sin((2 k - 1) pi / (2 (2 n - 1)))."""
    n = 12
    found = craig_bampton(chain(n), 4)
    interior = found.stiffness[1:, 1:], found.mass[1:, 1:]
    expected = 2.0 * np.sin((2 * np.arange(1, 5) - 1) * np.pi / (2 * (2 * n - 1)))
    np.testing.assert_allclose(np.sqrt(scipy.linalg.eigvalsh(*interior)), expected, rtol=1e-12)


def test_guyan_of_a_chain_is_linear_interpolation():
    """Springs between kept masses pull their neighbours along straight lines."""
    found = guyan(chain(10), [0, 3, 9])
    expected = np.array([np.interp(np.arange(10), [0, 3, 9], column) for column in np.eye(3)]).T
    np.testing.assert_allclose(found.basis, expected, atol=1e-13)
    np.testing.assert_allclose(
        found.stiffness, [[1 / 3, -1 / 3, 0], [-1 / 3, 1 / 3 + 1 / 6, -1 / 6], [0, -1 / 6, 1 / 6]], atol=1e-13
    )


def test_guyan_keeps_the_coordinates_of_a_quarter(source, complete):
    found = guyan(source, KEPT)
    assert (source.size, found.size, found.boundary, found.vectors) == (69, 17, 17, 0)
    np.testing.assert_array_equal(found.basis[KEPT], np.eye(17))
    ratio = reduced_modes(source, found).frequencies[4:7] / complete.frequencies[4:7]
    assert np.all((ratio > 1.0) & (ratio < 1.005))


@pytest.mark.parametrize(("kept", "told"), [([0, 0, 1], "distinct"), ([69], "from 0 to 68"), ([], "distinct")])
def test_guyan_refuses_bad_coordinates(source, kept, told):
    with pytest.raises(InputError, match=told):
        guyan(source, kept)


def test_guyan_refuses_to_leave_rigid_motion_free(source):
    with pytest.raises(InputError, match="leave 1 rigid-body motions free"):
        guyan(source, [0, 1, 34])


def test_negative_numbers_of_vectors_are_refused(source):
    for method in (lanczos, craig_bampton, lambda s, k: free_interface(s, k, residual=False)):
        with pytest.raises(InputError, match="give"):
            method(source, -1)


@pytest.mark.parametrize("blocks", [1, 2])
def test_block_lanczos_matches_the_moments_of_the_held_interior(source, blocks):
    """F^T (K_ii^-1 M_ii)^k K_ii^-1 F, k < 2 j, by j blocks of nine: F the mesh force and the inertia of A."""
    ports = port_rows(source).toarray()
    boundary = [int(np.argmax(row)) for row in ports]
    inner = np.setdiff1d(np.arange(69), boundary)
    Ki, Mi = (X[np.ix_(inner, inner)] for X in (source.stiffness, source.mass))
    A = -np.linalg.solve(Ki, source.stiffness[np.ix_(inner, boundary)])
    F = np.column_stack([np.eye(61)[:, -1], Mi @ A + source.mass[np.ix_(inner, boundary)]])
    found = lanczos(source, 9 * blocks)
    Kr, Mr = found.stiffness[8:, 8:], found.mass[8:, 8:]
    Fr = np.column_stack([found.basis[-1, 8:], found.mass[8:, :8]])
    exact, reduced = np.linalg.solve(Ki, F), np.linalg.solve(Kr, Fr)
    for _ in range(2 * blocks):
        moment = F.T @ exact
        size = np.sqrt(np.outer(np.diag(moment), np.diag(moment)))
        assert (abs(moment - Fr.T @ reduced) / size).max() < 1e-9
        exact, reduced = np.linalg.solve(Ki, Mi @ exact), np.linalg.solve(Kr, Mr @ reduced)
    if blocks == 1:  # of two, the next moment differs by less than rounding: the lowest modes dominate it
        moment = F.T @ exact
        size = np.sqrt(np.outer(np.diag(moment), np.diag(moment)))
        assert (abs(moment - Fr.T @ reduced) / size).max() > 1e-9


def test_reduced_structure_keeps_ports_meshes_and_masses(source):
    small = reduced_structure(source, lanczos(source, 9))
    assert small.size == 18
    assert (small.modal_damping, small.loss_factor) == (source.modal_damping, source.loss_factor)
    assert small.meshes["mesh"].equivalent_mass == pytest.approx(source.meshes["mesh"].equivalent_mass, rel=1e-12)
    for name, rows in small.ports.items():
        assert np.linalg.matrix_rank(rows) == np.linalg.matrix_rank(source.ports[name])
    frequencies = modes(small).frequencies[:9]
    np.testing.assert_allclose(frequencies, modes(source).frequencies[:9], rtol=1e-2)


@pytest.mark.parametrize("name", ["lanczos", "mesh start", "craig-bampton", "residual"])
def test_all_vectors_make_the_basis_complete(source, complete, name):
    found = METHODS[name](source, 60)
    assert found.size == 69
    np.testing.assert_allclose(reduced_modes(source, found).eigenvalues[4:40], complete.eigenvalues[4:40], rtol=1e-6)
