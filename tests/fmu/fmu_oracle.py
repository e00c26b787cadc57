"""The equations written once more, densely, in numpy: nothing is shared with what is tested.

The time form has the unscaled state [q, s]; the frequency form is a direct solve of the whole coupled system.
"""

import numpy as np


def modal_damping_matrix(network):
    X = np.zeros(len(network.eigenvalues))
    for name, zeta in network.modal_damping.items():
        own = np.zeros(len(X))
        own[network.components.get(name, slice(0))] = 1
        X += 2 * zeta * network.damping_shares.get(name, own) * np.sqrt(network.eigenvalues)
    return X


def interface(network):
    P = np.vstack([j.source - j.receiver for j in network.joints])
    size = len(P)
    K, C, at = np.zeros((size, size)), np.zeros((size, size)), {}
    row = 0
    for joint in network.joints:
        block = slice(row, row + len(joint.dofs))
        K[block, block], C[block, block], at[joint.name] = joint.stiffness, joint.damping, block
        row = block.stop
    return P, K, C, at


def time_system(network):
    """A, B, C, D for the linear outputs (powers left out), and their names."""
    L, X = network.eigenvalues, modal_damping_matrix(network)
    n = len(L)
    P, K, C, at = interface(network)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.diag(L) - P.T @ K @ P, -np.diag(X) - P.T @ C @ P]])
    rate = np.zeros((n, len(network.loads)))  # q' = s + rate u
    push = np.zeros((n, len(network.loads)))
    for k, load in enumerate(network.loads):
        if load.mesh_displacement is None:
            push[:, k] = load.column
        else:
            rate[:, k] = X * load.mesh_displacement
            push[:, k] = (L - X**2) * load.column
    B = np.vstack([rate, push - P.T @ C @ P @ rate])
    G, GD = np.hstack([K @ P, C @ P]), C @ P @ rate
    rows, feed, names = [], [], []
    for output in network.outputs:
        if output.quantity == "power":
            continue
        names.append(output.name)
        if output.quantity == "force":
            i = at[output.joint].start + output.dof
            rows.append(G[i])
            feed.append(GD[i])
        elif output.quantity == "displacement":
            rows.append(np.concatenate([output.row, np.zeros(n)]))
            feed.append(np.zeros(len(network.loads)))
        elif output.quantity == "velocity":
            rows.append(np.concatenate([np.zeros(n), output.row]))
            feed.append(output.row @ rate)
        else:
            rows.append(output.row @ A[n:])
            feed.append(output.row @ B[n:])
    return A, B, np.array(rows), np.array(feed), names


def scaled_time_system(network):
    """The same with the state [w q, s] of the FMU: w the frequency of each mode, 1 kHz for rigid ones."""
    A, B, C, D, names = time_system(network)
    L = network.eigenvalues
    scale = np.concatenate([np.where(L > 0, np.sqrt(L), 2e3 * np.pi), np.ones(len(L))])
    return A * scale[:, None] / scale, B * scale[:, None], C / scale, D, names


def first_order_hold(network, U, h):
    """Outputs at the rows of U, between which the inputs are straight lines: by a Taylor series in 80-bit arithmetic.

    Squaring a propagator doubles its error, so that plain doubles lose 1e-9 over a step of 1e-4 s.
    """
    A, B, C, D, names = time_system(network)
    n, m = B.shape
    M = np.zeros((n + 2 * m, n + 2 * m), dtype=np.longdouble)
    M[:n, :n], M[:n, n : n + m] = A * np.longdouble(h), B * np.longdouble(h)
    M[n : n + m, n + m :] = np.eye(m)
    balance = np.ones(len(M), dtype=np.longdouble)
    balance[: n // 2] = np.sqrt(np.maximum(network.eigenvalues, 1e7))
    M = M * balance[:, None] / balance / 2**14
    E = term = np.eye(len(M), dtype=np.longdouble)
    for k in range(1, 20):
        term = term @ M / k
        E = E + term
    for _ in range(14):
        E = E @ E
    E = np.array(E / balance[:, None] * balance, dtype=float)
    x, y = np.zeros(n), np.empty((len(U), len(names)))
    for i, (u, step) in enumerate(zip(U, np.diff(U, axis=0, append=U[-1:]))):
        y[i] = C @ x + D @ u
        x = E[:n] @ np.concatenate([x, u, step])
    return y, names


def frequency_response(network, hertz):
    """Outputs' transfers from the excitation and power ratios, by one solve of the coupled system."""
    w = 2 * np.pi * hertz
    L, X = network.eigenvalues, modal_damping_matrix(network)
    P, K, C, at = interface(network)
    load = next(load for load in network.loads if load.name == network.excitation)
    # Solved for u = q - d, as a transmission error acts, because q - d cancels at low frequencies: with q the
    # power ratio at 20 Hz is wrong by 1e-6, with u by 1e-12 (checked with 40 digits).
    Z = K + 1j * w * C
    dynamic = np.diag(L - w**2 + 1j * w * X) + P.T @ Z @ P
    if load.mesh_displacement is None:
        d, f = np.zeros_like(L), load.column
    else:
        d, f = load.mesh_displacement, w**2 * load.column - P.T @ (Z @ (P @ load.mesh_displacement))
    u = np.linalg.solve(dynamic, f)
    q = u + d
    g = Z @ (P @ q)
    v, u_rate = 1j * w * q, 1j * w * u
    # what enters is what is lost, in the components (by u, without the transmission error) and in the joints
    slip = P @ v
    input_power = 0.5 * (X @ abs(u_rate) ** 2 + np.real(slip.conj() @ C @ slip))
    result = {"alpha": 0.0, "alpha_force": 0.0, "alpha_moment": 0.0}
    for joint in network.joints:
        if joint.name not in network.paths:
            continue
        power = 0.5 * np.real(np.conj(joint.receiver @ v) * g[at[joint.name]]) / input_power
        result[f"{joint.name}.alpha"] = power.sum()
        result["alpha"] += power.sum()
        for dof, value in zip(joint.dofs, power):
            result["alpha_moment" if dof.startswith("r") else "alpha_force"] += value
    for output in network.outputs:
        if output.quantity == "power":
            continue
        if output.quantity == "force":
            value = g[at[output.joint].start + output.dof]
        else:
            value = {"displacement": 1 / (1j * w), "velocity": 1, "acceleration": 1j * w}[output.quantity] * (
                output.row @ v
            )
        result[f"frf.{output.name}.re"], result[f"frf.{output.name}.im"] = value.real, value.imag
    return result
