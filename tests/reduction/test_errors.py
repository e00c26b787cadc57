"""The error measures: exact relations of a small system, and the estimate against the true deviation."""

import numpy as np
import pytest
import scipy.linalg
from hypothesis import given, settings
from hypothesis import strategies as st
from sources import bampton, chain, elastic_flexibility, free, random_source

from gearpath.components import modes
from gearpath.reduction import (
    craig_bampton,
    deviation,
    estimated_deviation,
    free_interface,
    inertia_relief,
    interface_rows,
    lanczos,
    static_defect,
)

METHODS = {
    "lanczos": lanczos,
    "mesh start": lambda structure, count: lanczos(structure, count, start="mesh"),
    "craig-bampton": craig_bampton,
    "free": lambda structure, count: free_interface(structure, count, residual=False),
    "residual": lambda structure, count: free_interface(structure, count, residual=True),
}
LINES = 2 * np.pi * np.arange(50.0, 5001.0, 50.0)


def test_static_defect_of_a_chain_by_hand():
    """End of a free chain: compliance sum_k phi_k^2 / w_k^2 with phi_k^2 = 2/n cos^2(k pi / 2n)."""
    n, kept = 12, 3
    k = np.arange(1, n)
    terms = 2.0 / n * np.cos(k * np.pi / (2 * n)) ** 2 / (2.0 * np.sin(k * np.pi / (2 * n))) ** 2
    expected = terms[kept:].sum() / terms.sum()
    assert static_defect(chain(n), free_interface(chain(n), kept, residual=False)) == pytest.approx(expected, rel=1e-10)


def test_deviation_of_a_chain_by_hand():
    """One kept mode of three masses: the receptance at the end against the sum of all three terms."""
    structure = chain(3)
    w = np.array([0.3, 0.8])
    natural = np.array([0.0, 1.0, np.sqrt(3.0)])
    weight = np.array([1 / 3, 1 / 2, 1 / 6])
    term = weight / (natural**2 - w[:, None] ** 2 + 2j * 0.01 * natural * w[:, None])
    expected = abs(term[:, 2]) / abs(term.sum(axis=1))
    found = deviation(structure, free_interface(structure, 1, residual=False), modes(structure), w)
    np.testing.assert_allclose(found, expected, rtol=1e-10)


@pytest.mark.parametrize("count", [4, 9, 14, 24])
@pytest.mark.parametrize("name", METHODS)
def test_the_estimate_tells_the_true_deviation(source, complete, name, count):
    """Without the complete basis, within 20 % of its largest value in the band."""
    found = METHODS[name](source, count)
    true, estimate = deviation(source, found, complete, LINES).max(), estimated_deviation(source, found, LINES).max()
    assert true > 1e-6
    assert 0.8 < estimate / true < 1.2


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(0, 20), st.sampled_from(["lanczos", "bampton", "residual"]))
def test_a_small_estimate_can_be_trusted(seed, count, name):
    """Of any gear train: the largest deviation in the band is at most twice an estimate below 0.1, and 1e-5."""
    source = random_source(seed)
    methods = {"lanczos": lanczos, "bampton": bampton, "residual": lambda s, k: free(s, k, residual=True)}
    found = methods[name](source, count)
    true = deviation(source, found, modes(source), LINES).max()
    estimate = estimated_deviation(source, found, LINES).max()
    assert estimate >= 0.1 or true < 2.0 * estimate + 1e-5


def test_the_factor_can_be_shared(source):
    found, flexibility = lanczos(source, 6), inertia_relief(source)
    assert static_defect(source, found, flexibility=flexibility) == static_defect(source, found)
    np.testing.assert_array_equal(
        estimated_deviation(source, found, LINES, flexibility=flexibility), estimated_deviation(source, found, LINES)
    )


def test_static_defect_against_the_dense_sum(source):
    found = craig_bampton(source, 3)
    L = interface_rows(source).toarray()
    exact = np.diag(L @ elastic_flexibility(source) @ L.T)
    values, shapes = scipy.linalg.eigh(found.stiffness, found.mass)
    seen = L @ found.basis @ shapes[:, 4:]
    expected = np.max(1.0 - (seen**2 / values[4:]).sum(axis=1) / exact)
    assert static_defect(source, found) == pytest.approx(expected, rel=1e-4)
