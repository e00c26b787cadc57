"""What the python FMU computes, against independent references."""

from ctypes import byref, create_string_buffer
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
import scipy.signal

pytest.importorskip("fmpy")
pytest.importorskip("pythonfmu")

import fmpy
from fmpy.fmi2 import fmi2FMUstate
from python_gearbox import MOUNTS, Host, export, gearbox

from gearpath.components.mobility import modal_damping_matrix
from gearpath.network.assemble import assemble
from gearpath.network.power import is_moment_path, power_flow
from gearpath.network.response import frequency_response
from gearpath.network.time_twin import time_twin

FREQUENCIES = (55.0, 731.0, 2900.0)
STEP = 1e-5


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return export(gearbox(), tmp_path_factory.mktemp("python") / "gearbox.fmu")


def physical_system(system, force, outputs):
    """A, B, C of M q'' + D q' + K q = f in the physical coordinates: no modes, no mobilities.

    The states are 1e4 L^T q and L^T q' with M = L L^T, which keeps the digits of the matrix exponential.
    """
    network = assemble(system)
    structures = network.structures.values()
    M = scipy.linalg.block_diag(*(s.mass for s in structures))
    K = scipy.linalg.block_diag(*(s.stiffness for s in structures))
    D = scipy.linalg.block_diag(*(modal_damping_matrix(s) for s in structures))
    inverse = np.linalg.inv(np.linalg.cholesky(M))
    n, w = len(M), 1e4
    rows = []
    for joint in network.joints:
        B = joint.relative
        K, D = K + B.T @ joint.stiffness @ B, D + B.T @ joint.damping @ B
        for dof, k, c in zip(joint.dofs, joint.stiffness, joint.damping):
            if f"{joint.name}.force_{dof}" in outputs:
                rows.append(np.concatenate([k @ B @ inverse.T / w, c @ B @ inverse.T]))
    for output in network.outputs:
        if output.quantity == "velocity" and output.name in outputs:
            rows.append(np.concatenate([np.zeros(n), output.row @ inverse.T]))
    load = next(item for item in network.loads if item.name == force)
    A = np.block([[np.zeros((n, n)), w * np.eye(n)], [-inverse @ K @ inverse.T / w, -inverse @ D @ inverse.T]])
    b = np.concatenate([np.zeros(n), inverse @ load.column])
    return A, b[:, None], np.array(rows)


def sweep(samples):
    t = STEP * np.arange(samples)
    return t, 100.0 * np.sin(2 * np.pi * (200.0 * t + 0.5 * 1.5e5 * t**2))


def test_simulation_against_zero_order_hold_in_physical_coordinates(path):
    names = ["bearing_1.force_uy", "bearing_3.force_rx", "mount_2.force_uy", "casing.velocity_uy"]
    t, u = sweep(1001)
    signal = np.array(list(zip(t, u)), dtype=[("time", float), ("mesh.force", float)])
    found = fmpy.simulate_fmu(
        str(path), stop_time=t[-1], step_size=STEP, output_interval=STEP, input=signal, output=names
    )
    A, B, C = physical_system(gearbox(), "mesh.force", names)
    discrete = scipy.signal.cont2discrete((A, B, C, np.zeros((4, 1))), STEP, method="zoh")
    _, expected, _ = scipy.signal.dlsim(discrete, u[:, None])
    for k, name in enumerate(names):
        assert abs(found[name] - expected[:, k]).max() < 1e-10 * abs(expected[:, k]).max(), name


def test_transmission_error_against_python_control(path):
    control = pytest.importorskip("control")
    twin = time_twin(assemble(gearbox()).modal())
    e = [load.name for load in twin.loads].index("mesh.transmission_error")
    names = [output.name for output in twin.outputs]
    t, u = sweep(501)
    host, found = Host(path).start(), []
    for time, value in zip(t, 1e-8 * u):
        host.set({"mesh.transmission_error": value})
        found.append(host.get(*names))
        host.slave.doStep(time, STEP)
    host.free()
    sampled = control.ss(twin.A, twin.B[:, [e]], twin.C, twin.D[:, [e]]).sample(STEP, method="zoh")
    expected = control.forced_response(sampled, t, 1e-8 * u).outputs
    scale = abs(expected).max(axis=1)
    assert (abs(np.array(found).T - expected).max(axis=1) <= 1e-10 * scale).all()


def test_power_is_force_times_receiver_velocity_and_follows_an_input_at_once(path):
    host = Host(path).start()
    host.set({"mesh.force": 100.0})
    for k in range(50):
        host.slave.doStep(k * STEP, STEP)
    names = [f"bearing_1.{part}_{dof}" for dof in ("uy", "rx") for part in ("force", "velocity")]
    f1, v1, f2, v2 = host.get(*names)
    assert host.get("bearing_1.power")[0] == pytest.approx(f1 * v1 + f2 * v2, rel=1e-14)
    before = host.get("mesh.velocity", "casing.velocity_uy")
    host.set({"mesh.transmission_error": 1e-5})
    assert host.get("bearing_1.force_uy") != [f1]  # through the modal damping of the gear train
    host.set({"mesh.transmission_error": 0.0})
    assert host.get("mesh.velocity", "casing.velocity_uy") == before
    host.free()


