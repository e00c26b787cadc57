"""Random bearings, each as Gearpath's and as the oracle of the tests."""

from math import radians

import numpy as np
from bearing_oracles import BallOracle, RollerOracle

from gearpath.joints.bearings import BallBearing, RollerBearing

KINDS = ("deep groove", "angular", "thrust", "cylindrical", "tapered")


def random_pair(kind, rng, slices=None):
    """A bearing of Gearpath and its oracle."""
    z, phase = int(rng.integers(3, 24)), float(rng.uniform(-7, 7))
    if kind in KINDS[:3]:
        pitch = float(rng.uniform(0.02, 0.3))
        D = float(rng.uniform(0.3, 0.9)) * pitch * np.sin(np.pi / max(z, 6))
        fi, fo = rng.uniform(0.505, 0.54, 2).tolist()
        side = rng.choice([-1, 1])
        angle = {"deep groove": 0.0, "angular": side * radians(rng.uniform(5, 60)), "thrust": side * radians(90)}[kind]
        gap = float(rng.uniform(-5e-6, 2e-5)) if kind == "deep groove" else 0.0
        centres = bool(rng.integers(2))
        reference = "ball_centres" if centres else "groove_centres"
        ours = BallBearing(z, D, pitch, fi, fo, angle, gap, phase=phase, reference=reference)
        return ours, BallOracle(z, D, pitch, fi, fo, angle, gap, phase, centres)
    radius, length = float(rng.uniform(0.01, 0.2)), float(rng.uniform(0.005, 0.05))
    angle = 0.0 if kind == "cylindrical" else rng.choice([-1, 1]) * radians(rng.uniform(5, 35))
    gap, drop = float(rng.uniform(-5e-6, 2e-5)), float(rng.uniform(0, 1e-5))
    slices = int(rng.integers(1, 42)) if slices is None else slices

    def profile(x):
        return drop * (2 * x / length) ** 2 * (1.0 + 0.3 * x / length)  # deeper at one end

    ours = RollerBearing(z, length, radius, angle, slices, gap, profile, phase)
    return ours, RollerOracle(z, length, radius, angle, slices, gap, profile, phase)


def random_displacement(bearing, rng):
    """Six numbers that press some of the elements and free others, mostly."""
    size = 10.0 ** rng.uniform(-6, -4)
    q = rng.normal(size=6) * size
    q[3:] /= bearing.lever
    if bearing.contact_angle:
        q[2] += np.sign(bearing.contact_angle) * rng.uniform(0, 3) * size
    return q


def scaled(K, lever):
    """K with rotations times the lever: entries of one unit."""
    s = np.array([1, 1, 1, 1 / lever, 1 / lever, 1 / lever])[: len(K)]
    return K * np.outer(s, s)
