"""The paper's own formulas (Eq. 3, 5, 16, 17) typed in for its case: source, bearings, casing on its mounts."""

import numpy as np

from gearpath.components import modes
from gearpath.components.mobility import mobility_modal
from gearpath.network.power import power_flow

OMEGA = 2 * np.pi * np.array([30.0, 206.0, 900.0, 2200.0, 4700.0])
ENDS = [(-0.04975, -0.125), (-0.04975, 0.125), (0.05025, -0.125), (0.05025, 0.125)]
MOUNTS = [(-0.09, -0.12), (0.09, -0.12), (-0.09, 0.12), (0.09, 0.12)]


def foundation_mobility(omega):
    """Eq. 16 with Eq. 14, 15 and 17: the rigid casing on its mounts, seen from the bearings."""
    P_p = np.hstack([[[1, 0], [-z, 1], [x, 0]] for x, z in ENDS])
    P_b = np.array([[1, -z, x] for x, z in MOUNTS])
    M_a = np.diag([12.0, 0.15, 0.17])
    return np.array(
        [1j * w * P_p.T @ np.linalg.inv((1e7 + 1j * w * 440.0) * P_b.T @ P_b - w**2 * M_a) @ P_p for w in omega]
    )


def test_eq_3_and_5_with_an_inverted_bearing_matrix(network, modal):
    source = network.structures["gear_train"]
    rows = [network.joints[k].source[:, network.blocks["gear_train"]] for k in range(4)]
    motion = source.meshes["mesh"]
    excitation = source.mass @ motion.displacement / motion.equivalent_mass
    Y_s = mobility_modal(modes(source), np.vstack([excitation, *rows]), 0.015, OMEGA)
    Y_c = foundation_mobility(OMEGA)
    K = np.array([[1.2e8, 1.8e6], [1.8e6, 6.0e4]])
    flow = power_flow(modal, OMEGA)
    for k, w in enumerate(OMEGA):
        Y_p = np.kron(np.eye(4), 1j * w * np.linalg.inv(K + 1j * w * 1e-6 * K))
        Gamma = np.linalg.inv(Y_s[k, 1:, 1:] + Y_p + Y_c[k]) @ Y_s[k, 1:, 0]
        force = motion.equivalent_mass * w**2
        np.testing.assert_allclose(flow.force[:, k], Gamma * force, rtol=1e-7)
        Q_e = 0.5 * np.real(Y_s[k, 0, 0] - Y_s[k, 0, 1:] @ Gamma)
        Q_pc = 0.5 * np.real(Gamma.conj() @ Y_c[k] @ Gamma)
        np.testing.assert_allclose(flow.input_power[k], Q_e * force**2, rtol=1e-7)
        np.testing.assert_allclose(flow.share()[k], Q_pc / Q_e, rtol=1e-6)
