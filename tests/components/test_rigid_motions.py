"""Which motions a stiffness matrix leaves free: closed forms, printed digits, soft supports; points without mass."""

import functools

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse
import scipy.sparse.linalg

from gearpath.components import Matrices
from gearpath.components.free_matrices import free_matrices
from gearpath.components.rigid_motions import rigid_motions, rounding_of
from gearpath.errors import InputError
from gearpath.network.ports import solve_component

EI, LENGTH, MASS = np.pi * 7e3, 1.2345678, 8.0  # N m^2, m, kg/m: no round numbers among the entries


def beam(count):
    """Euler beam of `count` elements, uy and rx of each node: K sparse, and a mass matrix without rotary inertia."""
    h = LENGTH / count
    part = np.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h**2, -6 * h, 2 * h**2]])
    part = np.vstack([part, [[-12, -6 * h, 12, -6 * h], [6 * h, 2 * h**2, -6 * h, 4 * h**2]]]) * EI / h**3
    first = 2 * np.arange(count)[:, None] + np.arange(4)
    rows, columns = np.repeat(first, 4, axis=1).ravel(), np.tile(first, (1, 4)).ravel()
    size = 2 * count + 2
    K = scipy.sparse.csc_array((np.tile(part.ravel(), count), (rows, columns)), shape=(size, size))
    mass = np.tile([MASS * h, 0.0], count + 1)
    mass[[0, -2]] /= 2.0
    return K, scipy.sparse.csc_array(scipy.sparse.diags_array(mass))


def printed(matrix, digits):
    out = matrix.copy()
    out.data = np.array([float(f"{value:.{digits - 1}e}") for value in matrix.data])
    return out


@functools.cache
def grid(layers):
    """A block of equal springs in x, y and z between neighbours and across the faces: free, six rigid motions."""
    points = np.array([(x, y, z) for x in range(6) for y in range(5) for z in range(layers)], float)
    i, k = np.nonzero(np.triu(abs(points[:, None] - points).max(axis=2) == 1.0))
    n = (points[k] - points[i]) / np.linalg.norm(points[k] - points[i], axis=1)[:, None]
    stretch = scipy.sparse.lil_array((len(i), points.size))
    for axis in range(3):
        stretch[np.arange(len(i)), 3 * i + axis] = -n[:, axis]
        stretch[np.arange(len(i)), 3 * k + axis] = n[:, axis]
    return scipy.sparse.csc_array(1.234567890123e8 * (stretch.T @ stretch.tocsr())), points


@pytest.mark.parametrize("digits", [7, 8, 10, 14, 17])
@pytest.mark.parametrize("layers", [2, 5])
def test_a_free_block_has_six_rigid_motions_whatever_its_digits(layers, digits):
    """They are the translations and rotations of its points, to the digits of the matrix."""
    K, points = grid(layers)
    R = rigid_motions(printed(K, digits))
    turns = [np.cross(axis, points).ravel() for axis in np.eye(3)]
    exact = np.linalg.qr(np.array([*np.tile(np.eye(3), (1, len(points))), *turns]).T)[0]
    assert R.shape[1] == 6
    off = R - exact @ (exact.T @ R)
    assert np.linalg.norm(off) < max(1e-9, 100 * 10.0**-digits) * np.linalg.norm(R)


def test_a_free_block_in_single_precision():
    K, _ = grid(4)
    single = K.astype(np.float32).astype(float)
    assert abs(single - K).max() > 0.0
    assert rigid_motions(single).shape[1] == rigid_motions(single.toarray()).shape[1] == 6


@pytest.mark.parametrize("layers", [2, 5])
def test_soft_springs_to_the_ground_leave_nothing_rigid(layers):
    """1e-4 of the block's own stiffness at three corners, printed with ten digits: held, not free."""
    K, points = grid(layers)
    spring = np.zeros(points.shape)
    spring[[0, len(points) - 1, 5 * layers]] = 1e4
    held = scipy.sparse.csc_array(K + scipy.sparse.diags_array(spring.ravel()))
    assert rigid_motions(printed(held, 10)).shape[1] == 0
    assert rigid_motions(printed(K, 10)).shape[1] == 6


