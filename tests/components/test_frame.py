"""Frames: skew beams against closed forms, rigid arms and bodies, exact inertia, joined plates, bad input."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
from scipy.sparse.linalg import eigsh

from gearpath.components import DOFS, BarSection, Footprint, Frame, FrameBeam, Material, Plate, RigidBody
from gearpath.components.dofs import rigid_motion
from gearpath.errors import InputError

STEEL = Material(2.07e11, 0.3, 7850.0)
E, G, RHO, KAPPA = 2.07e11, 2.07e11 / 2.6, 7850.0, 5 / 6
ALONG, ACROSS = np.array([2.0, -1.0, 2.0]) / 3, np.array([1.0, 2.0, 0.0]) / np.sqrt(5)  # perpendicular
THIRD = np.cross(ALONG, ACROSS)
START, LENGTH = np.array([0.1, 0.2, -0.3]), 0.4
WIDE, FLAT = 0.03, 0.012  # along ACROSS and THIRD
BAR = BarSection.rectangle(WIDE, FLAT)


def beam(*between, elements=3, section=BAR, orientation=tuple(ACROSS), kind="timoshenko"):
    return FrameBeam(between, STEEL, section, KAPPA, elements, orientation, kind)


def at(distance):
    return tuple(START + distance * ALONG)


def single(elements=3, **more):
    return Frame({"a": at(0.0), "b": at(LENGTH)}, {"bar": beam("a", "b", elements=elements, **more)})


def tip_flexibility(frame, clamped="a", tip="b"):
    """Motion of one port (6 x 6) per force on it, another one clamped."""
    structure = frame.structure(DOFS, {"clamp": clamped, "tip": tip})
    held = structure.ports["clamp"].any(axis=0)
    K, rows = structure.stiffness.toarray()[np.ix_(~held, ~held)], structure.ports["tip"][:, ~held]
    return rows @ np.linalg.solve(K, rows.T)


def closed_form():
    """The same of a cantilever along ALONG: bending and shear both ways, tension, torsion."""
    turn = scipy.linalg.block_diag(*[np.array([ACROSS, THIRD, ALONG])] * 2)
    area, L = WIDE * FLAT, LENGTH
    F = np.zeros((6, 6))
    for u, theta, sign, moment in ((0, 4, 1, FLAT * WIDE**3 / 12), (1, 3, -1, WIDE * FLAT**3 / 12)):
        F[u, u] = L**3 / (3 * E * moment) + L / (KAPPA * G * area)
        F[u, theta] = F[theta, u] = sign * L**2 / (2 * E * moment)
        F[theta, theta] = L / (E * moment)
    F[2, 2] = L / (E * area)
    F[5, 5] = L / (G * BAR.torsion_constant)
    return turn.T @ F @ turn


@pytest.mark.parametrize("elements", [1, 4])
def test_a_skew_cantilever_has_the_exact_flexibility(elements):
    expected = closed_form()
    np.testing.assert_allclose(tip_flexibility(single(elements)), expected, rtol=1e-7, atol=1e-9 * abs(expected).max())


def test_the_orientation_turns_the_section():
    turned = BarSection.rectangle(FLAT, WIDE)
    slanted = tuple(THIRD + 0.7 * ALONG)  # its part along the beam does not count
    expected = tip_flexibility(single())
    np.testing.assert_allclose(
        tip_flexibility(single(section=turned, orientation=slanted)), expected, rtol=1e-6, atol=1e-12
    )


def test_a_round_section_needs_no_orientation():
    round_bar = BarSection.round(0.02, 0.01)
    expected = tip_flexibility(single(section=round_bar))
    np.testing.assert_allclose(
        tip_flexibility(single(section=round_bar, orientation=None)), expected, rtol=1e-6, atol=1e-12
    )
    assert round_bar.torsion_constant == pytest.approx(sum(round_bar.area_moments), rel=1e-14)


@pytest.mark.parametrize(("ratio", "beta"), [(1.0, 0.1406), (1.5, 0.196), (2.0, 0.229), (3.0, 0.263), (10.0, 0.312)])
def test_torsion_constant_of_rectangles(ratio, beta):
    """Timoshenko and Goodier, Theory of Elasticity, table of art. 109: J = beta a b^3."""
    assert BarSection.rectangle(ratio, 1.0).torsion_constant == pytest.approx(beta * ratio, rel=3e-3)
    assert BarSection.rectangle(1.0, ratio).torsion_constant == pytest.approx(beta * ratio, rel=3e-3)


def test_a_rigid_arm_carries_the_force_to_the_tip():
    """F_arm = T F T^T with the lever T; two beams in line, joined by a link, are one."""
    arm = np.array([0.05, -0.02, 0.08])
    frame = Frame(
        {"a": at(0.0), "m": at(0.15), "m2": at(0.15), "b": at(LENGTH), "arm": tuple(np.add(at(LENGTH), arm))},
        {"one": beam("a", "m"), "two": beam("m2", "b")},
        links=(("m", "m2"), ("arm", "b")),
    )
    T = rigid_motion(arm)
    expected = T @ closed_form() @ T.T
    np.testing.assert_allclose(tip_flexibility(frame, tip="arm"), expected, rtol=1e-6, atol=1e-8 * abs(expected).max())


def elastic(frame, count):
    structure = frame.structure(DOFS, {})
    values = np.sort(eigsh(structure.stiffness, count + 6, structure.mass, sigma=-1e4, return_eigenvectors=False))
    assert abs(values[:6]).max() < 1e-6 * values[6]
    return np.sqrt(values[6:]) / (2 * np.pi)


def test_a_free_slender_skew_beam_has_the_closed_form_frequencies_and_six_rigid_modes():
    beta_l = np.array([4.730040745, 7.853204624])
    section = BarSection.rectangle(0.004, 0.0025)
    expected = [
        (beta_l / LENGTH) ** 2 * np.sqrt(E * moment / (RHO * section.area)) / (2 * np.pi)
        for moment in section.area_moments
    ]
    found = elastic(single(24, section=section, kind="euler"), 4)
    np.testing.assert_allclose(found, np.sort(np.ravel(expected)), rtol=1e-5)


def test_torsional_frequencies_of_a_free_bar():
    """n / (2 L) sqrt(G J / (rho I_p)), found among the modes."""
    speed = np.sqrt(G * BAR.torsion_constant / (RHO * sum(BAR.area_moments)))
    found = elastic(single(32), 12)
    assert abs(found / (speed / (2 * LENGTH)) - 1).min() < 5e-4


def box(**more):
    """A plate on two footprints with two bars of different length, a rigid arm and a body at its end."""
    feet = {"left": Footprint((-0.1, 0.0, 0.0), (0.02, 0.02)), "right": Footprint((0.1, 0.03, 0.004))}
    plate = Plate(STEEL, (0.0, 0.0, 0.0), (0.3, 0.2), 0.008, (6, 4), footprints=feet, footprint_elements=2)
    parts = {
        "nodes": {"top": (-0.1, 0.0, 0.25), "far": (0.2, 0.1, 0.3), "arm": (-0.1, 0.05, 0.25)},
        "beams": {"up": beam("base.left", "top", orientation=None), "off": beam("base.right", "far", orientation=None)},
        "plates": {"base": plate},
        "links": (("arm", "top"),),
        "bodies": {"arm": RigidBody(0.7, {"xx": 1e-3, "yy": 2e-3, "zz": 3e-3, "xy": 2e-4}, (-0.1, 0.06, 0.27))},
    }
    return Frame(**{**parts, **more})


def test_mass_and_inertia_of_a_frame_are_those_of_its_parts():
    structure = box().structure(DOFS, {})
    R, M = structure.rigid_modes, structure.mass
    total = np.zeros((6, 6))
    centre = box().mesh().positions.mean(axis=0)

    def add(mass, inertia, position):
        T = rigid_motion(np.subtract(position, centre))
        total[:] += T.T @ scipy.linalg.block_diag(mass * np.eye(3), inertia) @ T

    m = RHO * 0.3 * 0.2 * 0.008
    add(m, m / 12 * np.diag([0.2**2 + 0.008**2, 0.3**2 + 0.008**2, 0.3**2 + 0.2**2]), (0, 0, 0))
    body = np.array([[1e-3, 2e-4, 0], [2e-4, 2e-3, 0], [0, 0, 3e-3]])
    add(0.7, body, (-0.1, 0.06, 0.27))
    for start, end in (((-0.1, 0, 0), (-0.1, 0, 0.25)), ((0.1, 0.03, 0.004), (0.2, 0.1, 0.3))):
        vector = np.subtract(end, start)
        length = np.linalg.norm(vector)
        e = vector / length
        axis = np.eye(3)[np.argmin(abs(e))]
        one = axis - e * (e @ axis)
        one /= np.linalg.norm(one)
        two = np.cross(e, one)
        m = RHO * BAR.area * length
        first, second = BAR.area_moments
        inertia = m * length**2 / 12 * (np.eye(3) - np.outer(e, e))
        inertia += (
            RHO
            * length
            * (first * np.outer(two, two) + second * np.outer(one, one) + (first + second) * np.outer(e, e))
        )
        add(m, inertia, np.add(start, end) / 2)
    np.testing.assert_allclose(R.T @ (M @ R), total, rtol=1e-9, atol=1e-12)
    K = structure.stiffness
    assert abs(K @ R).max() < 1e-13 * (abs(K) @ abs(R)).max()
    values = np.sort(eigsh(K, 8, M, sigma=-1e4, return_eigenvectors=False))
    assert abs(values[:6]).max() < 1e-8 * values[6]


def test_a_joined_beam_end_moves_with_its_footprint():
    structure = box().structure(DOFS, {"foot": "base.left", "edge": "base.right", "arm": "arm", "top": "top"})
    arm = rigid_motion(np.array([0.0, 0.05, 0.0])) @ structure.ports["top"]
    np.testing.assert_allclose(structure.ports["arm"], arm, atol=1e-15)
    assert np.linalg.matrix_rank(structure.ports["foot"]) == np.linalg.matrix_rank(structure.ports["edge"]) == 6


def test_a_beam_on_a_rigid_plate_is_a_beam_with_a_rigid_body():
    """The whole plate one footprint, against the closed inertia of a brick fixed to the beam's end."""
    size, h = (0.06, 0.05), 0.01
    plate = Plate(STEEL, at(0.0), size, h, (2, 2), footprints={"all": Footprint(at(0.0), size)}, footprint_elements=2)
    m = RHO * size[0] * size[1] * h
    inertia = {
        "xx": m / 12 * (size[1] ** 2 + h**2),
        "yy": m / 12 * (size[0] ** 2 + h**2),
        "zz": m / 12 * (size[0] ** 2 + size[1] ** 2),
    }
    with_plate = Frame({"b": at(LENGTH)}, {"bar": beam("base.all", "b")}, {"base": plate})
    with_body = replace(single(), bodies={"a": RigidBody(m, inertia, at(0.0))})
    np.testing.assert_allclose(elastic(with_plate, 6), elastic(with_body, 6), rtol=1e-6)


