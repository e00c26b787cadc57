"""Bearings in situ: K and C of all four from mobilities of the assembled gearbox, with 0, 1 and 5 % noise.

    python examples/identify_bearing.py

The measurement is simulated from models/gearbox.toml. Nothing of shafts and casing is told to the identification; only
the last line, of one bearing by itself, uses the gearbox without it.
"""

from pathlib import Path

import numpy as np

import gearpath as gp

MODEL = Path(__file__).resolve().parents[1] / "models" / "gearbox.toml"
LINES = np.linspace(20.0, 5000.0, 40)
ENTRIES = [("uy,uy", 0, 0), ("uy,rx", 0, 1), ("rx,rx", 1, 1)]


def main() -> None:
    """Print estimates and 95 % intervals beside the truth."""
    model = gp.load(MODEL)
    for noise in (0.0, 0.01, 0.05):
        found = gp.identify_joint(gp.measure_joint(model, LINES, noise=noise, seed=1))
        print(f"\nnoise {noise:.0%} of each FRF: {found.lines} of {len(LINES)} lines used, {found.noise:.2g} found")
        print(f"{'bearing':10} {'entry':6} {'K, true':>10} {'K':>10} {'+-':>8} {'C, true':>9} {'C':>9} {'+-':>8}")
        for name, joint in found.joints.items():
            table(model, name, joint)
        for line, why in found.discarded.items():
            print(f"  {line:.4g} Hz: {why}")
        talk = found.cross_talk
        print(f"  stiffness between bearings: none in the model, probability of the data {talk.probability:.2g}")
    Y = gp.measure_joint(model, LINES, ["bearing_2"], noise=0.01, seed=1)
    rest = gp.measure_joint(model, LINES, ["bearing_2"], connected=False)
    print("\nbearing 2 alone, 1 % noise, the gearbox without it known:")
    table(model, "bearing_2", gp.identify_joint(Y, without=rest).joints["bearing_2"])


def table(model, name, joint) -> None:
    """One line an entry: truth, estimate and half the 95 % interval."""
    given = model.system.joints[name]
    for entry, i, j in ENTRIES:
        K, C = given.stiffness[i][j], given.damping[i][j]
        dK, dC = 1.96 * joint.stiffness_error[i, j], 1.96 * joint.damping_error[i, j]
        print(
            f"{name:10} {entry:6} {K:10.3g} {joint.stiffness[i, j]:10.4g} {dK:8.1g} "
            f"{C:9.3g} {joint.damping[i, j]:9.3g} {dC:8.1g}"
        )


if __name__ == "__main__":
    main()
