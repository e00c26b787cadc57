"""A gearbox whose joints follow the torque, and what it is at one torque: by numpy.interp, entry by entry."""

from dataclasses import replace

import numpy as np
from fmi3_driver import Fmu3
from fmu_driver import Fmu
from fmu_networks import gearbox

from gearpath.network.records import Schedule

TORQUE = "operation.torque"
TORQUES = np.array([10.0, 25.0, 40.0, 100.0])
START = 32.5  # between two points
SCALE = np.array([1e4, 3e2])  # square roots of N/m and N m/rad


def random_tables(rng, count, ranks):
    """Positive semidefinite matrices of these ranks in turn, full, on uy and rx."""
    tables = []
    for i in range(count):
        F = SCALE[:, None] * rng.normal(size=(2, ranks[i % len(ranks)]))
        tables.append(F @ F.T)
    return np.array(tables)


def machine(seed=1, *, torques=TORQUES, start=START, mesh_moves_bearings=True):
    """Bearing 1: K; bearing 2: K and C, apart from each other; mount 1, a single number: K, at first none."""
    rng = np.random.default_rng(seed)
    network = gearbox(seed, mesh_moves_bearings=mesh_moves_bearings)
    K = {f"bearing_{i}": random_tables(rng, len(torques), (2, 1)) for i in (1, 2)}
    K["mount_1"] = np.linspace(0.0, 3e7, len(torques))[:, None, None]
    C = {"bearing_2": 1e-6 * random_tables(rng, len(torques), (1, 2))}
    return replace(network, schedule=Schedule(np.asarray(torques), K, C, start=start))


def interpolated(network, torque):
    """The network without schedule at a torque: the first and last matrices beyond the table."""
    schedule, joints = network.schedule, []
    for joint in network.joints:
        matrices = {}
        for what, tables in (("stiffness", schedule.stiffness), ("damping", schedule.damping)):
            table = tables.get(joint.name)
            if table is not None:
                d = range(len(joint.dofs))
                at = [[np.interp(torque, schedule.torques, table[:, i, k]) for k in d] for i in d]
                matrices[what] = np.array(at)
        joints.append(replace(joint, **matrices))
    return replace(network, joints=tuple(joints), schedule=None)


def new(unpacked, version, *, exchange=False, phase=""):
    """An instance of either version, brought to a phase."""
    fmu = Fmu3(unpacked, exchange=exchange) if version == 3 else Fmu(unpacked, kind=int(not exchange))
    fmu.enter(phase or ("continuous" if exchange else "stepping"))
    return fmu


def read_matrix(fmu, version, name, size=2):
    """A matrix of a joint, whole or by entries."""
    if version == 3:
        return fmu.get([name]).reshape(size, size)
    if size == 1:
        return fmu.get([name]).reshape(1, 1)
    pairs = [(min(i, k) + 1, max(i, k) + 1) for i in range(size) for k in range(size)]
    return fmu.get([f"{name}[{i},{k}]" for i, k in pairs]).reshape(size, size)