def test_two_half_plates_linked_along_their_edge_bend_like_one():
    """Rigid lines as footprints: two strips joined on a whole edge, a static cantilever without Poisson effects."""
    soft = Material(2.07e11, 0.0, 7850.0)
    ends = {"in": Footprint((-0.1, 0.0, 0.0), (0.0, 0.05)), "out": Footprint((0.1, 0.0, 0.0), (0.0, 0.05))}
    half = Plate(soft, (0.0, 0.0, 0.0), (0.2, 0.05), 0.004, (16, 4), footprints=ends)
    other = replace(
        half,
        centre=(0.2, 0.0, 0.0),
        footprints={name: Footprint((foot.centre[0] + 0.2, 0.0, 0.0), foot.size) for name, foot in ends.items()},
    )
    frame = Frame({}, {}, {"one": half, "two": other}, links=(("one.out", "two.in"),))
    F = tip_flexibility(frame, "one.in", "two.out")
    moment, area, shear = 0.05 * 0.004**3 / 12, 0.05 * 0.004, 2.07e11 / 2
    assert F[2, 2] == pytest.approx(0.4**3 / (3 * E * moment) + 0.4 / (KAPPA * shear * area), rel=1e-3)
    assert F[0, 0] == pytest.approx(0.4 / (E * area), rel=1e-9)
    in_plane = 0.004 * 0.05**3 / 12
    assert F[1, 1] == pytest.approx(0.4**3 / (3 * E * in_plane) + 0.4 / (KAPPA * shear * area), rel=5e-3)
    assert F[5, 5] == pytest.approx(0.4 / (E * in_plane), rel=1e-3)


