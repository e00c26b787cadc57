"""What docs/theory.md says of the paper's misprints, where no other test shows it: the printed form put back.

The formulas are typed in here; the package gives the machines and, by other ways, the answers.
"""

from dataclasses import replace

import numpy as np
import pytest
from systems import default_gearbox

from gearpath.components import DOFS, Material, RigidBody, Section
from gearpath.components.beam import beam_element
from gearpath.joints import Port, beam_joint
from gearpath.network.assemble import assemble
from gearpath.network.excitations import power_matrices
from gearpath.network.power import is_moment_path, power_flow
from gearpath.network.records import Load
from gearpath.network.system import PointExcitation, System

OMEGA = 2 * np.pi * np.arange(10.0, 5001.0, 10.0)
E, NU, KAPPA, RHO = 2.07e11, 0.3, 0.886, 7850.0
G = E / (2 * (1 + NU))


def is_force_path(path):
    return not is_moment_path(path)


def undamped_source(system):
    train = replace(system.components["gear_train"], modal_damping=0.0)
    return replace(system, components={**system.components, "gear_train": train})


def test_the_excitation_needs_a_mass():
    """Before Eq. 2 the paper has F_e = w^2 e. With m_e = 1 / (r1^2/J1 + r2^2/J2) it is the transmission error e."""
    modal = assemble(default_gearbox()).modal()
    Q = power_matrices(modal, OMEGA, [load for load in modal.loads if load.name == "mesh.force"]).input[:, 0, 0].real
    mass = 1 / (0.04975**2 / 1.8884e-3 + 0.05025**2 / 1.9655e-3)
    found = power_flow(modal, OMEGA).input_power
    np.testing.assert_allclose((mass * OMEGA**2) ** 2 * Q, found, rtol=1e-10)
    printed = OMEGA**4 * Q
    np.testing.assert_allclose(printed / found, 1 / mass**2, rtol=1e-10)  # 6.7 times too much


@pytest.mark.parametrize("damped", [False, True])
def test_a_force_pair_at_the_gears_is_the_same_for_an_undamped_source_only(damped):
    """+-k e across the mesh against m_e w^2 e on p: modal damping resists the elastic motion of the first only."""
    system = default_gearbox() if damped else undamped_source(default_gearbox())
    network = assemble(system)
    modal, source = network.modal(), network.structures["gear_train"]
    spread = np.zeros(len(modal.eigenvalues))
    k_b = source.stiffness @ source.meshes["mesh"].displacement  # k b, for b d = 1
    spread[modal.components["gear_train"]] = k_b @ network.bases["gear_train"].shapes
    pair = replace(modal, loads=(Load("pair", "N", spread),), excitation="pair")
    deviation = abs(10 * np.log10(power_flow(pair, OMEGA).share() / power_flow(modal, OMEGA).share()))
    if damped:
        assert 4.0 < np.median(deviation) < 5.5
    else:
        assert deviation.max() < 1e-9


def test_imaginary_part_of_the_norm():
    """|u|^2_D = (D u)^H u: its imaginary part belongs to -Im D, its real part to Re D."""
    rng = np.random.default_rng(5)
    D = rng.normal(size=(4, 4)) + 1j * rng.normal(size=(4, 4))
    D, u = D + D.T, rng.normal(size=4) + 1j * rng.normal(size=4)

    def norm(matrix):
        return np.vdot(matrix @ u, u)

    assert norm(D).real == pytest.approx(norm(D.real).real, rel=1e-12)
    assert norm(D).imag == pytest.approx(-norm(D.imag).real, rel=1e-12)


def test_only_the_net_ratio_stays_below_one():
    """Single paths pass 1 and turn negative; without losses alpha is 1 and the force paths carry more than enters."""
    flow = power_flow(assemble(default_gearbox()).modal(), OMEGA)
    single = flow.path_power / flow.input_power
    assert np.all((flow.share() > 0.0) & (flow.share() < 1.0))
    assert single.max() > 1.5
    assert single.min() < -1.5
    lossless = undamped_source(default_gearbox(damping=((0.0, 0.0), (0.0, 0.0))))
    assert power_flow(assemble(lossless).modal(), OMEGA).share(is_force_path).max() > 1.04


