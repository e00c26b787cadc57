"""The mesh in space: against the geometry of base circles and base helices, rigid motion, the planar limit, trains."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from systems import STEEL

from gearpath.components import DOFS, Disk, GearTrain, Mesh, Section, Shaft, ShaftPoint, modes
from gearpath.components.dofs import rigid_motion

Z = np.array([0.0, 0.0, 1.0])
BETWEEN = (("a", "gear"), ("b", "gear"))


def pair(radii, pressure, helix, direction, torque="+z", first=(0.02, -0.03, 0.01), **keys):
    """A mesh, and the places of its gears, the second from the first at the angle `direction` to x."""
    distance = sum(radii) / np.cos(pressure)
    second = np.add(first, [distance * np.cos(direction), distance * np.sin(direction), 0.0])
    mesh = Mesh(BETWEEN, 2e8, radii, pressure, helix, torque, **keys)
    return mesh, tuple(map(float, first)), tuple(map(float, second))


def teeth(mesh, first, second):
    """Contact point and unit normal of the teeth, from the base cylinders alone.

    The common tangent that crosses between the base circles touches them at T1 and T2, where the radii are parallel:
    T1 = O1 + r1 e, T2 = O2 - r2 e, (T2 - T1) . e = 0. Of the two, gear 1 pushes along T1 -> T2 on the one where that
    force turns gear 1 back against its driving torque. The teeth lie in the plane through T1, T2 and z along the base
    helix of gear 1, whose tangent at T1 a right-hand screw turns from z towards increasing angle; the normal is across.
    """
    O1, O2 = np.array(first), np.array(second)
    r1, r2 = mesh.base_radii
    along = np.arctan2(*(O2 - O1)[1::-1])
    half = np.arccos((r1 + r2) / np.hypot(*(O2 - O1)[:2]))
    turn = {"+z": 1.0, "-z": -1.0}[mesh.driving_torque]
    for angle in (along + half, along - half):
        e = np.array([np.cos(angle), np.sin(angle), 0.0])
        T1, T2 = O1 + r1 * e, O2 - r2 * e
        force = (T2 - T1) / np.linalg.norm(T2 - T1)
        if np.cross(T1 - O1, -force)[2] * turn < 0.0:
            break
    helix = np.cos(mesh.helix_angle) * Z + np.sin(mesh.helix_angle) * np.cross(Z, e)
    normal = force - helix * (helix @ force)
    pitch = O1 + (O2 - O1) * r1 / (r1 + r2)
    return pitch, normal / np.linalg.norm(normal)


angles = st.floats(0.01, 0.6), st.floats(-0.7, 0.7), st.floats(-np.pi, np.pi)
meshes = st.builds(pair, st.tuples(*[st.floats(0.01, 0.2)] * 2), *angles, st.sampled_from(["+z", "-z"]))


@settings(max_examples=200, deadline=None)
@given(meshes)
def test_line_of_action_is_that_of_the_base_cylinders(case):
    mesh, first, second = case
    _, normal = teeth(mesh, first, second)
    np.testing.assert_allclose(mesh.line_of_action(first, second), normal, atol=2e-13)
    assert np.linalg.norm(mesh.line_of_action(first, second)) == pytest.approx(1.0, rel=1e-14)


@settings(max_examples=50, deadline=None)
@given(meshes)
def test_stiffness_is_the_second_derivative_of_the_energy_of_two_rigid_gears(case):
    """k/2 (n . (P1 - P2))^2 of the displaced contact points, which turn with their gears by finite rotations.

    The points leave their place together, so that the curvature of the rotations does not enter: k b b^T, 12 x 12.
    """
    mesh, first, second = case
    pitch, normal = teeth(mesh, first, second)

    def energy(q):
        points = [
            centre + q[6 * i : 6 * i + 3] + Rotation.from_rotvec(q[6 * i + 3 : 6 * i + 6]).apply(pitch - centre)
            for i, centre in enumerate((np.array(first), np.array(second)))
        ]
        return 0.5 * mesh.stiffness * (normal @ (points[0] - points[1])) ** 2

    step = 1e-4
    K = np.empty((12, 12))
    for i, k in product(range(12), repeat=2):
        a, b = np.eye(12)[i] * step, np.eye(12)[k] * step
        K[i, k] = (energy(a + b) - energy(a - b) - energy(b - a) + energy(-a - b)) / (4 * step**2)
    b = mesh.deformation(first, second).ravel()
    np.testing.assert_allclose(mesh.stiffness * np.outer(b, b), K, atol=3e-7 * mesh.stiffness)


@settings(max_examples=200, deadline=None)
@given(meshes)
def test_mesh_forces_are_in_equilibrium(case):
    """Equal and opposite forces without moment about any point: b is orthogonal to the six rigid motions of both."""
    mesh, first, second = case
    b = mesh.deformation(first, second)
    for point in (np.zeros(3), np.array([0.3, -0.2, 0.7])):
        moved = sum(row @ rigid_motion(np.subtract(place, point)) for row, place in zip(b, (first, second)))
        np.testing.assert_allclose(moved, 0.0, atol=3e-14)


def test_force_parts_of_a_helical_gear():
    """Tangential, radial and axial force on the driven gear, F_t : F_t tan(alpha_t) : F_t tan(beta) (Niemann)."""
    beta, alpha_n = 0.28379, np.radians(20)
    alpha = np.arctan(np.tan(alpha_n) / np.cos(beta))
    base = np.arcsin(np.sin(beta) * np.cos(alpha_n))
    mesh, first, second = pair((0.031, 0.062), alpha, base, 0.0)
    n = mesh.line_of_action(first, second)
    np.testing.assert_allclose(n / n[1], [np.tan(alpha), 1.0, -np.tan(beta)], rtol=1e-12)


def test_right_hand_driver_turning_right_is_thrust_along_z():
    """The right-hand rule of the textbooks: fingers along the rotation, the thumb shows the thrust on the driver."""
    for helix, torque, thrust in ((0.3, "+z", 1), (-0.3, "+z", -1), (0.3, "-z", -1), (-0.3, "-z", 1)):
        mesh, first, second = pair((0.03, 0.05), 0.35, helix, 1.0, torque)
        on_driver = -mesh.line_of_action(first, second)
        assert np.sign(on_driver[2]) == thrust


@pytest.mark.parametrize("x", [0.1, -0.1])
@pytest.mark.parametrize("pressure", [None, 0.0])
def test_both_angles_zero_are_the_planar_spur_mesh_exactly(pressure, x):
    """y1 - y2 + r1 th1 + r2 th2, the contact between the axes; mirrored, the gears turn the other way."""
    mesh = Mesh(BETWEEN, 1e8, (0.04, 0.06), pressure)
    turn = np.sign(x)
    expected = [[0, 1, 0, 0, 0, turn * 0.04], [0, -1, 0, 0, 0, turn * 0.06]]
    np.testing.assert_array_equal(mesh.deformation((0.0, 0.0, 0.2), (x, 0.0, 0.2)), expected)


def test_small_angles_tend_to_the_spur_mesh_linearly():
    spur = Mesh(BETWEEN, 1e8, (0.04, 0.06)).deformation((0.0, 0.0, 0.0), (0.1, 0.0, 0.0))
    changes = []
    for eps in (1e-3, 1e-4):
        rows = Mesh(BETWEEN, 1e8, (0.04, 0.06), eps, eps).deformation((0.0, 0.0, 0.0), (0.1 / np.cos(eps), 0.0, 0.0))
        changes.append(abs(rows - spur).max())
    assert changes[0] == pytest.approx(1e-3, rel=1e-2)
    assert changes[0] / changes[1] == pytest.approx(10.0, rel=1e-2)


def test_without_a_torque_the_first_gear_pushes_the_second_towards_y():
    for direction in np.linspace(-np.pi, np.pi, 24, endpoint=False) + 0.01:
        mesh, first, second = pair((0.04, 0.06), 0.1, 0.0, direction, torque="")
        positive = np.cos(direction) > 0
        same = replace(mesh, driving_torque="+z" if positive else "-z")
        np.testing.assert_array_equal(mesh.deformation(first, second), same.deformation(first, second))
        if abs(np.cos(direction)) > np.sin(0.1):
            assert mesh.line_of_action(first, second)[1] > 0
    above = [Mesh(BETWEEN, 1e8, (0.04, 0.06), 0.1).sense((0.0, 0.0, 0.0), (x, 0.1, 0.0)) for x in (-1e-17, 0.0, 1e-17)]
    assert above == [1.0, 1.0, 1.0]  # rounding of an origin does not exchange the flanks


def test_contact_off_the_middle_plane_keeps_the_equilibrium():
    mesh, first, second = pair((0.04, 0.06), 0.35, 0.25, 0.4, contact_offset=0.007)
    second = (*second[:2], second[2] + 0.01)  # the wheel 10 mm further on
    b = mesh.deformation(first, second)
    moved = sum(row @ rigid_motion(np.array(place)) for row, place in zip(b, (first, second)))
    np.testing.assert_allclose(moved, 0.0, atol=3e-14)
    lever = np.cross([0.0, 0.0, 0.007], mesh.line_of_action(first, second))
    middle = replace(mesh, contact_offset=None).deformation(first, second)
    np.testing.assert_allclose(b[0] - middle[0], [0, 0, 0, *lever], atol=1e-15)


PINION = Disk("gear", 0.1, 0.8, 3e-4, 5e-4)
WHEEL = Disk("gear", 0.1, 3.0, 4e-3, 7e-3)


def train(meshes, **shafts):
    def shaft(origin, *disks):
        return Shaft(STEEL, (*origin, 0.0), (Section(0.2, 0.03),), 0.886, (3,), disks)

    return GearTrain({name: shaft(*parts) for name, parts in shafts.items()}, meshes, 0.01)


def helical_pair():
    mesh, first, second = pair((0.03, 0.06), 0.36, 0.26, 0.7, first=(0.0, 0.0, 0.0))
    return train({"mesh": mesh}, a=(first[:2], PINION), b=(second[:2], WHEEL))


def test_helical_pair_has_eleven_rigid_modes_and_couples_axial_motion():
    structure = helical_pair().structure(DOFS, {})
    basis = modes(structure)
    assert np.count_nonzero(basis.eigenvalues == 0.0) == 11
    uz = structure.rigid_modes.reshape(2, -1, 6, 11)[:, :, 2].reshape(-1, 11)
    assert abs(uz).max() > 0.0
    slid = np.zeros(structure.size)
    slid[2 : structure.size // 2 : 6] = 1.0  # the first shaft along z: the teeth take it up
    n = helical_pair().meshes["mesh"].line_of_action((0.0, 0.0, 0.0), helical_pair().shafts["b"].origin)
    assert slid @ structure.stiffness @ slid == pytest.approx(2e8 * n[2] ** 2, rel=1e-9)


@pytest.mark.parametrize("dofs", [DOFS, DOFS[:5]])
def test_transmission_error_of_a_helical_pair_is_undone_by_spins(dofs):
    """d deforms the mesh by 1 along n without moving a point of a shaft's axis; m_e of the theory of spins.

    1/m_e = cos^2(beta_b) (r1^2/J1 + r2^2/J2), with the shafts' own polar inertia where they turn with the gears.
    """
    built = helical_pair()
    structure = built.structure(dofs, {"end": ShaftPoint("a", 0.0), "far": ShaftPoint("b", 0.2)})
    motion = structure.meshes["mesh"]
    d = motion.displacement
    assert d @ structure.stiffness @ d == pytest.approx(2e8, rel=1e-9)
    for port in structure.ports.values():
        np.testing.assert_array_equal((port @ d)[:5], 0.0)
    shaft = 7850 * np.pi * 0.03**4 / 32 * 0.2 if "rz" in dofs else 0.0
    J = np.array([5e-4, 7e-3]) + shaft
    expected = 1 / (np.cos(0.26) ** 2 * np.sum(np.array([0.03, 0.06]) ** 2 / J))
    assert motion.equivalent_mass == pytest.approx(expected, rel=1e-9)


def test_a_layshaft_with_two_helical_gears():
    """Gears of the same shaft: input - layshaft - output, 3 x 6 rigid motions less two meshes; thrusts of both cancel.

    With r tan(beta_b) in one proportion and hands alike on the layshaft, its axial forces balance.
    """
    r, beta = (0.03, 0.06, 0.035, 0.055), 0.2
    lower = np.arctan(np.tan(beta) * r[2] / r[1])  # smaller where the radius is smaller
    first, x1, x2 = pair((r[0], r[1]), 0.35, -beta, 0.0, first=(0.0, 0.0, 0.0))
    second, _, x3 = pair((r[2], r[3]), 0.35, lower, 0.5, "-z", first=x2)
    small, large = Disk("small", 0.15, 0.9, 4e-4, 6e-4), replace(WHEEL, name="large", z=0.05)
    meshes = {
        "one": replace(first, between=(("a", "gear"), ("lay", "large"))),
        "two": replace(second, between=(("lay", "small"), ("c", "gear"))),
    }
    built = train(
        meshes,
        a=(x1[:2], replace(PINION, z=0.05)),
        lay=(x2[:2], large, small),
        c=(x3[:2], replace(WHEEL, z=0.15)),
    )
    structure = built.structure(DOFS, {})
    assert np.count_nonzero(modes(structure).eigenvalues == 0.0) == 16
    for name, other in (("one", "two"), ("two", "one")):
        d = structure.meshes[name].displacement
        force = structure.stiffness @ d  # the mesh forces of a unit error in one mesh, none in the other
        assert d @ force == pytest.approx(2e8, rel=1e-8)
        assert abs(structure.meshes[other].displacement @ force) < 1e-5 * 2e8
    # static torque through the layshaft: mesh forces F1, F2 with r2 F1 cos(b1) = r3 F2 cos(b2)
    n1 = meshes["one"].line_of_action(x1, x2)
    n2 = meshes["two"].line_of_action(x2, x3)
    F1 = 1000.0
    F2 = F1 * r[1] * np.cos(beta) / (r[2] * np.cos(lower))
    assert F1 * n1[2] - F2 * n2[2] == pytest.approx(0.0, abs=1e-9)


def test_idler_between_two_helical_gears_rotates_rigidly_with_both():
    """Three gears in a row, hands alternating; a rigid spin of all at one pitch line speed deforms neither mesh."""
    first, x1, x2 = pair((0.03, 0.05), 0.35, 0.2, 0.3, first=(0.0, 0.0, 0.0))
    second, _, x3 = pair((0.05, 0.04), 0.35, -0.2, -0.4, "-z", first=x2)
    meshes = {
        "one": replace(first, between=(("a", "gear"), ("i", "gear"))),
        "two": replace(second, between=(("i", "gear"), ("c", "gear"))),
    }
    built = train(meshes, a=(x1[:2], PINION), i=(x2[:2], WHEEL), c=(x3[:2], WHEEL))
    structure = built.structure(DOFS, {})
    assert np.count_nonzero(modes(structure).eigenvalues == 0.0) == 16
    spin = np.zeros((3, structure.size // 3 // 6, 6))
    spin[0, :, 5], spin[1, :, 5], spin[2, :, 5] = 1 / 0.03, -1 / 0.05, 1 / 0.04
    q = spin.ravel()
    assert q @ structure.stiffness @ q == pytest.approx(0.0, abs=1e-4)
