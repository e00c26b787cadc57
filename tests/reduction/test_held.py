"""Constraint modes and the change of coordinates, against a bordered system solved densely."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse
from hypothesis import given, settings
from hypothesis import strategies as st
from sources import beam_shaft, bordered_static, chain, random_source, sparse

from gearpath.components import RigidBody, Structure
from gearpath.errors import AccuracyError, InputError
from gearpath.reduction import constraint_modes, hold, interface_rows, mesh_rows, port_rows


def test_single_coordinate_rows_are_the_partition_of_the_paper(source):
    """T_c = [I; A], A = -K_ii^-1 K_ib (Eq. 9, 10) by plain indexing."""
    boundary = np.array([0, 1, 32, 33, 34, 35, 66, 67])
    inner = np.setdiff1d(np.arange(69), boundary)
    K = source.stiffness
    A = -np.linalg.solve(K[np.ix_(inner, inner)], K[np.ix_(inner, boundary)])
    held = hold(source, port_rows(source))
    np.testing.assert_array_equal(held.inner, inner)
    np.testing.assert_array_equal(held.constraint_modes[boundary], np.eye(8))
    np.testing.assert_allclose(held.constraint_modes[inner], A, atol=1e-10)
    np.testing.assert_allclose(held.mass.toarray(), source.mass[np.ix_(inner, inner)], rtol=0, atol=0)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_constraint_modes_of_any_rows_cost_the_least_strain_energy(seed):
    """Rows that mix coordinates, of random gear trains: the same as Lagrange multipliers give."""
    source = random_source(seed)
    rng = np.random.default_rng(seed)
    ports = np.vstack(list(source.ports.values()))
    ports = ports[np.any(ports, axis=1)]
    mix = rng.normal(size=(min(len(ports), 6), len(ports)))
    held = hold(source, np.vstack([mix @ ports, mesh_rows(source)]))
    rows = held.rows.toarray()
    expected, condition = bordered_static(source.stiffness, rows, np.eye(len(rows)))
    deviation = np.sqrt(np.diag(source.stiffness))[:, None] * (held.constraint_modes - expected)
    size = abs(np.sqrt(np.diag(source.stiffness))[:, None] * expected).max()
    # mixed rows may hold some rigid motions barely; by so much rounding moves any solution
    assert abs(deviation).max() < max(1e-8, np.finfo(float).eps * condition) * size
    np.testing.assert_allclose(rows @ held.constraint_modes, np.eye(len(rows)), atol=1e-9 * abs(rows).max())
    np.testing.assert_allclose(rows @ held.embed(np.eye(len(held.inner))), 0.0, atol=1e-9 * abs(rows).max())


def test_dependent_rows_are_dropped():
    body = RigidBody(12.0, {"xx": 0.15, "yy": 0.2, "zz": 0.17})
    structure = body.structure(("uy", "rx"), {"a": (0.1, 0.0, 0.1), "b": (-0.1, 0.0, 0.1), "c": (0.0, 0.0, -0.2)})
    held = hold(structure, port_rows(structure))
    assert held.boundary == structure.size == 3
    assert held.embed(np.zeros((0, 1))).shape == (3, 1)


def test_rigid_motion_that_the_rows_leave_is_held_by_coordinates():
    """Explicit spin, bearings without rotation about the shaft: K_ii of the ports alone is singular."""
    rng = np.random.default_rng(3)
    source = next(
        found
        for found in (random_source(int(seed)) for seed in rng.integers(0, 10**6, 50))
        if found.rigid_modes.shape[1] >= 6 and any(rows[5].any() for rows in found.ports.values())
    )
    translations = np.vstack([rows[:2] for rows in source.ports.values()])
    held = hold(source, translations)
    assert held.boundary > held.given
    seen = held.rows @ source.rigid_modes
    assert np.linalg.matrix_rank(seen / abs(seen).max(axis=0)) == source.rigid_modes.shape[1]
    np.testing.assert_allclose(held.constraint_modes @ seen, source.rigid_modes, atol=1e-10)


def test_rigid_motion_is_exact_where_the_solve_is_not():
    """A slender shaft of 400 elements held at one end: the solve alone keeps eight digits of its rigid motion."""
    shaft = beam_shaft(400)
    held = hold(shaft, shaft.ports["end"])
    deviation = held.constraint_modes @ (held.rows @ shaft.rigid_modes) - shaft.rigid_modes
    assert abs(deviation).max() < 1e-13


def test_no_rows_at_all_hold_the_rigid_motion_only():
    held = hold(chain(), np.zeros((0, 12)))
    assert (held.given, held.boundary) == (0, 1)
    np.testing.assert_allclose(held.constraint_modes, np.ones((12, 1)), rtol=1e-14)


def test_sparse_matrices_and_rows_give_the_same(source):
    dense, thin = hold(source, interface_rows(source).toarray()), hold(sparse(source), interface_rows(source))
    np.testing.assert_array_equal(dense.constraint_modes, thin.constraint_modes)


def test_mesh_row_of_the_planar_gearbox_is_the_spin(source):
    np.testing.assert_allclose(mesh_rows(source), np.eye(69)[[68]], atol=1e-15)


def test_rows_of_the_wrong_width_are_refused(source):
    with pytest.raises(InputError, match="68 columns for a structure of 69"):
        hold(source, np.eye(68))


def test_an_undeclared_mechanism_is_found():
    """Two separate chains that declare one rigid motion in common: held at one of them, the other floats."""
    part = chain(5).stiffness
    K = scipy.sparse.block_diag([part, part]).toarray()
    structure = Structure(np.eye(10), K, np.ones((10, 1)), 0.0, {})
    with pytest.raises(AccuracyError, match="singular to working precision"):
        hold(structure, np.eye(10)[:1])


def test_a_false_rigid_mode_is_found():
    structure = replace(chain(8), rigid_modes=np.linspace(0.0, 1.0, 8)[:, None])
    with pytest.raises(AccuracyError, match="1 of the declared rigid-body modes deform"):
        constraint_modes(structure, np.eye(8)[[0, 7]])
