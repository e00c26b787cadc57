"""The operating point of the default gearbox with ball bearings, against scipy's trust region on all its coordinates.

python benchmarks/operating_point.py
"""

import time

import numpy as np
from scipy.linalg import block_diag
from scipy.optimize import minimize

import gearpath as gp
from gearpath.components import DOFS
from gearpath.network.assemble import assemble
from gearpath.network.operation import operating_point

TORQUE, RADIUS = 100.0, 0.04975


def model():
    """The default gearbox with four deep groove ball bearings under 100 N m."""
    data = gp.load("models/gearbox.toml").to_dict()
    for k in range(1, 5):
        between = data["joints"][f"bearing_{k}"]["between"]
        data["joints"][f"bearing_{k}"] = {"kind": "bearing", "between": between, "catalogue": "6206-like"}
    return gp.Model.from_dict({**data, "operation": {"torque": TORQUE}})


def peer(system):
    """Minimum of the energy over every coordinate, from 0; the bearings' displacements and the steps."""
    network = assemble(system)
    K = block_diag(*(s.stiffness for s in network.structures.values()))
    f = np.zeros(len(K))
    f[network.blocks["gear_train"].stop - 1] = (
        TORQUE / RADIUS
    )  # on the gears' relative spin, the train's last coordinate
    rows = {}
    for joint in network.joints:
        B = joint.source - joint.receiver
        if joint.kind == "mount":
            K = K + B.T @ joint.stiffness @ B
        else:
            rows[joint.name] = np.zeros((6, len(K)))
            rows[joint.name][[DOFS.index(dof) for dof in joint.dofs]] = B
    bearing = {name: system.joints[name].mounting.bearing for name in rows}
    size = 1.0 / np.sqrt(np.diag(K) + 1e8)  # scales translations and rotations alike

    def energy(y):
        x = size * y
        return 0.5 * x @ K @ x - f @ x + sum(float(bearing[n].energy(B @ x)) for n, B in rows.items())

    def gradient(y):
        x = size * y
        return size * (K @ x - f + sum(B.T @ bearing[n].load(B @ x) for n, B in rows.items()))

    def hessian(y):
        x = size * y
        return np.outer(size, size) * (K + sum(B.T @ bearing[n].stiffness(B @ x) @ B for n, B in rows.items()))

    found = minimize(
        energy,
        np.zeros(len(f)),
        jac=gradient,
        hess=hessian,
        method="trust-exact",
        options={"gtol": 1e-7, "maxiter": 500},
    )
    return {name: B @ (size * found.x) for name, B in rows.items()}, found.nit


def main():
    system = model().system
    start = time.process_time()
    ours = operating_point(system)
    once = time.process_time() - start
    start = time.process_time()
    theirs, steps = peer(system)
    other = time.process_time() - start
    apart = max(np.abs(theirs[n] - s.displacement).max() / np.abs(s.displacement).max() for n, s in ours.items())
    state = ours["bearing_1"]
    print(f"operating point: {1e3 * once:.0f} ms, {state.iterations} linear solves, residual {state.residual:.0e}")
    print(
        f"scipy's trust-exact on all coordinates: {other / once:.1f} times as long, {steps} steps, apart by {apart:.0e}"
    )


if __name__ == "__main__":
    main()