@pytest.mark.parametrize("count", [5, 350, 1500])
def test_finely_divided_beams_keep_their_elastic_motions(count):
    """The softest bending motion meets 1e-12 of the diagonal with 1500 elements, and still it is no rigid one."""
    K, _ = beam(count)
    R = rigid_motions(K)
    assert R.shape[1] == 2
    x = np.linspace(0.0, LENGTH, count + 1)
    exact = np.zeros((2 * count + 2, 2))
    exact[::2, 0], exact[::2, 1], exact[1::2, 1] = 1.0, x, 1.0
    basis = np.linalg.qr(exact)[0]
    assert np.linalg.norm(R - basis @ (basis.T @ R)) < 1e-5 * np.linalg.norm(R)


def test_many_loose_parts_of_a_sparse_structure_are_all_found():
    """20 chains of 15 points: as many rigid motions; 60 of them are no machine part."""
    chain = 1.23456e8 * (2 * np.eye(15) - np.eye(15, k=1) - np.eye(15, k=-1))
    chain[0, 0] = chain[-1, -1] = 1.23456e8
    K = scipy.sparse.csc_array(scipy.sparse.kron(np.diag(1.0 + np.arange(20.0)), chain))
    R = rigid_motions(K)
    assert R.shape[1] == 20
    assert abs(K @ R).max() < 1e-12 * (abs(K) @ abs(R)).max()
    with pytest.raises(InputError, match="do not deform it; connect its parts"):
        rigid_motions(scipy.sparse.csc_array(scipy.sparse.kron(np.diag(1.0 + np.arange(60.0)), chain)))


def test_digits_that_cannot_tell_are_refused():
    K, _ = beam(350)
    with pytest.raises(InputError, match=r"stiffness: \d+ motions beside \d+ rigid ones .* export it with more digits"):
        rigid_motions(printed(K, 9))


@pytest.mark.parametrize("dense", [True, False])
def test_negative_stiffness_is_refused(dense):
    K, _ = grid(5)
    pull = scipy.sparse.coo_array(([K[0, 0]] * 2, ([0, 40], [40, 0])), shape=K.shape)
    K = scipy.sparse.csc_array(K - 1.5 * pull)
    with pytest.raises(InputError, match="stiffness: is negative in"):
        rigid_motions(K.toarray() if dense else K)


@pytest.mark.parametrize(
    ("digits", "rounding"), [(3, 1e-15), (6, 3e-6), (7, 3e-7), (10, 3e-10), (14, 3e-14), (17, 1e-15)]
)
def test_how_an_array_was_rounded(digits, rounding):
    values = np.array([[np.pi, -np.e * 1e7], [np.sqrt(2.0) * 1e-5, 0.0]])
    shown = np.array([[float(f"{v:.{digits - 1}e}") for v in row] for row in values])
    assert rounding_of(shown) == pytest.approx(rounding)
    assert rounding_of(1e-3 * shown) == pytest.approx(rounding)  # mm and N as m and N
    single = values.astype(np.float32).astype(float)
    assert rounding_of(single) == rounding_of(1e3 * single) == 3e-8


def test_a_small_mass_does_not_make_a_held_chain_free():
    """20 masses on springs of 1e9 N/m, held at 20 Hz; one mass of 1e-9 kg puts the highest frequency at 2e8 Hz."""
    K = 1e9 * (2 * np.eye(20) - np.eye(20, k=1) - np.eye(20, k=-1))
    K[0, 0] = 1e9 + 2.0 * (2 * np.pi * 20.0) ** 2
    K[-1, -1] = 1e9
    M = 0.1 * np.eye(20)
    M[5, 5] = 1e-9
    assert free_matrices(M, K).rigid_modes.shape[1] == 0
    K[0, 0] = 1e9
    R = free_matrices(M, K).rigid_modes
    np.testing.assert_allclose(abs(R), np.full((20, 1), 1.0 / np.sqrt(np.trace(M))), rtol=1e-9)


