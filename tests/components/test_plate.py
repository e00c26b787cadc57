"""Plates: closed-form and Ritz frequencies, no locking, rigid modes and inertia, footprints, ports, bad input."""

import time
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
from plate_ritz import bending_frequencies, membrane_frequencies
from scipy.sparse.linalg import eigsh

from gearpath.components import DOFS, Footprint, Material, Plate
from gearpath.components.dofs import rigid_motion
from gearpath.errors import InputError

STEEL = Material(2.07e11, 0.3, 7850.0)
E, NU, G, RHO = 2.07e11, 0.3, 2.07e11 / 2.6, 7850.0
SKEW = np.linalg.qr(np.array([[1.0, 2.0, 0.5], [0.3, -1.0, 2.0], [1.0, 0.2, 0.7]]))[0]
SKEW_AXES = tuple(map(tuple, SKEW[:2]))


def plate(lengths=(0.6, 0.4), thickness=0.01, elements=(12, 8), **more):
    return Plate(STEEL, more.pop("centre", (0.0, 0.0, 0.0)), lengths, thickness, elements, **more)


def lowest(K, M, count):
    """Lowest natural frequencies, Hz; rigid-body modes as (nearly) zero."""
    shift = -1e-3 * abs(K.diagonal()).max() / abs(M.diagonal()).max() * 1e-6
    values = eigsh(K, count, M, sigma=shift, return_eigenvectors=False)
    return np.sqrt(np.maximum(np.sort(values), 0.0)) / (2 * np.pi)


def elastic(part, count):
    structure = part.structure(DOFS, {})
    return lowest(structure.stiffness, structure.mass, count + 6)[6:]


def mindlin_supported(lengths, thickness, m, n, kappa=5 / 6):
    """Hard simply supported Mindlin plate: w = W sin sin, b1 = A cos sin, b2 = B sin cos; the flexural root, Hz."""
    a, b = m * np.pi / lengths[0], n * np.pi / lengths[1]
    D, S, twist = E * thickness**3 / (12 * (1 - NU**2)), kappa * G * thickness, (1 - NU) / 2
    mixed = D * (NU + twist) * a * b
    K = np.array(
        [
            [S * (a**2 + b**2), S * a, S * b],
            [S * a, S + D * (a**2 + twist * b**2), mixed],
            [S * b, mixed, S + D * (b**2 + twist * a**2)],
        ]
    )
    M = RHO * np.diag([thickness, thickness**3 / 12, thickness**3 / 12])
    return np.sqrt(scipy.linalg.eigh(K, M, eigvals_only=True)[0]) / (2 * np.pi)


def supported(part, bending):
    """Matrices of a plate normal to z with the edges of its closed form: hard supports (or sliding in the plane)."""
    meshed = part.mesh()
    p = meshed.nodes.positions
    held = np.zeros((len(p), 6), bool)
    held[:, [0, 1, 5] if bending else [2, 3, 4]] = True
    on_x, on_y = (np.isclose(abs(p[:, k]), part.lengths[k] / 2) for k in (0, 1))
    for edge, along, turn in ((on_x, 1, 3), (on_y, 0, 4)):
        held[edge, turn if bending else along] = True
        held[edge, 2] = True
    free = np.flatnonzero(~held.ravel())
    return (matrix[free][:, free] for matrix in (meshed.nodes.stiffness, meshed.nodes.mass))


@pytest.mark.parametrize("thickness", [6e-2, 6e-3, 6e-4, 6e-5])
def test_supported_plate_converges_to_mindlins_closed_form_as_h_squared(thickness):
    """Thick or thin, the same grid makes the same small error: nothing locks."""
    exact = np.sort([mindlin_supported((0.6, 0.4), thickness, m, n) for m in (1, 2, 3) for n in (1, 2, 3)])[:4]
    errors = np.array(
        [
            lowest(*supported(plate(thickness=thickness, elements=(6 * k, 4 * k)), bending=True), 4) / exact - 1
            for k in (2, 4, 8)
        ]
    )
    orders = np.log2(errors[:-1] / errors[1:])
    assert np.all((orders > 1.9) & (orders < 2.15))
    assert np.all(abs(errors[-1]) < 4.5e-3)


