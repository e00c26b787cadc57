"""Free-interface modes and residual flexibility, against the dense sum over all modes."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sources import chain, elastic_flexibility, random_source, sparse

from gearpath.errors import InputError
from gearpath.reduction import (
    free_interface,
    hold,
    inertia_relief,
    interface_rows,
    port_rows,
    reduced_modes,
    static_defect,
)
from gearpath.reduction import normal_modes as module


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_inertia_relief_is_the_sum_over_the_elastic_modes(seed):
    source = random_source(seed)
    L = interface_rows(source).toarray()
    exact, found = L @ elastic_flexibility(source) @ L.T, L @ inertia_relief(source).apply(L.T)
    size = np.sqrt(np.diag(exact))
    assert abs((found - exact) / np.outer(size, size)).max() < 1e-4  # the eigensolver's digits of the lowest modes


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_it_does_not_matter_where_the_structure_is_held(seed):
    """At no more coordinates than keep it in place, or at all ports, whose own motion is then added."""
    source = random_source(seed)
    L = interface_rows(source).toarray()
    plain, ports = (L @ inertia_relief(source, held).apply(L.T) for held in (None, hold(source, port_rows(source))))
    size = np.sqrt(np.diag(plain))
    assert abs((ports - plain) / np.outer(size, size)).max() < 1e-8


def test_flexibility_of_a_chain_of_two():
    """Two unit masses on a unit spring, w^2 = 2: G = [[1, -1], [-1, 1]] / 4."""
    structure = chain(2)
    np.testing.assert_allclose(inertia_relief(structure).apply(np.eye(2)), [[0.25, -0.25], [-0.25, 0.25]], atol=1e-15)


def test_elastic_modes_of_a_free_chain():
    found = free_interface(chain(12), 5, residual=False)
    expected = 2.0 * np.sin(np.arange(6) * np.pi / 24)
    np.testing.assert_allclose(np.sqrt(reduced_modes(chain(12), found).eigenvalues), expected, atol=1e-12)


def test_residuals_make_the_basis_statically_complete(source):
    """By any number of modes; without residuals the defect falls slowly, as the sum of 1/w^2 that is left out."""
    for count in (0, 4, 20):
        assert static_defect(source, free_interface(source, count, residual=True)) < 1e-10
    without = [static_defect(source, free_interface(source, count, residual=False)) for count in (4, 10, 20, 40)]
    assert np.all(np.diff(without) < 0.0)
    assert without[-1] > 1e-2


def test_inverse_iteration_and_dense_solution_agree(source, complete, monkeypatch):
    """The path that large sparse structures take, on the small one."""
    dense = free_interface(source, 12, residual=True)
    monkeypatch.setattr(module, "_DENSE", 0)
    iterated = free_interface(sparse(source), 12, residual=True)
    for found in (dense, iterated):
        np.testing.assert_allclose(
            reduced_modes(source, found).eigenvalues[4:16], complete.eigenvalues[4:16], rtol=1e-8
        )


def test_more_modes_than_there_are_is_refused(source):
    with pytest.raises(InputError, match="66 normal modes are wanted of a structure that has 65"):
        free_interface(source, 66, residual=False)
