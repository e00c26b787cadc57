"""Sec. 7: the mobilities behind the design criteria against closed forms, and what was found."""

import numpy as np
import pytest

from gearpath.components.mobility import mobility_direct
from gearpath.network.assemble import assemble
from gearpath.study.paper import design
from gearpath.study.paper.effect import GRID, by_band
from gearpath.study.paper.machine import shipped

OMEGA = 2.0 * np.pi * GRID


@pytest.fixture(scope="module")
def study():
    return design.study()


def mean_level(Y):
    return [part.mean() for part in by_band(20.0 * np.log10(abs(Y)).mean(axis=0), GRID)]


def test_bearing_mobility_is_eq_13():
    K = np.array([[1.2e8, 1.8e6], [1.8e6, 6.0e4]])
    held = K[0, 0] - K[0, 1] ** 2 / K[1, 1]  # with C = 1e-6 s K the matrix scales as one
    Y = 1j * OMEGA / (held * (1.0 + 1e-6j * OMEGA))
    np.testing.assert_allclose(design.mobility(shipped(), "joint"), mean_level(Y[None]), atol=1e-9)


def test_receiver_mobility_is_eq_16():
    """Y = i w P_p^T (P_b^T (K_b + i w C_b) P_b - w^2 M_a)^-1 P_p with P_p and P_b as in Eq. 17, uy columns."""
    mounts = [(-0.09, -0.12), (0.09, -0.12), (-0.09, 0.12), (0.09, 0.12)]  # x, z
    seats = [(-0.04975, -0.125), (-0.04975, 0.125), (0.05025, -0.125), (0.05025, 0.125)]
    P_b = np.array([[1.0, -z, x] for x, z in mounts])
    P_p = np.array([[1.0, -z, x] for x, z in seats]).T
    M = np.diag([12.0, 0.15, 0.17])
    Y = []
    for w in OMEGA:
        receptance = np.linalg.inv(P_b.T @ P_b * (1e7 + 440j * w) - w**2 * M)
        Y.append(1j * w * np.diag(P_p.T @ receptance @ P_p))
    np.testing.assert_allclose(design.mobility(shipped(), "receiver"), mean_level(np.array(Y).T), atol=1e-6)


def test_source_mobility_is_the_free_one():
    network = assemble(shipped().system)
    block = network.blocks["gear_train"]
    rows = np.array([joint.source[0][block] for joint in network.joints if joint.kind == "bearing"])
    Y = mobility_direct(network.structures["gear_train"], rows, OMEGA)
    found = design.mobility(shipped(), "source")
    np.testing.assert_allclose(found, mean_level(np.diagonal(Y, axis1=1, axis2=2).T), atol=1e-4)


def test_twice_the_mass_is_half_the_mobility_above_the_mounts(study):
    table = next(table for table in study.tables if "mobility" in table.caption)
    heavier = {row[0]: row[2:] for row in table.groups[0].rows}["casing mass and inertia × 2"]
    np.testing.assert_allclose([float(cell.replace("−", "-")) for cell in heavier[2:]], -6.02, atol=0.1)


def test_every_principle_is_tried_and_judged_by_its_band_means(study):
    assert len(study.claims) == len(study.effects) == 7
    for claim, effect in zip(study.claims, study.effects):
        assert [item.holds for item in claim.items] == [mean < 0.0 for mean in effect.means("alpha")]
    assert all(check.passed for check in study.checks)
    assert [len(figure.data) for figure in study.figures] == [3, 3, 4]