def test_a_graded_grid_converges_as_well():
    """A footprint of no size draws lines through any point; here the spacing varies by a factor of 5."""
    exact = mindlin_supported((0.6, 0.4), 0.006, 1, 1)
    points = {"a": Footprint((0.13, 0.11, 0.0)), "b": Footprint((0.14, 0.115, 0.0))}
    parts = [plate(thickness=0.006, elements=(6 * k, 4 * k), footprints=points) for k in (2, 4, 8)]
    coarse, middle, fine = (lowest(*supported(part, bending=True), 1)[0] / exact - 1 for part in parts)
    assert 0 < fine < 1.5e-3
    assert fine < middle / 3 < coarse / 8


@pytest.mark.parametrize("thickness", [6e-2, 6e-4])
def test_sliding_edges_in_the_plane_have_the_frequencies_of_plane_waves(thickness):
    """u = grad(sin sin) and curl(cos cos): c k with the two speeds of plane stress."""
    k = np.sort([np.hypot(m / 0.6, n / 0.4) for m in (1, 2, 3) for n in (1, 2, 3)]) / 2
    shear = [np.hypot(m / 0.6, n / 0.4) / 2 for m in range(6) for n in range(6) if m + n]
    speeds = np.sqrt(E / (RHO * (1 - NU**2))), np.sqrt(G / RHO)
    exact = np.sort([*(speeds[0] * k), *(speeds[1] * np.array(shear))])[:5]
    errors = np.array(
        [
            lowest(*supported(plate(thickness=thickness, elements=(6 * k, 4 * k)), bending=False), 5) / exact - 1
            for k in (2, 4, 8)
        ]
    )
    orders = np.log2(errors[:-1] / errors[1:])
    assert np.all((orders > 1.8) & (orders < 2.2))
    assert np.all(abs(errors[-1]) < 5e-3)


def test_free_thick_plate_agrees_with_the_ritz_method():
    lengths, thickness = (0.6, 0.4), 0.06
    out_of_plane = bending_frequencies(STEEL, lengths, thickness, 5 / 6, 8)
    in_plane = membrane_frequencies(STEEL, lengths, 3)
    expected = np.sort([*out_of_plane, *in_plane])[:8]
    assert in_plane[0] in expected  # both kinds are among them
    errors = np.array([elastic(plate(lengths, thickness, (12 * k, 8 * k)), 8) / expected - 1 for k in (2, 4)])
    assert np.all((errors[1] > 0) & (errors[1] < 3e-3))
    assert np.all(errors[0] / errors[1] > 3.3)


def test_free_plate_in_its_plane_agrees_with_the_ritz_method():
    lengths = (0.6, 0.4)
    expected = membrane_frequencies(STEEL, lengths, 6)
    found = []
    for k in (1, 2, 4):
        nodes = plate(lengths, elements=(12 * k, 8 * k)).mesh().nodes
        kept = (6 * np.arange(len(nodes.positions))[:, None] + [0, 1, 5]).ravel()
        found.append(lowest(nodes.stiffness[kept][:, kept], nodes.mass[kept][:, kept], 9)[3:])
    errors = abs(np.array(found) / expected - 1)
    assert errors[-1].max() < 1.5e-3
    assert np.all(errors[:-1] / errors[1:] > 3.2)


@pytest.mark.parametrize("axes", [((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)), ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), SKEW_AXES])
def test_exactly_six_rigid_modes_and_exact_inertia_in_any_direction(axes):
    centre, (a, b), h = (0.3, -0.2, 0.1), (0.6, 0.4), 0.03
    feet = {"foot": Footprint(tuple(np.array(centre) + 0.2 * np.array(axes[0])), (0.05, 0.08))}
    structure = plate((a, b), h, centre=centre, axes=axes, footprints=feet, loss_factor=0.01).structure(DOFS, {})
    K, M, R = structure.stiffness, structure.mass, structure.rigid_modes
    assert abs(K @ R).max() < 1e-13 * (abs(K) @ abs(R)).max()
    values = np.sort(eigsh(K, 8, M, sigma=-1e5, return_eigenvectors=False))
    assert abs(values[:6]).max() < 1e-9 * values[6]
    mass, turn = RHO * a * b * h, np.array([*axes, np.cross(*axes)])
    inertia = turn.T @ np.diag([b**2 + h**2, a**2 + h**2, a**2 + b**2]) @ turn * mass / 12
    expected = scipy.linalg.block_diag(mass * np.eye(3), inertia)
    np.testing.assert_allclose(R.T @ (M @ R), expected, rtol=1e-11, atol=1e-11 * mass)
    assert (structure.loss_factor, structure.modal_damping, structure.size) == (0.01, 0.0, len(R))


