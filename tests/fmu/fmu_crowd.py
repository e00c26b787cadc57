"""A thousand instances in a process of their own, so that its memory is theirs: python fmu_crowd.py FMU FOLDER.

Prints a JSON object: bytes an instance takes when made, after steps, and after a bearing was exchanged and steps were
made in the dense form; whether all went different ways, and every seventh bit by bit as it does alone.
"""

import json
import resource
import sys
from pathlib import Path

import numpy as np
from fmu_driver import OK, Fmu

COUNT, CHANGED, STEPS, H = 1000, 100, 10, 1e-5
OUTPUTS = ["bearing_1.force_uy", "casing.velocity_uy", "alpha"]


def resident() -> int:
    """Bytes of this process in memory."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()


def steps(fmu, number: int, first: int = 0) -> np.ndarray:
    """Outputs over steps with inputs that are this instance's own."""
    found = []
    for i in range(first, first + STEPS):
        assert fmu.set({"mesh.transmission_error": 1e-6 * np.cos(number + i), "frequency": 100.0 + number}) == OK
        assert fmu.step(i * H, H) == OK
        found.append(fmu.get(OUTPUTS))
    return np.array(found)


def change(fmu) -> None:
    assert fmu.set({"bearing_1.stiffness[1,1]": 9e7, "bearing_2.damping[2,2]": 0.3}) == OK


def alone(unpacked, number: int) -> tuple[np.ndarray, bytes]:
    fmu = Fmu(unpacked)
    fmu.start()
    found = [steps(fmu, number)]
    if number < CHANGED:
        change(fmu)
        found.append(steps(fmu, number, STEPS))
    end = fmu.serialised()
    fmu.free()
    return np.concatenate(found), end


def main() -> None:
    """All at once; then some alone."""
    unpacked = Fmu.unpack(Path(sys.argv[1]), Path(sys.argv[2]))
    alone(unpacked, 0)  # whatever is loaded once
    start = resident()
    crowd = [Fmu(unpacked, name=str(i).encode()) for i in range(COUNT)]
    for fmu in crowd:
        fmu.start()
    made = resident()
    found = [steps(fmu, i) for i, fmu in enumerate(crowd)]
    stepped = resident()
    for fmu in crowd[:CHANGED]:
        change(fmu)
    for i, fmu in enumerate(crowd[:CHANGED]):
        found[i] = np.concatenate([found[i], steps(fmu, i, STEPS)])
    changed = resident()
    ends = [fmu.serialised() for fmu in crowd]
    for i in np.random.default_rng(1).permutation(COUNT):
        crowd[i].free()
    same = all(
        np.array_equal(found[i], values) and ends[i] == end
        for i, (values, end) in ((i, alone(unpacked, i)) for i in range(0, COUNT, 7))
    )
    distinct = len({values.tobytes() for values in found})
    sizes = {"made": (made - start) / COUNT, "stepped": (stepped - start) / COUNT}
    print(json.dumps(sizes | {"changed": (changed - stepped) / CHANGED, "same": same, "distinct": distinct}))


if __name__ == "__main__":
    main()