def test_steps_of_any_size_give_the_same(path):
    ends = []
    for steps in ((1e-5,) * 20, (1e-4, 5e-5, 2.5e-5, 2.5e-5), (2e-4,)):
        host, time = Host(path).start(), 0.0
        host.set({"mesh.force": 100.0})
        for step in steps:
            host.slave.doStep(time, step)
            time += step
        ends.append(host.get("bearing_1.force_uy", "casing.velocity_uy"))
        host.free()
    assert ends[1] == pytest.approx(ends[0], rel=1e-10)
    assert ends[2] == pytest.approx(ends[0], rel=1e-10)


def expected_response(system, frequency):
    """Every frequency output of a directly built system."""
    network, omega = assemble(system).modal(), np.array([2 * np.pi * frequency])
    flow = power_flow(network, omega)
    values = {
        "alpha": flow.share()[0],
        "alpha_force": flow.share(lambda path: not is_moment_path(path))[0],
        "alpha_moment": flow.share(is_moment_path)[0],
    }
    for name in network.paths:
        values[f"{name}.alpha"] = flow.share(lambda path, name=name: path.startswith(f"{name}."))[0]
    load = next(item for item in network.loads if item.name == network.excitation)
    outputs = [output for output in network.outputs if output.quantity != "power"]
    for output, value in zip(outputs, frequency_response(network, omega, outputs, [load])[0, :, 0]):
        values[f"frf.{output.name}"] = value
    return values


def found_response(host, names):
    found = {}
    for name in names:
        parts = host.get(f"{name}.re", f"{name}.im") if name.startswith("frf.") else host.get(name)
        found[name] = complex(*parts)
    return found


def assert_responses(host, system):
    for frequency in FREQUENCIES:
        host.set({"frequency": frequency})
        expected = expected_response(system, frequency)
        for name, value in found_response(host, expected).items():
            # what symmetry makes zero, or nearly, is rounding of others of its kind
            scale = max(abs(v) for n, v in expected.items() if kind(n) == kind(name))
            assert abs(value - expected[name]) <= 1e-9 * abs(expected[name]) + 1e-13 * scale, (
                name,
                frequency,
            )


def kind(name):
    return name.rsplit(".", 1)[1] if name.startswith("frf.") else "ratio"


def moved_mounts(at):
    return (at, *MOUNTS[1:])


DESIGNS = {
    "nothing": ({}, {}),
    "centre": (
        {"casing.centre_of_gravity[1]": 0.02, "casing.centre_of_gravity[3]": -0.03},
        {"centre": (0.02, 0.0, -0.03)},
    ),
    "mass": ({"casing.mass": 17.0}, {"mass": 17.0}),
    "inertia": ({"casing.inertia_xx": 0.21}, {"ixx": 0.21}),
    "length": ({"gear_train.input.length": 0.31}, {"lengths": (0.31, 0.25)}),
    "diameter": ({"gear_train.input.diameter": 0.036}, {"diameter": 0.036}),
    "mesh": ({"mesh.position": -0.03125}, {"gears": (0.09375, 0.09375)}),  # exact in binary
    "mount": (
        {"mount_1.position[1]": -0.11, "mount_1.position[3]": -0.07},
        {"mounts": moved_mounts((-0.11, 0.0, -0.07))},
    ),
    "all": (
        {
            "mesh.position": 0.03,  # set first, and absolute all the same
            "gear_train.output.length": 0.29,
            "gear_train.input.length": 0.31,
            "casing.mass": 17.0,
            "casing.centre_of_gravity[1]": 0.02,
        },
        {"lengths": (0.31, 0.29), "gears": (0.155, 0.155), "mass": 17.0, "centre": (0.02, 0.0, 0.0)},
    ),
}


@pytest.mark.parametrize("design", DESIGNS)
def test_frequency_outputs_of_a_changed_design(path, design):
    values, changes = DESIGNS[design]
    host = Host(path).start(**values)
    assert host.get(*values) == list(values.values())
    assert_responses(host, gearbox(**changes))
    host.free()


def test_unset_mesh_position_follows_the_shaft(path):
    host = Host(path).start(**{"gear_train.input.length": 0.31})
    assert host.get("mesh.position") == pytest.approx([0.03])
    host.free()


