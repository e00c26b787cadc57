"""Reduction of a plate of 50,000 degrees of freedom: seconds and peak memory of every method, each in its own process.

python benchmarks/reduction.py [ELEMENTS]      elements along each side of the plate, 90 unless given

The peer is the factorisation with SuperLU's default column ordering and pivoting, in the same run.
"""

import json
import resource
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

from gearpath.components import DOFS, Material, Structure
from gearpath.components.footprint import Footprint
from gearpath.components.plate import Plate
from gearpath.reduction import (
    craig_bampton,
    estimated_deviation,
    free_interface,
    hold,
    lanczos,
    port_rows,
    reduced_modes,
)

VECTORS = 60
BAND = 2.0 * np.pi * np.arange(50.0, 2001.0, 50.0)
METHODS = {
    "lanczos": lambda plate: lanczos(plate, VECTORS),
    "craig_bampton": lambda plate: craig_bampton(plate, VECTORS),
    "free_interface": lambda plate: free_interface(plate, VECTORS, residual=True),
}


def casing_plate(elements: int) -> Structure:
    """A steel plate of 400 x 400 x 10 mm with two bearing seats (rigid footprints) and four mounting points."""
    seats = {f"seat_{k}": Footprint((x, 0.0, 0.0), (0.06, 0.06)) for k, x in enumerate((-0.05, 0.05))}
    steel, middle, sides = Material(2.07e11, 0.3, 7850.0), (0.0, 0.0, 0.0), (0.4, 0.4)
    plate = Plate(steel, middle, sides, 0.01, (elements, elements), footprints=seats, modal_damping=0.01)
    corners = {f"mount_{k}": (x, y, 0.0) for k, (x, y) in enumerate([(-0.18, -0.18), (0.18, -0.18), (-0.18, 0.18)])}
    return plate.structure(DOFS, {**{name: name for name in seats}, **corners})


def peak_mb() -> float:
    """Largest resident memory of this process so far."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / 2**20 if sys.platform == "darwin" else peak / 2**10


def child(method: str, elements: int) -> dict[str, object]:
    """Reduce the plate in this process; figures of it."""
    plate = casing_plate(elements)
    built, start = peak_mb(), time.perf_counter()
    if method == "peer":
        held = hold(plate, port_rows(plate))
        ours, start = time.perf_counter() - start, time.perf_counter()
        lu = scipy.sparse.linalg.splu(scipy.sparse.csc_matrix(held.factor.matrix))
        seconds = time.perf_counter() - start
        return {"seconds": seconds, "entries": lu.nnz, "ours": ours, "our_entries": held.factor.entries}
    found = METHODS[method](plate)
    seconds, peak = time.perf_counter() - start, peak_mb()
    start = time.perf_counter()
    basis = reduced_modes(plate, found)
    estimate = estimated_deviation(plate, found, BAND)
    return {
        "coordinates": plate.size,
        "size": found.size,
        "seconds": seconds,
        "built_mb": built,
        "peak_mb": peak,
        "estimate": float(estimate.max()),
        "estimate_seconds": time.perf_counter() - start,
        "estimate_peak_mb": peak_mb(),
        "frequencies": basis.frequencies[6:12].tolist(),
    }


def measured(method: str, elements: int) -> dict[str, object]:
    """Figures of one method, from a process of its own."""
    command = [sys.executable, str(Path(__file__).resolve()), "--child", method, str(elements)]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def main() -> None:
    """Print the table."""
    if sys.argv[1:2] == ["--child"]:
        print(json.dumps(child(sys.argv[2], int(sys.argv[3]))))
        return
    elements = int(sys.argv[1]) if len(sys.argv) > 1 else 90
    for method in METHODS:
        item = measured(method, elements)
        print(
            f"{method:15s} {item['coordinates']} to {item['size']}: {item['seconds']:5.1f} s, "
            f"peak {item['peak_mb']:.0f} MB ({item['built_mb']:.0f} MB before); "
            f"estimated deviation up to 2 kHz {item['estimate']:.1e} "
            f"({item['estimate_seconds']:.1f} s, peak {item['estimate_peak_mb']:.0f} MB)"
        )
    peer = measured("peer", elements)
    print(
        f"SuperLU's default ordering: factor alone {peer['seconds']:.1f} s, {peer['entries'] / 1e6:.0f} million "
        f"entries; here {peer['our_entries'] / 1e6:.0f} million, and {peer['ours']:.1f} s with the constraint modes"
    )


if __name__ == "__main__":
    main()
