"""Grid lines: on every edge, finer towards footprints, halved by doubling the numbers."""

import numpy as np
import pytest

from gearpath.components.plate_grid import grid_lines


def test_without_footprints_the_grid_is_uniform():
    np.testing.assert_allclose(grid_lines(0.4, 8, [], [], 4), np.linspace(-0.2, 0.2, 9), atol=1e-15)


def test_every_edge_and_point_has_its_line():
    edges, points = [(-0.0825, -0.0699), (0.0699, 0.0825)], [0.0381]
    lines = grid_lines(0.229, 10, edges, points, 4)
    assert np.all(np.diff(lines) > 0)
    for x in [-0.1145, *np.ravel(edges), 0.0381, 0.1145]:
        assert abs(lines - x).min() < 1e-15


def test_a_footprint_has_the_asked_number_of_elements_and_the_spacing_grows_gently_from_it():
    lines = grid_lines(1.0, 10, [(-0.05, 0.05)], [], 10)
    inside = lines[(lines > -0.05 - 1e-12) & (lines < 0.05 + 1e-12)]
    np.testing.assert_allclose(np.diff(inside), 0.01, rtol=1e-9)
    steps = np.diff(lines)
    ratio = steps[1:] / steps[:-1]
    assert max(ratio.max(), 1 / ratio.min()) < 1.6
    assert steps.max() == pytest.approx(0.1, rel=0.15)


def test_a_point_next_to_a_line_draws_none_of_its_own():
    assert len(grid_lines(1.0, 1, [], [0.499], 4)) == 2
    assert len(grid_lines(1.0, 1, [], [0.3], 4)) == 3


def test_doubling_the_numbers_halves_the_spacing_everywhere():
    coarse, fine = (grid_lines(1.0, 10 * k, [(-0.25, -0.2)], [], 4 * k) for k in (1, 2))
    middles = (coarse[1:] + coarse[:-1]) / 2
    local = np.diff(fine)[np.clip(np.searchsorted(fine, middles) - 1, 0, len(fine) - 2)]
    ratio = local / np.diff(coarse)  # less even where the spacing grows within a coarse element
    assert np.all((ratio > 0.4) & (ratio < 0.7))
    assert abs(len(fine) - 2 * len(coarse)) <= 3
