"""Networks for the tests of reduction, and their responses written once more from the state equations."""

import numpy as np
import scipy.linalg

from gearpath.network.modal import ModalNetwork
from gearpath.network.records import JointRows, Load, Output


def beam(length=0.5, diameter=0.03, elements=50, zeta=0.005, nodes=(0, 15, 33, 50)) -> ModalNetwork:
    """A free steel beam of 102 coordinates (Euler), loads and velocities at four nodes, an idle joint to the ground."""
    E, rho = 2.07e11, 7850.0
    area, second, h = np.pi * diameter**2 / 4, np.pi * diameter**4 / 64, length / elements
    k = np.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h]])
    k = np.vstack([k, [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]]) * E * second / h**3
    m = np.array([[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h]])
    m = np.vstack([m, [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h]]) * rho * area * h / 420
    n = 2 * (elements + 1)
    K, M = np.zeros((n, n)), np.zeros((n, n))
    for e in range(elements):
        part = slice(2 * e, 2 * e + 4)
        K[part, part] += k
        M[part, part] += m
    values, shapes = scipy.linalg.eigh(K, M)
    values[:2] = 0.0
    rows = shapes[[2 * node for node in nodes]]
    zero = np.zeros((1, 1))
    return ModalNetwork(
        name="beam",
        components={"beam": slice(0, n)},
        modal_damping={"beam": zeta},
        eigenvalues=values,
        joints=(JointRows("idle", "mount", ("uy",), rows[:1], 0 * rows[:1], zero, zero, grounded=True),),
        loads=tuple(Load(f"force_{i}", "N", row) for i, row in enumerate(rows)),
        outputs=tuple(Output(f"velocity_{i}", "m/s", "velocity", row=row) for i, row in enumerate(rows)),
        excitation="force_0",
        paths=(),
    )


def random_network(seed: int) -> ModalNetwork:
    """Two elastic components, joints of any rank between them and to the ground, forces and joint forces observed."""
    rng = np.random.default_rng(seed)
    parts, start, values = {}, 0, []
    for name in ("one", "two"):
        rigid, elastic = int(rng.integers(0, 4)), int(rng.integers(4, 24))
        hertz = np.sort(rng.uniform(np.log(150.0), np.log(4e4), elastic))
        values.append(np.concatenate([np.zeros(rigid), (2 * np.pi * np.exp(hertz)) ** 2]))
        parts[name] = slice(start, start + rigid + elastic)
        start += rigid + elastic
    joints = []
    for k in range(int(rng.integers(1, 4))):
        joints.append(_joint(rng, f"joint_{k}", parts["one"], parts["two"], start))
    for k, name in enumerate(parts):
        joints.append(_joint(rng, f"mount_{k}", parts[name], None, start))
    loads, outputs = [], []
    for k in range(int(rng.integers(1, 4))):
        row = np.zeros(start)
        block = parts["one" if rng.random() < 0.5 else "two"]
        row[block] = rng.normal(size=block.stop - block.start)
        loads.append(Load(f"force_{k}", "N", row))
        outputs.append(Output(f"velocity_{k}", "m/s", "velocity", row=row))
    for joint in joints:
        outputs += [Output(f"{joint.name}.{d}", "N", "force", None, joint.name, d) for d in range(len(joint.dofs))]
    outputs.append(Output("acceleration", "m/s2", "acceleration", row=joints[0].receiver[0]))
    return ModalNetwork(
        name=f"random_{seed}",
        components=parts,
        modal_damping={name: float(rng.uniform(0.002, 0.03)) for name in parts},
        eigenvalues=np.concatenate(values),
        joints=tuple(joints),
        loads=tuple(loads),
        outputs=tuple(outputs),
        excitation="force_0",
        paths=(),
    )


def _joint(rng, name, one, two, size):
    count = int(rng.integers(1, 4))
    source, receiver = np.zeros((count, size)), np.zeros((count, size))
    source[:, one] = rng.normal(size=(count, one.stop - one.start))
    if two is not None:
        receiver[:, two] = rng.normal(size=(count, two.stop - two.start))
    F = rng.normal(size=(count, int(rng.integers(1, count + 1))))
    K = 10 ** rng.uniform(5, 8) * F @ F.T
    C = rng.uniform(1e-6, 1e-5) * K + np.eye(count)
    return JointRows(name, "bearing", ("ux", "uy", "uz")[:count], source, receiver, K, C, grounded=two is None)


def coupled(network):
    """Dense M = I, D and S of q'' + D q' + S q = B u, from the definition; the loads' columns."""
    L, X = network.eigenvalues, np.zeros(len(network.eigenvalues))
    for name, zeta in network.modal_damping.items():
        own = np.zeros(len(L))
        own[network.components[name]] = 1.0
        X += 2 * zeta * network.damping_shares.get(name, own) * np.sqrt(L)
    D, S = np.diag(X), np.diag(L)
    for joint in network.joints:
        P = joint.source - joint.receiver
        D, S = D + P.T @ joint.damping @ P, S + P.T @ joint.stiffness @ P
    return D, S, np.column_stack([load.column for load in network.loads])


def poles_of(network):
    D, S, _ = coupled(network)
    n = len(D)
    w = np.sqrt(np.maximum(network.eigenvalues, 1e6))
    A = np.block([[np.zeros((n, n)), np.diag(w)], [-S / w, -D]])
    return scipy.linalg.eig(A)


def responses(network, omega):
    """(F, outputs, loads) of forces and motions, by the poles of the state equations."""
    D, _, B = coupled(network)
    n = len(D)
    w = np.sqrt(np.maximum(network.eigenvalues, 1e6))
    poles, T = poles_of(network)
    left = np.linalg.solve(T, np.vstack([np.zeros((n, B.shape[1])), B]).astype(complex))
    at = {joint.name: joint for joint in network.joints}
    rows = []
    for output in network.outputs:
        if output.quantity == "force":
            joint = at[output.joint]
            P = joint.source - joint.receiver
            rows.append(np.concatenate([joint.stiffness[output.dof] @ P / w, joint.damping[output.dof] @ P]))
        else:
            rows.append(np.concatenate([0 * w, output.row]))
    right = np.array(rows) @ T
    H = np.einsum("or,fr,rl->fol", right, 1.0 / (1j * omega[:, None] - poles), left, optimize=True)
    for k, output in enumerate(network.outputs):
        if output.quantity == "acceleration":
            H[:, k] *= 1j * omega[:, None]
    return H


def true_error(network, small, band, density=10):
    """The largest error over a grid `density` times finer than the certificate's, 25 points a resonance."""
    low, high = 2 * np.pi * np.array(band)
    poles = np.concatenate([poles_of(network)[0], poles_of(small)[0]])
    poles = poles[(poles.imag > 0.4 * low) & (poles.imag < 2.5 * high)]
    spread = np.sinh(np.linspace(-6.0, 6.0, 25 * density))
    around = (poles.imag[:, None] - poles.real[:, None] * spread).ravel()
    omega = np.concatenate([np.linspace(low, high, 600 * density), around[(around > low) & (around < high)]])
    H, found = responses(network, omega), responses(small, omega)
    return float((abs(found - H).max(axis=0) / abs(H).max(axis=0)).max())