def test_frequencies_do_not_depend_on_the_direction():
    np.testing.assert_allclose(elastic(plate(axes=SKEW_AXES), 6), elastic(plate(), 6), rtol=1e-6)


def test_a_footprint_is_the_plate_with_its_nodes_held_together():
    """The same frequencies by another way: the rigid patch as constraints, solved on their null space."""
    foot = {"foot": Footprint((0.05, -0.05, 0.0), (0.1, 0.08))}
    part = plate((0.4, 0.3), 0.01, (6, 5), footprints=foot, footprint_elements=2)
    lines = part.mesh().lines
    x, y = (grid.ravel() for grid in np.meshgrid(*lines))
    inside = (abs(x - 0.05) < 0.05 + 1e-9) & (abs(y + 0.05) < 0.04 + 1e-9)
    assert inside.sum() == 9
    points = {f"{k}": Footprint((p, q, 0.0)) for k, (p, q) in enumerate(zip(x, y))}
    loose = plate((0.4, 0.3), 0.01, (6, 5), footprints=points)
    nodes = loose.mesh().nodes
    order = [nodes.places[f"{k}"].node for k in range(len(x))]
    np.testing.assert_allclose(nodes.positions[order][:, :2], np.stack([x, y], axis=1), atol=1e-12)
    first, *others = [order[k] for k in np.flatnonzero(inside)]
    rows = []
    for node in others:
        row = np.zeros((6, nodes.size))
        row[:, 6 * node : 6 * node + 6] = np.eye(6)
        row[:, 6 * first : 6 * first + 6] = -rigid_motion(nodes.positions[node] - nodes.positions[first])
        rows.append(row)
    N = scipy.linalg.null_space(np.vstack(rows))
    K, M = (N.T @ matrix.toarray() @ N for matrix in (nodes.stiffness, nodes.mass))
    expected = np.sqrt(scipy.linalg.eigh(K, M, eigvals_only=True)[6:16]) / (2 * np.pi)
    np.testing.assert_allclose(elastic(part, 10), expected, rtol=1e-6)


def test_a_plate_that_is_all_footprint_is_a_rigid_body():
    part = plate((0.6, 0.4), 0.03, (5, 5), footprints={"all": Footprint((0.0, 0.0, 0.0), (0.6, 0.4))})
    structure = part.structure(DOFS, {"p": "all"})
    mass = RHO * 0.6 * 0.4 * 0.03
    inertia = mass / 12 * np.array([0.4**2 + 0.03**2, 0.6**2 + 0.03**2, 0.6**2 + 0.4**2])
    np.testing.assert_allclose(structure.mass.toarray(), np.diag([*[mass] * 3, *inertia]), rtol=1e-11, atol=1e-12)
    assert abs(structure.stiffness).max() < 1e-2  # N/m and N m/rad; an element has 1e9
    np.testing.assert_allclose(structure.ports["p"], np.eye(6), atol=1e-15)


SPOTS = {
    "foot": "foot",
    "surface": "surface",
    "inside": "inside",
    "point": (0.4111, -0.33, 0.1),
    "off_the_middle": (0.2, -0.12, 0.104),
}
FEET = {
    "foot": Footprint((0.4, -0.2, 0.1), (0.05, 0.08)),
    "surface": Footprint((0.2, -0.1, 0.105)),
    "inside": Footprint((0.41, -0.19, 0.1)),
}


