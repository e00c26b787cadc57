"""The experimental set-up of Sec. 5: Eq. 18 to 22 typed in against the finite element solution; what Fig. 6 shows."""

from pathlib import Path

import numpy as np
import pytest

import gearpath as gp
from gearpath.components.mobility import mobility_direct
from gearpath.network.assemble import assemble
from gearpath.network.reference import reference_solution

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("rig")]  # one process solves the plates for all
RIG = gp.load(Path(__file__).resolve().parents[2] / "models" / "test_rig.toml")
COARSE = RIG.replace(
    {
        "components.plate.elements": [10, 14],
        "components.source.plates.gears.elements": [4, 8],
        "components.source.beams.upper_shaft.elements": 6,
        "components.source.beams.lower_shaft.elements": 6,
    }
)
ORDER = [1, 3, 0, 4, 2, 5]  # the paper's order of a joint's coordinates: uy rx, ux ry, uz rz
E, NU, KAPPA, D, LENGTH, ETA = 2.07e11, 0.3, 0.886, 9.525e-3, 0.0127, 0.02


def paper_compliance():
    """H_p of one joint, Eq. 21 corrected, in the paper's order."""
    A, moment, G = np.pi * D**2 / 4, np.pi * D**4 / 64, E / (2 * (1 + NU))
    beta = 12 * E * moment / (KAPPA * G * A * LENGTH**2)
    h = LENGTH / (12 * E * moment)
    H = np.zeros((6, 6))
    H[:2, :2] = h * np.array([[(4 + beta) * LENGTH**2, -6 * LENGTH], [-6 * LENGTH, 12]])
    H[2:4, 2:4] = h * np.array([[(4 + beta) * LENGTH**2, 6 * LENGTH], [6 * LENGTH, 12]])
    H[4, 4], H[5, 5] = LENGTH / (E * A), LENGTH / (G * 2 * moment)
    return H


def paper_transport():
    """T_p of one joint, Eq. 19 corrected: it maps forces at the casing's end to those at the source's."""
    T = np.eye(6)
    T[1, 0], T[3, 2] = -LENGTH, LENGTH
    return T


@pytest.mark.parametrize("dof", ["ux", "uy", "uz"])
def test_eq_18_to_22_against_the_finite_element_solution(dof):
    """Mobilities by Eq. 6 of both parts, synthesised as printed (corrected), forces and Q_e within 1e-7."""
    network = assemble(COARSE.replace({"excitation.dof": dof}).system)
    omega = 2 * np.pi * np.array([35.0, 178.0, 700.0, 1900.0])
    reference = reference_solution(network, omega)
    source, plate = network.structures["source"], network.structures["plate"]
    at = {name: network.blocks[name] for name in network.blocks}
    ends = [np.vstack([j.receiver[ORDER][:, at["plate"]] for j in network.joints])]
    own = [joint.source[:, at["source"]] for joint in network.joints]  # already carried along the beam
    back = np.linalg.inv(np.block([[np.eye(3), _cross()], [np.zeros((3, 3)), np.eye(3)]]))
    starts = np.vstack([(back @ rows)[ORDER] for rows in own])
    excited = next(load for load in network.loads if load.name == network.excitation).column[None, at["source"]]
    Y_s = mobility_direct(source, np.vstack([excited, starts]), omega)
    Y_c = mobility_direct(plate, ends[0], omega)
    H, T = np.kron(np.eye(2), paper_compliance()), np.kron(np.eye(2), paper_transport())
    for k, w in enumerate(omega):
        Y11, Y12, Y22 = Y_s[k, 0, 0], Y_s[k, 0, 1:], Y_s[k, 1:, 1:]
        Gamma = np.linalg.solve(Y_c[k] + 1j * w * H / (1 + 1j * ETA) + T.T @ Y22 @ T, Y12 @ T)
        found = np.concatenate([reference.force[:6, k][ORDER], reference.force[6:, k][ORDER]])
        for rows in ([0, 2, 4, 6, 8, 10], [1, 3, 5, 7, 9, 11]):
            assert abs(Gamma - found)[rows].max() < 1e-7 * abs(found[rows]).max()
        Q_e = 0.5 * np.real(Y11 - (T.T @ Y12) @ Gamma)
        assert abs(Q_e - reference.input_power[k]) < 1e-7 * Q_e


def _cross():
    """u(far) = u + theta x (0, 0, l)."""
    return np.array([[0, LENGTH, 0], [-LENGTH, 0, 0], [0, 0, 0]])


def test_reduced_model_against_the_finite_element_solution():
    """The model's own Lanczos vectors, up to the last frequency; power balance."""
    f = np.array([12.0, 61.0, 400.0, 1500.0, 2000.0])
    flow = gp.power_flow(COARSE, f)
    reference = reference_solution(assemble(COARSE.system), 2 * np.pi * f)
    np.testing.assert_allclose(flow.alpha, reference.alpha, rtol=1e-5)
    np.testing.assert_allclose(flow.dissipated_power.sum("element"), flow.input_power, rtol=1e-8)


def test_frequencies_above_the_band_are_refused():
    """The plates were reduced up to frequency.stop; above, their mobility would be wrong without a sign of it."""
    with pytest.raises(gp.InputError, match=r"2100 Hz is above 2000 Hz, .* raise frequency.stop"):
        gp.power_flow(COARSE, [100.0, 2100.0])
    with pytest.raises(gp.InputError, match=r"raise frequency\.stop"):
        gp.frequency_response(COARSE, [2100.0])
    assert gp.natural_frequencies(COARSE)[-1] <= 2000.0


def test_natural_frequencies_of_the_assembly():
    """Within 2 % of the frequencies of another finite element code."""
    found = gp.natural_frequencies(COARSE)
    np.testing.assert_allclose(found[6:14], [39.8, 60.2, 60.6, 149.7, 177.4, 184.8, 271.0, 289.5], rtol=0.02)


@pytest.mark.parametrize(("dof", "least", "most"), [("ux", 0.99, 1.0), ("uy", 0.9, 1.0), ("uz", 0.0, 0.5)])
def test_the_moment_path_dominates_under_in_plane_forces(dof, least, most):
    """Fig. 6b: share of the lines above 1 kHz on which the upper joint sends more through moments than forces."""
    flow = gp.power_flow(RIG.replace({"excitation.dof": dof}), np.linspace(1001.0, 2000.0, 300))
    upper = flow.path_alpha.sel(path=[path for path in flow.path.values if path.startswith("upper.")])
    moment = upper.sel(path=[f"upper.{dof}" for dof in ("rx", "ry", "rz")]).sum("path")
    force = upper.sel(path=[f"upper.{dof}" for dof in ("ux", "uy", "uz")]).sum("path")
    dominates = float((abs(moment) > abs(force)).mean())
    assert least <= dominates <= most