def test_eq_8_corrected_integrates_to_the_beam_element():
    """(d N^T)^T D (d N^T) over the volume of a round bar, linear shape functions, u_z = y theta_x; kappa G for G."""
    length, radius = 0.04, 0.015
    K, M = np.zeros((4, 4)), np.zeros((4, 4))
    D = np.array([[E, NU * E, 0.0], [NU * E, E, 0.0], [0.0, 0.0, KAPPA * G]])
    points, weights = np.polynomial.legendre.leggauss(6)
    for xi, along in zip((points + 1) / 2, weights / 2):
        for r, out in zip(radius * (points + 1) / 2, radius * weights / 2):
            for angle in np.arange(8) * np.pi / 4:
                y, volume = r * np.sin(angle), length * along * out * r * np.pi / 4
                translation, rotation = np.array([1 - xi, 0, xi, 0]), np.array([0, 1 - xi, 0, xi])
                N = np.column_stack([y * rotation, translation])  # (u_z, u_y) = N^T q
                slope = np.column_stack([y * np.array([0, -1, 0, 1]), [-1, 0, 1, 0]]) / length
                strain = np.array([slope[:, 0], np.zeros(4), rotation + slope[:, 1]])
                K += volume * strain.T @ D @ strain
                M += volume * RHO * N @ N.T
    found = beam_element("mindlin_full", Section(length, 2 * radius), Material(E, NU, RHO), length, KAPPA)
    plane = np.ix_([1, 3, 7, 9], [1, 3, 7, 9])
    for matrix, expected in zip(found, (K, M)):
        np.testing.assert_allclose(matrix[plane], expected, atol=1e-12 * abs(expected).max())


ORDER = [1, 3, 0, 4, 2, 5]  # uy rx, ux ry, uz rz: the paper's order of a joint's coordinates
LENGTH, DIAMETER, LOSS = 0.05, 0.012, 0.2
FEET = [(0.0, 0.06, 0.0), (0.02, -0.05, 0.0)]  # where the two joints begin; they run along +z
BODIES = {
    "source": RigidBody(2.0, {"xx": 0.012, "yy": 0.009, "zz": 0.015}, (0.0, 0.0, -0.03)),
    "receiver": RigidBody(3.0, {"xx": 0.02, "yy": 0.03, "zz": 0.01}, (0.01, 0.0, 0.1)),
}
PUSHED = (0.03, 0.02, -0.05)


def bodies_on_two_beams(omega):
    """The package's interface forces, in the paper's order, and input power."""
    joints = {
        f"beam_{k}": beam_joint(
            (Port("source"), Port("receiver")),
            (0.0, 0.0, LENGTH),
            DOFS,
            DIAMETER,
            E,
            NU,
            loss_factor=LOSS,
            at=(x, y, LENGTH),
        )
        for k, (x, y, _) in enumerate(FEET)
    }
    system = System("pair", DOFS, BODIES, joints, PointExcitation(Port("source"), "ux", 1.0, PUSHED))
    flow = power_flow(assemble(system).modal(), omega)
    return flow.force[[*ORDER, *(6 + k for k in ORDER)]], flow.input_power


def rigid_rows(name, point):
    """u + theta x r of a point of a body, in the paper's order, (6, 6)."""
    x, y, z = np.subtract(point, BODIES[name].centre_of_gravity)
    return np.block([[np.eye(3), np.array([[0, z, -y], [-z, 0, x], [y, -x, 0]])], [np.zeros((3, 3)), np.eye(3)]])[ORDER]


