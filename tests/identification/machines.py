"""Measurements made without the package's synthesis: assembled matrices inverted, and the unsynthesised reference."""

from dataclasses import replace

import numpy as np

from gearpath.network.records import Load
from gearpath.network.reference import reference_solution


def assembled(rng, sizes, lines, *, parts=(14, 12), rank=None):
    """Two random parts on random springs to the ground, joined by random joints: Y (F, 2 n, 2 n), K and C by joint.

    One dynamic stiffness matrix of the whole machine is inverted. rank: of each K, full where left out.
    """
    n = sum(sizes)
    M, D, S = (np.zeros((sum(parts), sum(parts))) for _ in range(3))
    start = 0
    for size in parts:
        at = slice(start, start + size)
        G = rng.normal(size=(size, size))
        M[at, at] = np.eye(size) + 0.1 * G @ G.T / size
        G = rng.normal(size=(size, size)) * 300.0 * rng.uniform(0.3, 3.0, size)
        S[at, at] = G @ G.T
        D[at, at] = 2e-5 * S[at, at] + 2.0 * np.eye(size)
        start += size
    ports = np.zeros((2 * n, sum(parts)))
    ports[np.arange(n), np.arange(n)] = ports[np.arange(n, 2 * n), parts[0] + np.arange(n)] = 1.0
    relative, joints, start = ports[:n] - ports[n:], [], 0
    for size in sizes:
        G = 1e3 * rng.normal(size=(size, size if rank is None else rank))
        H = 3.0 * rng.normal(size=(size, size))
        B = relative[start : start + size]
        joints.append((G @ G.T, H @ H.T))
        S, D = S + B.T @ joints[-1][0] @ B, D + B.T @ joints[-1][1] @ B
        start += size
    omega = 2.0 * np.pi * lines
    Y = np.array([1j * w * ports @ np.linalg.inv(S + 1j * w * D - w**2 * M) @ ports.T for w in omega])
    return Y, joints


def reference_mobility(network, names, omega):
    """Y (F, 2 n, 2 n) at the named joints from the unsynthesised solution in physical coordinates, force by force."""
    joints = [next(joint for joint in network.joints if joint.name == name) for name in names]
    rows = np.vstack([*(joint.source for joint in joints), *(joint.receiver for joint in joints)])
    columns = [
        rows @ reference_solution(replace(network, loads=(Load("f", "N", row),), excitation="f"), omega).velocity
        for row in rows
    ]
    return np.ascontiguousarray(np.array(columns).transpose(2, 1, 0))


def worst(found, truth):
    """Largest error of K and of C, relative to sqrt(|K_ii K_jj|); a zero diagonal counts as its least neighbour."""
    errors = []
    for joint, (K, C) in zip(found.joints.values(), truth):
        for matrix, right in ((joint.stiffness, K), (joint.damping, C)):
            size = np.sqrt(np.abs(np.diagonal(right)))
            size[size == 0.0] = size[size > 0.0].min()
            errors.append(np.abs((matrix - right) / np.outer(size, size)).max())
    return max(errors)


def noisy(Y, noise, rng):
    """Independent circular complex Gaussian noise, sqrt(E|e|^2) = noise |Y_ij|."""
    return Y * (1.0 + noise * np.sqrt(0.5) * (rng.normal(size=Y.shape) + 1j * rng.normal(size=Y.shape)))