def test_time_outputs_of_a_changed_design(path):
    names = ["bearing_1.force_uy", "casing.velocity_uy"]
    host = Host(path).start(**DESIGNS["all"][0])
    host.set({"mesh.force": 100.0})
    found = []
    for k in range(100):
        found.append(host.get(*names))
        host.slave.doStep(k * STEP, STEP)
    host.free()
    A, B, C = physical_system(gearbox(**DESIGNS["all"][1]), "mesh.force", names)
    discrete = scipy.signal.cont2discrete((A, B, C, np.zeros((2, 1))), STEP, method="zoh")
    _, expected, _ = scipy.signal.dlsim(discrete, np.full((100, 1), 100.0))
    assert (abs(found - expected).max(axis=0) < 1e-10 * abs(expected).max(axis=0)).all()


def test_joint_parameters_and_modal_damping_while_running(path):
    host = Host(path).start()
    host.slave.doStep(0.0, STEP)
    values = {"bearing_2.stiffness[1,2]": 1e6, "mount_3.damping": 300.0, "gear_train.modal_damping": 0.04}
    host.set(values)
    system = gearbox(modal_damping=0.04)
    joints = dict(system.joints)
    joints["bearing_2"] = replace(joints["bearing_2"], stiffness=((1.2e8, 1e6), (1e6, 6e4)))
    joints["mount_3"] = replace(joints["mount_3"], damping=((300.0,),))
    assert_responses(host, replace(system, joints=joints))
    host.free()


@pytest.mark.parametrize("zeta", [0.03, 0.0])
def test_a_change_of_modal_damping_moves_nothing_at_rest(path, zeta):
    """At rest under a held transmission error: a velocity does not jump with a damping ratio, nor later.

    The steps of 20 us have a fixed point of their own, 1e-7 off by rounding with any damping ratio.
    """
    names = ["mesh.velocity", "bearing_1.force_uy", "bearing_3.force_rx", "casing.velocity_uy"]
    host = Host(path).start()
    host.set({"mesh.transmission_error": 1e-6})
    kick = abs(np.array(host.get(*names)))
    host.slave.doStep(0.0, 1e-3)
    kick = np.maximum(kick, abs(np.array(host.get(*names))))
    host.slave.doStep(1e-3, 30.0)  # exact steps: one is enough to come to rest
    rest = np.array(host.get(*names))
    host.set({"gear_train.modal_damping": zeta})
    assert (abs(np.array(host.get(*names)) - rest) < 1e-9 * kick).all()
    for k in range(50):
        assert (abs(np.array(host.get(*names)) - rest) < 1e-5 * kick).all(), k
        host.slave.doStep(30.001 + k * 2e-5, 2e-5)
    host.free()


def test_a_restored_state_takes_over_a_change_of_modal_damping_alike(path):
    names = ["mesh.velocity", "bearing_1.force_uy"]
    one, other = Host(path).start(), Host(path).start()
    one.set({"mesh.transmission_error": 1e-6})
    one.slave.doStep(0.0, 1e-4)
    one.set({"gear_train.modal_damping": 0.04})
    state = one.slave.getFMUstate()
    content = one.slave.serializeFMUstate(state)
    copy, buffer = fmi2FMUstate(), create_string_buffer(content, len(content))
    other.slave.fmi2DeSerializeFMUstate(other.slave.component, buffer, len(content), byref(copy))
    other.slave.setFMUstate(copy)
    assert other.get(*names) == one.get(*names)
    one.slave.doStep(1e-4, 1e-4)
    other.slave.doStep(1e-4, 1e-4)
    assert other.get(*names) == one.get(*names)
    one.free()
    other.free()


def test_fmus_of_different_models_and_of_the_same_model_in_one_process(path, tmp_path):
    other = export(gearbox(mass=20.0, lengths=(0.3, 0.3)), tmp_path / "other.fmu")
    hosts = [Host(path).start(), Host(other).start(), Host(path).start(**{"casing.mass": 15.0})]
    for host in hosts:
        host.set({"mesh.force": 100.0})
    for k in range(20):
        for host in hosts:
            host.slave.doStep(k * STEP, STEP)
    systems = (gearbox(), gearbox(mass=20.0, lengths=(0.3, 0.3)), gearbox(mass=15.0))
    for host, system in zip(hosts, systems):
        assert_responses(host, system)
        A, B, C = physical_system(system, "mesh.force", ["casing.velocity_uy"])
        x = scipy.linalg.solve(A, (scipy.linalg.expm(A * 20 * STEP) - np.eye(len(A))) @ B * 100.0)
        assert host.get("casing.velocity_uy")[0] == pytest.approx((C @ x).item(), rel=1e-7)
    for host in hosts:
        host.free()


def test_declared_dependencies_hold_in_every_design(path):
    description = fmpy.read_model_description(str(path))
    declared = {unknown.variable.name: {v.name for v in unknown.dependencies} for unknown in description.outputs}
    for _, changes in DESIGNS.values():
        network = assemble(gearbox(**changes)).modal()
        twin = time_twin(network)
        for output, row in zip(twin.outputs, twin.D):
            used = {load.name for load, d in zip(twin.loads, row) if abs(d) > 1e-12 * abs(twin.D).max()}
            assert used <= declared.get(output.name, used), output.name