def inverse_inertia(name):
    body = BODIES[name]
    return np.diag([1 / body.mass] * 3 + [1 / body.inertia[axis] for axis in ("xx", "yy", "zz")])


def eq_18_and_22(w, compliance, transport, loss):
    """Gamma of Eq. 18 and Q_e of Eq. 22, rigid bodies for Y_s and Y_c; `loss` is the denominator below H_p."""
    S = np.vstack([rigid_rows("source", PUSHED)[[2]], *(rigid_rows("source", foot) for foot in FEET)])
    C = np.vstack([rigid_rows("receiver", (x, y, LENGTH)) for x, y, _ in FEET])
    Y_s = S @ inverse_inertia("source") @ S.T / (1j * w)
    Y_c = C @ inverse_inertia("receiver") @ C.T / (1j * w)
    H, T = np.kron(np.eye(2), compliance), transport
    Gamma = np.linalg.solve(Y_c + 1j * w * H / loss + T.T @ Y_s[1:, 1:] @ T, Y_s[0, 1:] @ T)
    return Gamma, 0.5 * np.real(Y_s[0, 0] - (T.T @ Y_s[1:, 0]) @ Gamma)


def eq_21(moment, polar, beta):
    """H_p of one joint with the given moments, its two flexures, tension and torsion."""
    area, h = np.pi * DIAMETER**2 / 4, LENGTH / (12 * E * moment)
    H = np.zeros((6, 6))
    for k, sign in ((0, -1), (2, 1)):
        H[k : k + 2, k : k + 2] = [[(4 + beta) * LENGTH**2, sign * 6 * LENGTH], [sign * 6 * LENGTH, 12]]
    H *= h
    H[4, 4], H[5, 5] = LENGTH / (E * area), LENGTH / (G * polar)
    return H


def eq_19(corrected):
    """T_p of both joints; the printed indices put those of the second joint into the first one's rows."""
    T = np.eye(12)
    for v in (1, 2):
        first = 6 * v - 4 if corrected else 2 * v
        for (i, k), lever in (((first, first - 1), -LENGTH), ((first + 2, first + 1), LENGTH)):
            T[i - 1, k - 1] = lever
    return T


MOMENT = np.pi * DIAMETER**4 / 64
BETA = 12 * E * MOMENT / (KAPPA * G * np.pi * DIAMETER**2 / 4 * LENGTH**2)
CORRECT = {"moment": MOMENT, "polar": 2 * MOMENT, "beta": BETA, "corrected": True, "viscous": False}


@pytest.mark.parametrize(
    ("printed", "least"),
    [
        ({}, 0.0),
        ({"viscous": True}, 0.3),  # Eq. 18: 1 + i w eta
        ({"corrected": False}, 0.3),  # Eq. 19b, 19c
        ({"moment": 2 * MOMENT}, 0.01),  # Eq. 21b, 21c with the polar moment that 21d calls J
        ({"polar": MOMENT}, 0.01),  # Eq. 21d with the area moment
    ],
)
def test_eq_18_to_22_with_one_misprint_put_back(printed, least):
    """Exact as corrected, forces and Q_e; every misprint by itself moves the forces by more than `least`."""
    omega = 2 * np.pi * np.array([70.0, 300.0, 900.0])
    force, power = bodies_on_two_beams(omega)
    use = {**CORRECT, **printed}
    worst = 0.0
    for k, w in enumerate(omega):
        loss = 1 + 1j * LOSS * (w if use["viscous"] else 1.0)
        Gamma, Q_e = eq_18_and_22(w, eq_21(use["moment"], use["polar"], use["beta"]), eq_19(use["corrected"]), loss)
        for rows in (slice(0, None, 2), slice(1, None, 2)):
            worst = max(worst, abs(Gamma - force[:, k])[rows].max() / abs(force[rows, k]).max())
        if not printed:
            assert Q_e == pytest.approx(power[k], rel=1e-9)
    assert worst > least if printed else worst < 1e-9