@pytest.mark.parametrize("as_probes", [False, True])
def test_ports_and_probes_follow_rigid_motion_exactly(as_probes):
    part = plate(centre=(0.3, -0.2, 0.1), footprints=FEET)
    structure = part.structure(DOFS, {} if as_probes else SPOTS, SPOTS if as_probes else None)
    for name, spot in SPOTS.items():
        place = FEET[spot].centre if isinstance(spot, str) else spot
        expected = rigid_motion(np.subtract(place, (0.3, -0.2, 0.1)))
        np.testing.assert_allclose(structure.ports[name] @ structure.rigid_modes, expected, atol=1e-12)


def test_ports_draw_lines_and_probes_do_not():
    part, spot = plate(), {"p": (0.111, 0.017, 0.0)}
    assert part.structure(DOFS, {}, spot).size == part.structure(DOFS, {}).size == 13 * 9 * 6
    drawn = part.structure(DOFS, spot)
    assert drawn.size == 14 * 10 * 6
    assert np.all(np.count_nonzero(drawn.ports["p"], axis=1) == 1)  # a node of its own


def test_a_probe_reads_a_curved_surface_to_the_second_order():
    """w = 1 + x^2 + y^2 on the nodes: exact at a node, between nodes within (hx^2 + hy^2) / 4."""
    part = plate()
    p = part.mesh().nodes.positions
    q = np.zeros((len(p), 6))
    q[:, 2] = 1 + p[:, 0] ** 2 + p[:, 1] ** 2
    spots = {"node": (0.1, 0.05, 0.0), "between": (0.11, 0.017, 0.0), "middle": (0.125, 0.025, 0.0)}
    ports = part.structure(DOFS, {}, spots).ports
    errors = {name: ports[name][2] @ q.ravel() - (1 + spots[name][0] ** 2 + spots[name][1] ** 2) for name in spots}
    assert errors["node"] == pytest.approx(0.0, abs=1e-14)
    assert errors["middle"] == pytest.approx((0.05**2 + 0.05**2) / 4, rel=1e-9)
    assert 0 < errors["between"] < errors["middle"]


def test_inactive_degrees_of_freedom_read_zero():
    structure = plate().structure(("uz", "rx"), {"p": (0.1, 0.0, 0.0)})
    assert [dof for dof, row in zip(DOFS, structure.ports["p"]) if row.any()] == ["uz", "rx"]


def test_fifty_thousand_coordinates_are_assembled_in_seconds():
    feet = {"a": Footprint((0.1, 0.0, 0.0), (0.0127, 0.0127))}
    start = time.perf_counter()
    structure = plate(elements=(100, 80), footprints=feet).structure(DOFS, {"a": "a"})
    assert structure.size > 50_000
    assert time.perf_counter() - start < 20.0  # measured 2 s on one busy core


@pytest.mark.parametrize(
    ("change", "ports", "message"),
    [
        ({"axes": ((1.0, 0.0, 0.0), (0.5, 1.0, 0.0))}, {}, "perpendicular"),
        ({"footprints": {"a": Footprint((0.3, 0.0, 0.0), (0.02, 0.02))}}, {}, "'a'.*beyond the plate"),
        ({"footprints": {"a": Footprint((0.0, 0.0, 0.1))}}, {}, "'a'.*not on the plate"),
        ({"footprints": {"a": Footprint((0.0, 0.0, 0.0), (-0.02, 0.02))}}, {}, "'a'.*negative"),
        (
            {"footprints": {"a": Footprint((0.0, 0.0, 0.0), (0.1, 0.1)), "b": Footprint((0.1, 0.0, 0.0), (0.1, 0.1))}},
            {},
            "'a' and 'b'.*touch",
        ),
        ({}, {"p": (0.0, 0.21, 0.0)}, "not on the plate"),
        ({}, {"p": (float("nan"), 0.0, 0.0)}, "not on the plate"),
        ({"footprints": {"a": Footprint((0.0, 0.0, 0.0))}}, {"p": "b"}, "'p'.*no footprint 'b'.*a"),
    ],
)
def test_bad_input_is_refused_by_name(change, ports, message):
    with pytest.raises(InputError, match=message):
        replace(plate(), **change).structure(DOFS, ports)


def test_equal_plates_have_equal_hashes():
    one, two = (plate(footprints=dict(FEET), centre=(0.3, -0.2, 0.1)) for _ in range(2))
    assert one == two
    assert hash(one) == hash(two)
