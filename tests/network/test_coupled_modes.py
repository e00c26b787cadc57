"""Modes of the coupled network: a basis that A falls apart in, whatever the damping and the rigid motions are."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigvals, expm

import gearpath as gp
from gearpath.api import modal_network
from gearpath.network.coupled_modes import PairKind, coupled_modes
from gearpath.network.modal import ModalNetwork
from gearpath.network.records import JointRows, Load
from gearpath.network.time_twin import state_scale, time_twin


def basis(network, modes):
    """T (2N, 2N) and the block-diagonal matrix that A becomes, built here from the definition of the pairs."""
    w, N = state_scale(network), len(network.eigenvalues)
    T, J = np.zeros((2 * N, 2 * N)), np.zeros((2 * N, 2 * N))
    for k, (kind, pole, (f, g)) in enumerate(zip(modes.kinds, modes.poles, modes.shapes)):
        pair = slice(2 * k, 2 * k + 2)
        if kind is PairKind.OSCILLATING:
            x = np.concatenate([w * (f + 1j * g), complex(*pole) * (f + 1j * g)])
            T[:, pair] = np.column_stack([x.real, x.imag])
            J[pair, pair] = [[pole[0], pole[1]], [-pole[1], pole[0]]]
        elif kind is PairKind.DECAYING:
            T[:, pair] = np.column_stack([np.concatenate([w * h, p * h]) for p, h in zip(pole, (f, g))])
            J[pair, pair] = np.diag(pole)
        else:
            T[:, pair] = np.column_stack([np.concatenate([w * f, 0 * f]), np.concatenate([0 * f, f])])
            J[pair, pair] = [[0.0, 1.0], [0.0, 0.0]]
    return T, J


@pytest.mark.parametrize(
    ("model", "kinds"),
    [
        ("gearbox", {PairKind.OSCILLATING: 72}),
        ("helical_gearbox", {PairKind.OSCILLATING: 149, PairKind.DRIFTING: 1}),
        pytest.param(
            "test_rig",
            {PairKind.OSCILLATING: 250, PairKind.DECAYING: 8, PairKind.DRIFTING: 6},
            marks=pytest.mark.slow,
        ),
    ],
)
def test_state_equations_fall_apart(model, kinds):
    network = modal_network(gp.load(f"models/{model}.toml")).viscous()
    modes = coupled_modes(network)
    assert {kind: modes.kinds.count(kind) for kind in set(modes.kinds)} == kinds
    A = time_twin(network, outputs=()).A
    T, J = basis(network, modes)
    residual = abs(A @ T - T @ J).max(axis=0) / abs(T).max(axis=0)
    assert (residual <= 1e-11 * abs(A).max()).all()
    h = 1e-5  # and so do its exponentials
    assert abs(expm(A * h) @ T - T @ expm(J * h)).max() < 1e-10 * abs(T).max()


def test_slow_poles_have_all_their_digits():
    """Newton's correction of f^T (p^2 + p D + S) f, in extended precision: nothing is left to correct."""
    network = modal_network(gp.load("models/gearbox.toml")).viscous()
    modes = coupled_modes(network)
    P, (K, C) = network.relative.astype(np.longdouble), network.interface_matrices()
    p = modes.poles[:, 0].astype(np.longdouble) + 1j * modes.poles[:, 1].astype(np.longdouble)
    f = (modes.shapes[:, 0] + 1j * modes.shapes[:, 1]).T.astype(np.clongdouble)
    a = (f * f).sum(axis=0)
    b = (f * (network.damping[:, None] * f + P.T @ (C @ (P @ f)))).sum(axis=0)
    c = (f * (network.eigenvalues[:, None] * f + P.T @ (K @ (P @ f)))).sum(axis=0)
    correction = ((a * p + b) * p + c) / (2 * a * p + b)
    assert (abs(correction) < 1e-14 * abs(p)).all()
    rough = np.array(sorted(eigvals(time_twin(network, outputs=()).A)[:], key=lambda q: (q.imag <= 0, q.imag))[:72])
    slow = abs(p).argsort()[:10]
    assert (abs(rough - p)[slow] > 1e-13 * abs(p[slow])).any()  # else the refinement would be for nothing


def test_critical_damping_has_no_modal_form():
    """A double pole with one eigenvector that is not at zero."""
    k, c = 4.0e6, 2.0 * np.sqrt(4.0e6)
    rows = np.array([[1.0]])
    joint = JointRows("mount", "mount", ("uy",), rows, 0 * rows, np.array([[k]]), np.array([[c]]), True, True)
    load = Load("mesh.force", "N", np.array([1.0]))
    one = ModalNetwork("one", {"casing": slice(0, 1)}, {}, np.zeros(1), (joint,), (load,), (), "mesh.force", ())
    assert coupled_modes(one) is None
    assert coupled_modes(replace(one, joints=(replace(joint, damping=0.5 * joint.damping),))) is not None
    over = coupled_modes(replace(one, joints=(replace(joint, damping=2.0 * joint.damping),)))
    assert over.kinds == (PairKind.DECAYING,)
    assert over.poles.ravel() == pytest.approx(sorted(np.roots([1.0, 2 * c, k]).real, reverse=True), rel=1e-12)
