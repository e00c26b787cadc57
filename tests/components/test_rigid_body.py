"""Rigid casing: kinematics of Eq. 17, mobility against Newton and Euler, which coordinates stay."""

import numpy as np

from gearpath.components import RigidBody
from gearpath.components.mobility import mobility_direct, mobility_modal
from gearpath.components.modes import modes

CG = (0.01, -0.02, 0.03)
CASING = RigidBody(12.0, {"xx": 0.15, "yy": 0.2, "zz": 0.17}, CG)


def test_planar_ports_keep_the_three_coordinates_of_eq_15():
    structure = CASING.structure(("uy", "rx"), {"p": (0.1, 0.0, 0.2)})
    assert CASING.coordinates(structure) == ("uy", "rx", "rz")
    np.testing.assert_array_equal(structure.mass, np.diag([12.0, 0.15, 0.17]))


def test_rows_are_the_transpose_of_eq_17a():
    point = np.array([0.1, 0.0, 0.2])
    structure = CASING.structure(("uy", "rx"), {"p": tuple(point)})
    Rx, _, Rz = point - CG
    np.testing.assert_allclose(structure.ports["p"][1], [1.0, -Rz, Rx], rtol=1e-15)
    np.testing.assert_allclose(structure.ports["p"][3], [0.0, 1.0, 0.0], rtol=1e-15)


def test_mobility_is_newton_and_euler():
    """Y = P M^-1 P^T / (i w), by Eq. 6 and by Eq. 7 with the zero-frequency modes."""
    structure = CASING.structure(("uy", "rx"), {"p": (0.1, 0.0, 0.2)})
    rows, omega = structure.ports["p"][[1, 3]], np.array([10.0, 1e4])
    expected = (rows @ np.diag([1 / 12.0, 1 / 0.15, 1 / 0.17]) @ rows.T)[None] / (1j * omega)[:, None, None]
    np.testing.assert_allclose(mobility_direct(structure, rows, omega), expected, rtol=1e-13)
    np.testing.assert_allclose(mobility_modal(modes(structure), rows, 0.0, omega), expected, rtol=1e-13)


def test_a_product_of_inertia_drags_its_coordinate_along():
    body = RigidBody(12.0, {"xx": 0.15, "yy": 0.2, "zz": 0.17, "xy": 0.01}, CG)
    structure = body.structure(("uy", "rx"), {"p": (0.1, 0.0, 0.2)})
    assert body.coordinates(structure) == ("uy", "rx", "ry", "rz")
    assert structure.mass[1, 2] == 0.01


def test_all_six_degrees_of_freedom_turn_by_the_right_hand():
    structure = CASING.structure(("ux", "uy", "uz", "rx", "ry", "rz"), {"p": (0.1, 0.0, 0.2)})
    omega = np.array([0.3, -0.2, 0.5])
    motion = structure.ports["p"] @ np.concatenate([np.zeros(3), omega])
    np.testing.assert_allclose(motion[:3], np.cross(omega, np.subtract((0.1, 0.0, 0.2), CG)), rtol=1e-14)
