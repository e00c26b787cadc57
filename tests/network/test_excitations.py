"""Several excitations: power matrices against single ones, Eq. 5 from mobilities, Monte Carlo, and the balance."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from systems import default_gearbox, random_gearbox
from test_paper_equations import foundation_mobility

import gearpath as gp
from gearpath.components.mobility import mobility_direct
from gearpath.joints import Port
from gearpath.network.assemble import assemble
from gearpath.network.excitations import checked_spectrum, expected, power_matrices
from gearpath.network.power import power_flow
from gearpath.network.system import Actuator

LINES = 2 * np.pi * np.geomspace(20.0, 5000.0, 5)


def driven(system):
    """The machine with a force on a shaft and a moment on the casing besides its own excitation."""
    train = next(name for name in system.components if name != "casing")
    shaft = next(iter(system.components[train].shafts))
    actuators = {
        "shaker": Actuator(Port(train, shaft, 0.05), "uy"),
        "torque": Actuator(Port("casing"), "uy", (0.05, 0.0, 0.1)),
    }
    return replace(system, actuators=actuators)


def correlated(rng, n, lines):
    """A random cross-spectral matrix of rank n - 1 or more."""
    A = rng.normal(size=(lines, n, n)) + 1j * rng.normal(size=(lines, n, n))
    A[..., -1] *= rng.integers(2)
    return A @ A.conj().swapaxes(-1, -2)


def test_one_excitation_is_the_power_flow():
    modal = assemble(default_gearbox()).modal()
    load = next(item for item in modal.loads if item.name == modal.excitation)
    Q, flow = power_matrices(modal, LINES, [load]), power_flow(modal, LINES)
    np.testing.assert_allclose(Q.input[:, 0, 0].real, flow.input_power, rtol=1e-12)
    np.testing.assert_allclose(Q.path[:, :, 0, 0].real, flow.path_power, rtol=1e-9)
    np.testing.assert_allclose(Q.dissipated[:, :, 0, 0].real, flow.dissipated_power, rtol=1e-12)


def test_uncorrelated_excitations_add_up():
    """Against single excitations solved one by one with the plain power flow."""
    modal = assemble(driven(default_gearbox())).modal()
    loads = [load for load in modal.loads if load.name in ("actuators.shaker", "actuators.torque")]
    Q = power_matrices(modal, LINES, loads)
    S = checked_spectrum([4.0, 9.0], ["a", "b"], len(LINES))
    singles = [power_flow(replace(modal, excitation=load.name), LINES, size) for load, size in zip(loads, (2.0, 3.0))]
    np.testing.assert_allclose(expected(Q.input, S), sum(one.input_power for one in singles), rtol=1e-10)
    total = sum(one.path_power for one in singles)
    np.testing.assert_allclose(expected(Q.path, S), total, rtol=1e-8, atol=1e-10 * abs(total).max())


@settings(max_examples=40, deadline=None)
@given(st.builds(random_gearbox, st.integers(0, 2**20), st.integers(1, 6)), st.integers(0, 2**20))
def test_balance_and_passivity_of_correlated_excitations(system, seed):
    """All that enters is dissipated, also of a transmission error and forces acting together; Q_e >= 0.

    What the source's own excitations send through the bearings is never returned and never more than enters.
    """
    modal = assemble(driven(system)).modal()
    loads = [load for load in modal.loads if not load.name.endswith(".force")]
    Q = power_matrices(modal, LINES, loads)
    size = np.sqrt(np.diagonal(Q.input, axis1=1, axis2=2).real.clip(1e-300).max(axis=0))  # inputs differ in unit
    S = correlated(np.random.default_rng(seed), len(loads), len(LINES)) / np.outer(size, size)
    entering = expected(Q.input, S)
    np.testing.assert_allclose(expected(Q.dissipated, S).sum(axis=0), entering, rtol=1e-7)
    scaled = Q.input / np.outer(size, size)
    assert np.linalg.eigvalsh(scaled).min() > -1e-9 * abs(scaled).max()
    own = [k for k, load in enumerate(loads) if load.name != "actuators.torque"]
    through = Q.path.sum(axis=0)[:, own][..., own] / np.outer(size, size)[np.ix_(own, own)]
    rest = scaled[:, own][..., own] - through
    largest = abs(scaled).max()
    assert min(np.linalg.eigvalsh(through).min(), np.linalg.eigvalsh(rest).min()) > -1e-9 * largest


def test_eq_5b_and_5c_corrected_from_inverted_mobilities():
    """Gamma by Eq. 3, the casing by Eq. 16; 1/2 Re(Gamma^H Y_c Gamma) as printed would lose what couples the inputs."""
    system = replace(default_gearbox(), actuators={"shaker": Actuator(Port("gear_train", "input", 0.1), "uy")})
    network = assemble(system)
    modal = network.modal()
    loads = [load for load in modal.loads if load.name in ("mesh.force", "actuators.shaker")]
    physical = [next(item for item in network.loads if item.name == load.name) for load in loads]
    train = network.blocks["gear_train"]
    sources = np.vstack([network.joints[k].source for k in range(4)])[:, train]
    excited = np.array([load.column[train] for load in physical])
    Y_s = mobility_direct(network.structures["gear_train"], np.vstack([excited, sources]), LINES)
    Y_c = foundation_mobility(LINES)
    K = np.kron(np.eye(4), [[1.2e8, 1.8e6], [1.8e6, 6.0e4]])
    Q, printed = power_matrices(modal, LINES, loads), []
    for k, w in enumerate(LINES):
        Y_p = 1j * w * np.linalg.inv(K + 1j * w * 1e-6 * K)
        Gamma = np.linalg.solve(Y_s[k, 2:, 2:] + Y_p + Y_c[k], Y_s[k, 2:, :2])
        Y_in = Y_s[k, :2, :2] - Y_s[k, :2, 2:] @ Gamma
        np.testing.assert_allclose(Q.input[k], (Y_in + Y_in.conj().T) / 4, atol=1e-6 * abs(Q.input[k]).max())
        through = 0.5 * Gamma.conj().T @ Y_c[k].real @ Gamma
        found = Q.path[:, k].sum(axis=0)
        np.testing.assert_allclose(found, through, atol=1e-6 * abs(through).max())
        printed.append(abs(found - 0.5 * np.real(Gamma.conj().T @ Y_c[k] @ Gamma)).max() / abs(found).max())
    assert max(printed) > 0.02


def test_monte_carlo(model):
    """The expected alpha of coherent random phasors against the mean over 20,000 draws, each solved by F^H Q F."""
    inputs, f = ["mesh.transmission_error", "mesh.force"], [150.0, 1200.0]
    rng = np.random.default_rng(3)
    A = np.array([[1e-6, 0.0], [0.8 + 0.6j, 0.5]])  # F = A xi, xi independent with E[|xi|^2] = 1
    S = A @ A.conj().T
    H = gp.frequency_response(model, f, None, inputs).values
    flow = gp.expected_power(model, inputs, S, f)
    xi = (rng.normal(size=(2, 20_000)) + 1j * rng.normal(size=(2, 20_000))) / np.sqrt(2)
    names = list(gp.frequency_response(model, f, None, inputs).output.values)
    for k in range(2):
        response = H[k] @ (A @ xi)
        power = sum(
            0.5
            * np.real(
                response[names.index(path.replace(".", ".force_"))]
                * response[names.index(path.replace(".", ".velocity_"))].conj()
            )
            for path in flow.path.values
        )
        spread = power.std() / np.sqrt(power.size)
        assert abs(power.mean() - float(flow.transmitted_power[k])) < 4 * spread


@pytest.fixture(scope="module")
def model():
    return gp.load("models/gearbox.toml")


@pytest.mark.parametrize(
    ("spectrum", "problem"),
    [
        ([[1.0, 2.0], [2.0, 1.0]], "negative eigenvalue"),
        ([[1.0, 0.1], [0.2, 1.0]], "give a Hermitian matrix"),
        ([[1.0, np.nan], [np.nan, 1.0]], "not finite"),
        (np.eye(3), r"shape \(3, 3\) does not fit 2 inputs and 1 frequencies"),
        ("loud", "is not a matrix"),
        ([1.0, -1.0], "negative eigenvalue"),
    ],
)
def test_spectra_that_cannot_be_are_refused(model, spectrum, problem):
    with pytest.raises(gp.InputError, match=problem):
        gp.expected_power(model, ["mesh.force", "mesh.transmission_error"], spectrum, [100.0])


def test_inputs_named_twice_or_not_at_all_are_refused(model):
    with pytest.raises(gp.InputError, match="named twice"):
        gp.power_matrices(model, [100.0], ["mesh.force", "mesh.force"])
    with pytest.raises(gp.InputError, match="name at least one"):
        gp.power_matrices(model, [100.0], [])


def test_torque_ripple_on_a_freely_spinning_gear():
    """A torque on the pinion against the same machine whose shafts turn: light shafts, torsionally rigid.

    In the planar model it presses on p with m_e r1 / J1; with rz active it is a moment on the gear's node.
    """
    ripple = {"actuators": {"ripple": {"component": "gear_train", "point": "input.pinion", "dof": "rz"}}}
    base = gp.load("models/gearbox.toml").to_dict()
    planar = gp.Model.from_dict({**base, **ripple})
    J1, J2, r1, r2 = 1.8884e-3, 1.9655e-3, 0.04975, 0.05025
    m_e = 1 / (r1**2 / J1 + r2**2 / J2)
    f = [100.0, 700.0, 2200.0]
    outputs = ["bearing_1.force_uy", "bearing_4.force_rx", "casing.velocity_uy"]
    by_torque = gp.frequency_response(planar, f, outputs, "actuators.ripple")
    by_force = gp.frequency_response(planar, f, outputs, "mesh.force")
    np.testing.assert_allclose(by_torque.values, m_e * r1 / J1 * by_force.values, rtol=1e-9)


def test_torque_ripple_where_the_shafts_twist():
    """The planar torque is the limit of shafts that twist with hardly any inertia about their axes."""
    ripple = {"actuators": {"ripple": {"component": "gear_train", "point": "input.pinion", "dof": "rz"}}}
    base = gp.load("models/gearbox.toml").to_dict()
    both = []
    for dofs in (["uy", "rx"], ["uy", "rx", "rz"]):
        data = {**base, **ripple, "dofs": dofs}
        data["materials"] = {"steel": {**base["materials"]["steel"], "density": 100.0}}
        data["joints"] = {
            name: joint
            if joint["kind"] == "mount"
            else {**joint, "stiffness": [[*row, 0.0] for row in joint["stiffness"]] + [[0.0, 0.0, 0.0]]}
            if "rz" in dofs
            else joint
            for name, joint in base["joints"].items()
        }
        model = gp.Model.from_dict(data)
        both.append(gp.frequency_response(model, [100.0, 700.0], ["bearing_1.force_uy"], "actuators.ripple").values)
    np.testing.assert_allclose(both[0], both[1], rtol=2e-3)


def test_spin_sensor_reads_the_gear():
    """theta_1 = m_e r1 / J1 p where no torque drives both gears: the mesh's own transmission error."""
    base = gp.load("models/gearbox.toml").to_dict()
    spin = {"component": "gear_train", "point": "input.pinion", "dof": "rz", "quantity": "velocity"}
    model = gp.Model.from_dict({**base, "sensors": {"spin": spin}})
    H = gp.frequency_response(model, [150.0, 900.0], ["sensors.spin", "mesh.velocity"], "mesh.transmission_error")
    J1, r1 = 1.8884e-3, 0.04975
    m_e = 1 / (r1**2 / J1 + 0.05025**2 / 1.9655e-3)
    np.testing.assert_allclose(H.values[:, 0, 0], m_e * r1 / J1 * H.values[:, 1, 0], rtol=1e-9)