def test_sparse_and_free_needs_its_digits():
    """The resistance of rounded entries cannot be taken out of a sparse matrix; dense ones lose it."""
    K, _ = grid(5)
    M = scipy.sparse.csc_array(scipy.sparse.eye_array(K.shape[0]))
    assert free_matrices(M, printed(K, 14)).rigid_modes.shape[1] == 6
    with pytest.raises(InputError, match="digits are too few to reduce a free structure of 450 coordinates"):
        free_matrices(M, printed(K, 10))
    made = free_matrices(M.toarray(), printed(K, 10).toarray())
    assert abs(made.stiffness @ made.rigid_modes).max() < 1e-13 * (abs(made.stiffness) @ abs(made.rigid_modes)).max()


def test_a_motion_without_mass_and_stiffness_is_refused():
    K = scipy.sparse.csc_array(np.diag([1e6, 0.0, 2e6]))
    M = scipy.sparse.csc_array(np.diag([1.0, 0.0, 1.0]))
    with pytest.raises(InputError, match="mass: coordinate 1 has neither mass nor stiffness"):
        free_matrices(M, K)


@pytest.mark.parametrize(("dense", "tolerance"), [(True, 1e-6), (False, 5e-6)])
@pytest.mark.parametrize("count", [40, 310])
def test_a_beam_without_rotary_inertia_at_ports_that_turn(count, dense, tolerance):
    """Lumped masses, forces and moments at both ends, against the dynamic stiffness solved at once."""
    K, M = beam(count)
    last, eta = 2 * count + 1, 0.02
    ends = [0, 1, last - 1, last]
    made = free_matrices(*(m.toarray() if dense else m for m in (M, K)), ends)
    ports = {"a": {"uy": 0, "rx": 1}, "b": {"uy": last - 1, "rx": last}}
    component = Matrices(made.mass, made.stiffness, made.rigid_modes, ports, {}, 0.0, eta, made.motion)
    assert not dense or len(made.mass) == count + 3  # a mass at each node, and the turning of both ends
    structure, basis = solve_component(component, ("uy", "rx"), (("a", "a"), ("b", "b")), (), 3000.0, None)
    L = np.vstack([structure.ports[name][[1, 3]] for name in ("a", "b")]) @ basis.shapes
    assert dense or len(basis.eigenvalues) < 60
    for w in 2 * np.pi * np.array([400.0, 1100.0, 2500.0]):
        found = (L / ((1 + 1j * eta) * basis.eigenvalues - w**2)) @ L.T
        unit = np.zeros((last + 1, 4), complex)
        unit[ends, range(4)] = 1.0
        exact = scipy.sparse.linalg.splu(scipy.sparse.csc_array((1 + 1j * eta) * K - w**2 * M)).solve(unit)[ends]
        size = np.sqrt(abs(np.diag(exact)))
        assert (abs(found - exact) <= tolerance * np.outer(size, size)).all()


def test_ports_without_mass_bear_many_vectors():
    """All vectors that are asked for, and none drowns in rounding."""
    K, M = beam(310)
    made = free_matrices(M, K, [0, 1])
    component = Matrices(made.mass, made.stiffness, made.rigid_modes, {"a": {"uy": 0, "rx": 1}})
    _, basis = solve_component(component, ("uy", "rx"), (("a", "a"),), (), 3000.0, 120)
    assert len(basis.eigenvalues) == 122


def cantilever(count, free=0):
    """K and M of a steel beam of 1 m x 20 mm in Euler elements, clamped or (free=1) free; its first frequency, Hz."""
    E, rho, d = 2.07e11, 7850.0, 0.02
    second, area, h = np.pi * d**4 / 64, np.pi * d**2 / 4, 1.0 / count
    k = np.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h]])
    k = np.vstack([k, [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]]) * E * second / h**3
    m = np.array([[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h]])
    m = np.vstack([m, [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h]]) * rho * area * h / 420
    n = 2 * (count + 1)
    K, M = np.zeros((n, n)), np.zeros((n, n))
    for e in range(count):
        part = slice(2 * e, 2 * e + 4)
        K[part, part] += k
        M[part, part] += m
    kept = slice(2 * (1 - free), None)
    return K[kept, kept], M[kept, kept], 3.5160 / (2 * np.pi) * np.sqrt(E * second / (rho * area))


