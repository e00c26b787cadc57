"""The network under test: a flexible source on four bearings in a rigid casing on four mounts."""

import numpy as np

from gearpath.network.modal import ModalNetwork
from gearpath.network.records import JointRows, Load, Output

ELASTIC, RIGID, CASING = 20, 4, 3
K2, C2 = np.array([[6e7, -9e5], [-9e5, 8e4]]), np.array([[300.0, 4.0], [4.0, 0.9]])
N = RIGID + ELASTIC + CASING


def gearbox(seed: int = 1, *, excitation="mesh.transmission_error", mesh_moves_bearings=False) -> ModalNetwork:
    """With `mesh_moves_bearings` the mesh displacement d reaches the bearings directly (P d is not zero)."""
    rng = np.random.default_rng(seed)
    hertz = np.geomspace(1.5e3, 500e3, ELASTIC)
    eigenvalues = np.concatenate([np.zeros(RIGID), (2 * np.pi * hertz) ** 2, np.zeros(CASING)])
    casing_scale = 1 / np.sqrt([12.0, 0.15, 0.17])

    def casing_row(dof: str, x: float, z: float) -> np.ndarray:
        row = np.zeros(N)
        row[-CASING:] = np.array([1.0, -z, x] if dof == "uy" else [0.0, 1.0, 0.0]) * casing_scale
        return row

    def source_rows(count: int) -> np.ndarray:
        rows = np.zeros((count, N))
        rows[:, : RIGID + ELASTIC] = rng.normal(size=(count, RIGID + ELASTIC))
        return rows

    joints, outputs = [], []
    K = np.array([[1.2e8, 1.8e6], [1.8e6, 6e4]])
    for i, (x, z) in enumerate([(-0.05, -0.12), (-0.05, 0.12), (0.05, -0.12), (0.05, 0.12)], start=1):
        name, rows = f"bearing_{i}", source_rows(2)
        rows[1] *= 10.0
        receiver = np.vstack([casing_row("uy", x, z), casing_row("rx", x, z)])
        stiffness = K * (1 + 0.1 * i)
        joints.append(JointRows(name, "bearing", ("uy", "rx"), rows, receiver, stiffness, 1e-6 * stiffness))
        outputs += [
            Output(f"{name}.force_uy", "N", "force", joint=name, dof=0),
            Output(f"{name}.force_rx", "N.m", "force", joint=name, dof=1),
            Output(f"{name}.velocity_uy", "m/s", "velocity", row=receiver[0]),
            Output(f"{name}.power", "W", "power", joint=name),
        ]
    for i, (x, z) in enumerate([(-0.09, -0.12), (-0.09, 0.12), (0.09, -0.12), (0.09, 0.12)], start=1):
        name, rows = f"mount_{i}", casing_row("uy", x, z)[None]
        one = np.ones((1, 1))
        joints.append(
            JointRows(name, "mount", ("uy",), rows, 0 * rows, 1e7 * one, 440.0 * one, scalar=True, grounded=True)
        )
        outputs.append(Output(f"{name}.force_uy", "N", "force", joint=name, dof=0))
    outputs += [
        Output("casing.displacement_uy", "m", "displacement", row=casing_row("uy", 0, 0)),
        Output("casing.velocity_uy", "m/s", "velocity", row=casing_row("uy", 0, 0)),
        Output("casing.acceleration_uy", "m/s2", "acceleration", row=casing_row("uy", 0, 0)),
        Output("casing.acceleration_rx", "rad/s2", "acceleration", row=casing_row("rx", 0, 0)),
        Output("sensors.gear", "m/s", "velocity", row=source_rows(1)[0]),
    ]
    mesh = np.zeros(N)
    mesh[: RIGID + ELASTIC] = 0.3 * rng.normal(size=RIGID + ELASTIC)
    if not mesh_moves_bearings:
        P = np.vstack([joint.source for joint in joints])
        mesh -= np.linalg.pinv(P) @ (P @ mesh)
    loads = (
        Load("mesh.transmission_error", "m", mesh, mesh_displacement=mesh, equivalent_mass=0.4),
        Load("mesh.force", "N", source_rows(1)[0]),
        Load("actuators.shaker", "N", casing_row("uy", 0.02, 0.03)),
    )
    return ModalNetwork(
        name="gearbox",
        components={"gear_train": slice(0, RIGID + ELASTIC), "casing": slice(RIGID + ELASTIC, N)},
        modal_damping={"gear_train": 0.015},
        eigenvalues=eigenvalues,
        joints=tuple(joints),
        loads=loads,
        outputs=tuple(outputs),
        excitation=excitation,
        paths=tuple(f"bearing_{i}" for i in range(1, 5)),
    )


def changed(network: ModalNetwork) -> ModalNetwork:
    """The network with the parameters CHANGES."""
    other = network.with_joint("bearing_1", K2, C2).with_joint("mount_2", 4e6 * np.ones((1, 1)), np.zeros((1, 1)))
    object.__setattr__(other, "modal_damping", {"gear_train": 0.07})
    return other


CHANGES = {
    "bearing_1.stiffness": K2,
    "bearing_1.damping": C2,
    "mount_2.stiffness": 4e6,
    "mount_2.damping": 0.0,
    "gear_train.modal_damping": 0.07,
}