def test_damping_and_active_degrees_of_freedom_reach_the_structure():
    structure = box(loss_factor=0.02, modal_damping=0.01).structure(("uz",), {"p": "top"}, {"s": "far"})
    assert (structure.loss_factor, structure.modal_damping) == (0.02, 0.01)
    assert [dof for dof, row in zip(DOFS, structure.ports["s"]) if row.any()] == ["uz"]
    assert set(structure.ports) == {"p", "s"}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"nodes": {"a": at(0.0)}}, "beam 'bar'.*no place 'b'.*it has a"),
        ({"nodes": {"a": at(0.0), "b": at(0.0)}}, "beam 'bar'.*same point"),
        ({"beams": {"bar": beam("a", "b", orientation=tuple(ALONG))}}, "beam 'bar'.*along the beam"),
        ({"nodes": {"a": at(0.0), "b": at(0.4), "c": at(0.5)}}, "nothing joins node 'a' to node 'c'"),
        ({"links": (("a", "x"),)}, "link.*no place 'x'"),
        ({"bodies": {"x": RigidBody(1.0, {"xx": 1.0, "yy": 1.0, "zz": 1.0})}}, "body.*no place 'x'"),
        ({"nodes": {}, "beams": {}}, "neither beams nor plates"),
        ({"plates": {"p": Plate(STEEL, at(0.0), (0.1, 0.1), 0.01, (2, 2))}}, "nothing joins .* plate 'p'"),
        ({"plates": {"p": Plate(STEEL, at(0.0), (0.1, 0.1), 0.01, (2, 2), loss_factor=0.1)}}, "plate 'p'.*damping"),
    ],
)
def test_bad_frames_are_refused_by_name(change, message):
    with pytest.raises(InputError, match=message):
        replace(single(), **change).structure(DOFS, {})


def test_an_unknown_port_is_refused():
    with pytest.raises(InputError, match=r"port 'p'.*no place 'base\.middle'.*base\.left"):
        box().structure(DOFS, {"p": "base.middle"})


def test_equal_frames_have_equal_hashes():
    assert box() == box()
    assert hash(box()) == hash(box())
