"""Networks of one or two modes and linear systems that together reach all of the runtime.

Small, so that a fuzzer runs them often.
"""

from dataclasses import replace

import numpy as np

from gearpath.fmu.linear_system import LinearSystem
from gearpath.network.modal import ModalNetwork
from gearpath.network.records import JointRows, Load, MeshSource, Output, Schedule, Tone


def networks() -> dict[str, ModalNetwork]:
    """By name: a bearing and a mount; a gear mesh source; stiffness over torque; critical damping, no modal form."""
    plain = _pair()
    return {
        "plain": plain,
        "source": _with_source(plain),
        "schedule": _with_schedule(plain),
        "critical": _critical(),
    }


def systems() -> dict[str, LinearSystem]:
    """By name: three states in units far apart; a pure gain; states that nothing reaches. All are called `it`."""
    A = np.array([[-200.0, 3e6, 0.0], [-1.0, -50.0, 0.0], [0.0, 2e-3, 0.0]])
    B, C, D = np.array([[1.0, 0.0], [0.0, 1e-6], [0.0, 0.0]]), np.array([[1.0, 0.0, 5.0]]), np.array([[0.0, 2.0]])
    none = np.zeros((0, 0))
    return {
        "given": LinearSystem("it", A, B, C, D, ("u", "v"), ("y",), ("x_1", "x_2", "x_3")),
        "gain": LinearSystem("it", none, none.reshape(0, 1), none.reshape(1, 0), np.array([[2.5]]), ("u",), ("y",), ()),
        "free": LinearSystem("it", A[:2, :2], np.zeros((2, 0)), C[:, :2], np.zeros((1, 0)), (), ("y",), ("x_1", "x_2")),
    }


def _pair() -> ModalNetwork:
    """A shaft with one elastic mode on a bearing, in a rigid casing on a mount."""
    K = np.array([[1.2e8, 1.8e6], [1.8e6, 6e4]])
    source, receiver = np.array([[1.0, 0.0], [5.0, 0.0]]), np.array([[0.0, 0.3], [0.0, 0.1]])
    foot, mesh = np.array([[0.0, 0.3]]), np.array([0.4, 0.0])
    return ModalNetwork(
        name="plain",
        components={"shaft": slice(0, 1), "casing": slice(1, 2)},
        modal_damping={"shaft": 0.015},
        eigenvalues=np.array([(2 * np.pi * 1500.0) ** 2, 0.0]),
        joints=(
            JointRows("bearing", "bearing", ("uy", "rx"), source, receiver, K, 1e-6 * K),
            JointRows("mount", "mount", ("uy",), foot, 0 * foot, np.array([[1e7]]), np.array([[440.0]]), scalar=True),
        ),
        loads=(
            Load("mesh.transmission_error", "m", mesh, mesh_displacement=mesh, equivalent_mass=0.4),
            Load("mesh.force", "N", np.array([1.0, 0.2])),
        ),
        outputs=(
            Output("bearing.force_rx", "N.m", "force", joint="bearing", dof=1),
            Output("bearing.velocity_uy", "m/s", "velocity", row=receiver[0]),
            Output("bearing.power", "W", "power", joint="bearing"),
            Output("casing.displacement_uy", "m", "displacement", row=foot[0]),
            Output("casing.acceleration_uy", "m/s2", "acceleration", row=foot[0]),
        ),
        excitation="mesh.transmission_error",
        paths=("bearing",),
    )


def _with_source(network: ModalNetwork) -> ModalNetwork:
    tones = (
        Tone("mesh.harmonic_1", 1.0, 0.0, 1e-6, 0.3),
        Tone("mesh.harmonic_1.sideband_minus_2", 1.0, -2.0, 2e-7, -1.0),
    )
    source = MeshSource("mesh.transmission_error", 1000.0, 23, tones)
    return replace(network, name="source", source=source, loads=network.loads[:1])


def _with_schedule(network: ModalNetwork) -> ModalNetwork:
    """Both matrices of the bearing, of any rank, and the stiffness of the mount follow the torque."""
    K = network.joints[0].stiffness
    bearing = np.array([0.3 * np.diag(np.diag(K)), [[4e7, 2e6], [2e6, 1e5]], K])
    mount = np.array([[[0.0]], [[1e7]], [[3e7]]])
    schedule = Schedule(
        np.array([-5.0, 20.0, 100.0]), {"bearing": bearing, "mount": mount}, {"bearing": 1e-6 * bearing}, start=30.0
    )
    return replace(network, name="schedule", schedule=schedule, loads=network.loads[:1])


def _critical() -> ModalNetwork:
    """One mass on a critically damped mount: a double pole with one eigenvector, so that no modal form exists."""
    row = np.array([[1.0]])
    return ModalNetwork(
        name="critical",
        components={"casing": slice(0, 1)},
        modal_damping={},
        eigenvalues=np.array([0.0]),
        joints=(JointRows("mount", "mount", ("uy",), row, 0 * row, np.array([[1e6]]), np.array([[2e3]]), scalar=True),),
        loads=(Load("shaker.force", "N", row[0]),),
        outputs=(
            Output("mount.power", "W", "power", joint="mount"),
            Output("casing.displacement_uy", "m", "displacement", row=row[0]),
        ),
        excitation="shaker.force",
        paths=("mount",),
    )