def few_digits(K, digits):
    return printed(scipy.sparse.csc_array(K), digits).toarray()


def test_rounding_that_hides_a_soft_motion_asks_for_the_number():
    """A slender beam resists its first bending less than the entries are rounded: held or free is the user's word."""
    K, M, first = cantilever(100)
    rounded = few_digits(K, 9)
    with pytest.raises(InputError, match=r"do not tell whether 1 motions of up to 14 Hz are rigid; give their number"):
        free_matrices(M, rounded)
    held = free_matrices(M, rounded, rigid=0)
    lowest = scipy.linalg.eigh(held.stiffness, held.mass, eigvals_only=True)[0]
    assert np.sqrt(lowest) / (2 * np.pi) == pytest.approx(first, rel=1e-3)
    K, M, _ = cantilever(80, free=1)
    with pytest.raises(InputError, match="do not tell whether 3 motions"):
        free_matrices(M, few_digits(K, 7))
    made = free_matrices(M, few_digits(K, 7), rigid=2)
    assert made.rigid_modes.shape[1] == 2
    with pytest.raises(InputError, match="rigid_motions: 3 is given, but the stiffness resists all but 2 motions"):
        free_matrices(M, K, rigid=3)


def test_a_given_number_is_obeyed_where_the_digits_do_not_tell():
    """Also of motions between rigid and resisted, which are refused without it."""
    K, M, first = cantilever(100)
    few = few_digits(K, 7)
    with pytest.raises(InputError, match=r"meet hardly more resistance .* as rigid_motions"):
        free_matrices(M, few)
    held = free_matrices(M, few, rigid=0)
    assert held.rigid_modes.shape[1] == 0
    np.testing.assert_array_equal(held.stiffness, few)
    assert free_matrices(M, few, rigid=3).rigid_modes.shape[1] == 3  # the third meets little more than rounding
    free, inertia, _ = cantilever(100, free=1)
    made = free_matrices(inertia, few_digits(free, 7), rigid=2)
    frequencies = np.sqrt(scipy.linalg.eigh(made.stiffness, made.mass, eigvals_only=True)[2:4]) / (2 * np.pi)
    assert frequencies[0] == pytest.approx(6.3635 * first, rel=2e-3)  # 22.37 / 3.516: free and clamped, Euler


@pytest.mark.parametrize(("free", "digits", "given"), [(1, 17, 0), (1, 17, 1), (1, 9, 0), (0, 17, 1), (0, 10, 1)])
def test_a_given_number_that_the_stiffness_contradicts(free, digits, given):
    K, M, _ = cantilever(100, free)
    with pytest.raises(InputError, match=rf"rigid_motions: {given} is given, but .* give "):
        free_matrices(M, K if digits == 17 else few_digits(K, digits), rigid=given)


def test_a_soft_structure_of_round_entries_is_not_free_without_a_question():
    """A clamped chain of beams of EI / h^3 = 1234567 N/m, 0.06 Hz: its entries have seven digits, and are exact."""
    unit = np.array([[12.0, 6.0, -12.0, 6.0], [6.0, 4.0, -6.0, 2.0], [-12.0, -6.0, 12.0, -6.0], [6.0, 2.0, -6.0, 4.0]])
    K, M = np.zeros((202, 202)), np.diag(np.tile([1.0, 0.05], 101))
    for k in range(100):
        K[2 * k : 2 * k + 4, 2 * k : 2 * k + 4] += 1234567.0 * unit
    assert free_matrices(M, K).rigid_modes.shape[1] == 2
    K, M = K[2:, 2:], M[2:, 2:]
    with pytest.raises(InputError, match=r"do not tell whether 1 motions of up to 0\.062 Hz are rigid"):
        free_matrices(M, K)
    assert free_matrices(M, K, rigid=0).rigid_modes.shape[1] == 0
