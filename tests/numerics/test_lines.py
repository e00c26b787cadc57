"""Solves across frequency lines: agreement with LAPACK, pivoting where it is needed, singular lines."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gearpath.errors import AccuracyError
from gearpath.numerics.lines import chunks, real_times_complex, solve_lines


def random_lines(seed, n, m, lines):
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(n, n, lines)) + 1j * rng.normal(size=(n, n, lines))
    b = rng.normal(size=(n, m, lines)) + 1j * rng.normal(size=(n, m, lines))
    return A, b


@given(st.integers(0, 10**6), st.integers(1, 9), st.integers(1, 3))
def test_solutions_satisfy_their_equations(seed, n, m):
    A, b = random_lines(seed, n, m, 20)
    x = solve_lines(A, b)
    residual = np.einsum("ijf,jmf->imf", A, x) - b
    size = np.einsum("ijf,jmf->imf", abs(A), abs(x)) + abs(b)
    assert np.max(abs(residual) / size) < 1e-12


def test_a_zero_pivot_is_solved_with_pivoting():
    A = np.array([[0.0, 1.0], [1.0, 0.0]], complex)[:, :, None] * np.ones(3)
    x = solve_lines(A, np.array([[2.0], [3.0]], complex)[:, :, None] * np.ones(3))
    np.testing.assert_allclose(x[:, 0, 0], [3.0, 2.0])


def test_a_singular_line_is_refused():
    A, b = random_lines(0, 3, 1, 4)
    A[..., 2] = 0.0
    with pytest.raises(AccuracyError, match="singular"):
        solve_lines(A, b)


def test_real_times_complex():
    rng = np.random.default_rng(0)
    A, x = rng.normal(size=(3, 4)), rng.normal(size=(4, 2, 5)) + 1j * rng.normal(size=(4, 2, 5))
    np.testing.assert_allclose(real_times_complex(A, x), np.tensordot(A, x, 1), rtol=1e-14)


def test_chunks_cover_every_line_once_and_stay_bounded():
    parts = list(chunks(10_001, 16_000))
    assert [part.start for part in parts[1:]] == [part.stop for part in parts[:-1]]
    assert (parts[0].start, parts[-1].stop) == (0, 10_001)
    assert max(part.stop - part.start for part in parts) * 16_000 <= 16 << 20
