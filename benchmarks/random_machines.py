"""Worst figures of the invariants over random gearboxes, as the tests assert them.

python benchmarks/random_machines.py [COUNT]
"""

import sys
from pathlib import Path

import numpy as np
from rich.progress import track

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from systems import random_gearbox

from gearpath.network.assemble import assemble
from gearpath.network.power import power_flow
from gearpath.network.reference import reference_solution
from gearpath.network.synthesis import Synthesis

LINES = 2 * np.pi * np.geomspace(20.0, 5000.0, 7)


def figures(system):
    """Deviations of one machine: forces, alpha, power balance, returned power, alpha above one."""
    network = assemble(system)
    modal = network.modal()
    load = next(item for item in modal.loads if item.name == modal.excitation)
    force = Synthesis(modal, [load]).solve(LINES).force[:, 0]
    reference, flow = reference_solution(network, LINES), power_flow(modal, LINES)
    rotation = np.array([dof[0] == "r" for joint in modal.joints for dof in joint.dofs])
    worst = 0.0
    for rows in (rotation, ~rotation):
        if rows.any():
            size = abs(reference.force[rows]).max(axis=0)
            worst = max(worst, np.max(abs(force - reference.force)[rows].max(axis=0) / size))
    gross = abs(flow.path_power).sum(axis=0) / flow.input_power
    return (
        worst,
        np.max(abs(flow.share() - reference.alpha) / gross),
        np.max(abs(flow.dissipated_power.sum(axis=0) / flow.input_power - 1)),
        np.max(-flow.transmitted_power / flow.input_power),
        np.max(flow.share() - 1),
    )


def main() -> None:
    """Print the worst of all machines."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    rows = [figures(random_gearbox(seed, seed % 8 + 1)) for seed in track(range(count), "random gearboxes")]
    names = (
        "forces against the unsynthesised solution, relative to the largest of their kind",
        "alpha against the unsynthesised solution, relative to what flows",
        "input power against the sum of dissipated powers",
        "net power returned, part of the input power (negative: none)",
        "alpha - 1 (negative: below 1)",
    )
    for name, value in zip(names, np.max(rows, axis=0)):
        print(f"{value:9.1e}  {name}")


if __name__ == "__main__":
    main()
