"""Stiffness matrices and equilibria of a 14-ball bearing against a plain loop over the balls in numpy.

python benchmarks/bearings.py
"""

import time

import numpy as np
from scipy.optimize import root

from gearpath.joints.bearings import BallBearing

BEARING = BallBearing(14, 12.7e-3, 70e-3, 0.515, 0.525, 0.45)
LOAD = {"ux": 1500.0, "uy": -400.0, "uz": 3000.0, "rx": 4.0, "ry": 6.0}


def plain(bearing, q):
    """Load (5,) and stiffness (5, 5) at one displacement, ball after ball."""
    a, rest, r, Kn = bearing.contact_angle, bearing.groove_distance, bearing.lever, bearing.contact_stiffness
    f, K = np.zeros(5), np.zeros((5, 5))
    for j in range(bearing.balls):
        psi = bearing.phase + 2 * np.pi * j / bearing.balls
        c, s = np.cos(psi), np.sin(psi)
        G = np.array([[c, s, 0, 0, 0], [0, 0, 1, r * s, -r * c]])
        star = rest * np.array([np.cos(a), np.sin(a)]) + G @ q
        length = np.hypot(*star)
        if length > rest:
            e, d = star / length, length - rest
            load, along = Kn * d**1.5, np.outer(e, e)
            f += G.T @ e * load
            K += G.T @ (1.5 * load / d * along + load / length * (np.eye(2) - along)) @ G
    return f, K


def seconds(function, repeats):
    """Median process time of a call, s."""
    times = []
    for _ in range(repeats):
        start = time.process_time()
        function()
        times.append(time.process_time() - start)
    return float(np.median(times))


def main():
    rng = np.random.default_rng(0)
    q = rng.normal(size=(10_000, 6)) * [1e-5, 1e-5, 1e-5, 1e-4, 1e-4, 0]
    few = q[:500, :5]
    K = BEARING.stiffness(q)
    worst = max(np.abs(plain(BEARING, few[i])[1] - K[i, :5, :5]).max() for i in range(len(few))) / np.abs(K).max()
    ours, loop = seconds(lambda: BEARING.stiffness(q), 7), seconds(lambda: [plain(BEARING, x) for x in few], 3) * 20
    print(
        f"10,000 stiffness matrices: {ours:.3f} s, {loop / ours:.0f} times faster than the loop; apart by {worst:.1e}"
    )

    wanted, unit = np.array(list(LOAD.values())), np.array([1, 1, 1, BEARING.lever, BEARING.lever])
    size = 1e-5 / unit

    def peer():
        """scipy's hybrid method with the exact Jacobian, from an axial displacement."""
        return root(
            lambda x: (plain(BEARING, x * size)[0] - wanted) / unit,
            [0, 0, 1, 0, 0],
            jac=lambda x: plain(BEARING, x * size)[1] * size / unit[:, None],
            options={"xtol": 1e-12},
        )

    found = BEARING.equilibrium(LOAD)
    apart = np.abs(peer().x * size - found.displacement[:5]).max() / np.abs(found.displacement).max()
    ours, loop = seconds(lambda: BEARING.equilibrium(LOAD), 21), seconds(peer, 5)
    print(
        f"one equilibrium: {1e3 * ours:.1f} ms in {found.iterations} iterations, {loop / ours:.1f} times faster than "
        f"scipy's root on the loop; apart by {apart:.1e}"
    )


if __name__ == "__main__":
    main()
