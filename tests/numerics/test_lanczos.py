"""Lanczos vectors against their definition: orthogonality, band structure, moments, breakdown, convergence."""

import numpy as np
import pytest
import scipy.linalg
from hypothesis import given, settings
from hypothesis import strategies as st

from gearpath.numerics.lanczos import BlockLanczos, independent


def pencil(seed, n, spread=4.0):
    """Symmetric positive definite K and M with eigenvalues over so many decades, and their exact modes."""
    rng = np.random.default_rng(seed)
    values = 10.0 ** np.sort(rng.uniform(0.0, spread, n))
    mass = rng.uniform(0.3, 3.0, n)
    turned = np.linalg.qr(rng.normal(size=(n, n)))[0] * np.sqrt(mass)[:, None]
    return turned @ (values[:, None] * turned.T), np.diag(mass), values, turned / mass[:, None]


def run(K, M, F, count, held=None):
    return BlockLanczos(lambda x: np.linalg.solve(K, M @ x), M, np.linalg.solve(K, F), held).take(count)


@pytest.mark.parametrize(("width", "count"), [(1, 20), (3, 21), (9, 27)])
def test_vectors_are_orthonormal_in_the_mass(width, count):
    K, M, _, _ = pencil(1, 60)
    V = run(K, M, np.random.default_rng(2).normal(size=(60, width)), count).vectors
    assert abs(V.T @ M @ V - np.eye(count)).max() < 1e-12


@pytest.mark.parametrize("width", [1, 2, 4])
def test_the_operator_is_block_tridiagonal_in_them(width):
    """T = V^T M K^-1 M V couples neighbouring blocks only: the three-term recurrence, which the code never uses."""
    K, M, _, _ = pencil(3, 50)
    found = run(K, M, np.random.default_rng(4).normal(size=(50, width)), 5 * width)
    assert found.blocks == (width,) * 5
    V = found.vectors
    T = V.T @ M @ np.linalg.solve(K, M @ V)
    block = np.repeat(np.arange(5), width)
    far = abs(block[:, None] - block) > 1
    assert abs(T[far]).max() < 1e-12 * abs(T).max()
    assert all(np.linalg.norm(T[np.ix_(block == k + 1, block == k)]) > 1e-3 * abs(T).max() for k in range(4))


@pytest.mark.parametrize("width", [1, 3])
@pytest.mark.parametrize("blocks", [1, 2, 3])
def test_moments_are_matched(width, blocks):
    """Projection on j blocks keeps F^T (K^-1 M)^k K^-1 F for k < 2 j, and no further (moment matching)."""
    K, M, _, _ = pencil(5, 40, spread=2.0)
    F = np.random.default_rng(6).normal(size=(40, width))
    V = run(K, M, F, blocks * width).vectors
    Kr, Mr, Fr = V.T @ K @ V, V.T @ M @ V, V.T @ F
    exact, reduced = np.linalg.solve(K, F), np.linalg.solve(Kr, Fr)
    deviations = []
    for _ in range(2 * blocks + 1):
        moment = F.T @ exact
        deviations.append(abs(moment - Fr.T @ reduced).max() / abs(moment).max())
        exact, reduced = np.linalg.solve(K, M @ exact), np.linalg.solve(Kr, Mr @ reduced)
    assert max(deviations[:-1]) < 1e-10
    assert deviations[-1] > 1e-8


def test_breakdown_ends_with_the_invariant_subspace():
    """A start made of four modes spans a space of four, whatever is asked for."""
    K, M, _, modes = pencil(7, 30, spread=1.0)
    start = K @ modes[:, [2, 5, 11, 17]] @ np.array([[1.0], [2.0], [-1.0], [0.5]])
    found = run(K, M, start, 20)
    assert found.exhausted
    assert found.vectors.shape == (30, 4)
    assert np.linalg.matrix_rank(np.hstack([found.vectors, modes[:, [2, 5, 11, 17]]]), tol=1e-6) == 4


def test_dependent_columns_are_deflated():
    K, M, _, _ = pencil(8, 30)
    F = np.random.default_rng(9).normal(size=(30, 2))
    double = np.hstack([F, 3.0 * F, F[:, :1] - F[:, 1:], np.zeros((30, 1))])
    found, plain = run(K, M, double, 8), run(K, M, F, 8)
    assert found.blocks == (2, 2, 2, 2)
    angles = scipy.linalg.subspace_angles(found.vectors, plain.vectors)
    assert angles.max() < 1e-8


def test_vectors_stay_away_from_what_is_held():
    K, M, _, modes = pencil(10, 30)
    held = modes[:, [1, 4]] / np.sqrt(np.diag(modes.T @ M @ modes))[[1, 4]]
    V = run(K, M, np.ones((30, 1)), 10, held).vectors
    assert abs(held.T @ M @ V).max() < 1e-12


def test_short_remainders_are_as_orthogonal_as_long_ones():
    """Columns that add a hundred-millionth of their length to others, of which rounding leaves as much again."""
    rng = np.random.default_rng(14)
    mass = np.diag(rng.uniform(0.3, 3.0, 50))
    none = np.zeros((50, 0))
    V = independent(rng.normal(size=(50, 6)), mass, none, none)
    near = V @ rng.normal(size=(6, 3)) + 1e-8 * rng.normal(size=(50, 3))
    far = rng.normal(size=(50, 1))
    added = independent(np.hstack([near, far, far + 1e-8 * rng.normal(size=(50, 1))]), mass, V, mass @ V)
    assert added.shape == (50, 5)
    assert abs(V.T @ mass @ added).max() < 1e-14
    assert abs(added.T @ mass @ added - np.eye(5)).max() < 1e-14


def test_directions_without_mass_add_nothing():
    """Neither a coordinate without mass nor a combination of two that have some."""
    mass = scipy.linalg.block_diag([[1.0, 1.0], [1.0, 1.0]], np.diag([2.0, 0.0, 3.0]))
    none = np.zeros((5, 0))
    added = independent(np.eye(5), mass, none, none)
    assert added.shape == (5, 3)
    assert abs(added.T @ mass @ added - np.eye(3)).max() < 1e-14


def test_the_same_input_gives_the_same_vectors():
    K, M, _, _ = pencil(11, 30)
    F = np.ones((30, 1))
    np.testing.assert_array_equal(run(K, M, F, 12).vectors, run(K, M, F, 12).vectors)


@pytest.mark.parametrize("steps", [(1, 2, 12), (5, 5, 3, 12), (12,)])
def test_more_vectors_are_those_of_one_go(steps):
    """Also after a cut through a block of three, and without solving for any vector again."""
    K, M, _, _ = pencil(12, 40)
    solved, start = [], np.linalg.solve(K, np.random.default_rng(13).normal(size=(40, 3)))

    def operator(x):
        solved.append(x.shape[1])
        return np.linalg.solve(K, M @ x)

    lanczos = BlockLanczos(operator, M, start)
    for count in steps:
        found = lanczos.take(count)
        assert found.vectors.shape == (40, count)
        assert sum(found.blocks) == count
    assert solved == [3, 3, 3]
    np.testing.assert_array_equal(found.vectors, BlockLanczos(operator, M, start).take(12).vectors)


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 4), st.integers(1, 20))
def test_ritz_values_bound_the_eigenvalues_from_above(seed, width, count):
    K, M, values, _ = pencil(seed, 25)
    V = run(K, M, np.random.default_rng(seed + 1).normal(size=(25, width)), count).vectors
    ritz = scipy.linalg.eigvalsh(V.T @ K @ V, V.T @ M @ V)
    assert np.all(ritz >= values[: len(ritz)] * (1.0 - 1e-9))
