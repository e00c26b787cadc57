"""Where the fuzzers start: models, states and call sequences, made from exported FMUs.

    python tests/safety/safety_corpus.py FOLDER

writes FOLDER/models2 and FOLDER/models3 (a model in each numbered folder, for GEARPATH_FUZZ_MODELS) and
FOLDER/TARGET, the corpus of each fuzzer.
"""

import random
import sys
from pathlib import Path

from fmpy.fmi2 import FMU2Slave
from safety_fmus import SmallFmu, export_all

LOCATIONS = (
    "file:///tmp/a%20b/resources",
    "file:/C:/x",
    "file://localhost/D:/x+y#1?z",
    "file:///C|/%C3%BC%F0%9F%94%A7",
    "file://server/share/%e2%82%ac",
    "\\\\server\\share",
    "/plain/100%41/%zz/%",
)


def write(folder: Path) -> None:
    """Write all of it; nothing is random, so that a run of a fuzzer can be repeated."""
    counts = dict.fromkeys("23", 0)
    for fmu in export_all(folder / "fmus"):
        short = fmu.fmi[0]
        place = folder / f"models{short}" / str(counts[short])
        place.mkdir(parents=True)
        (place / "model.bin").write_bytes(fmu.model)
        _add(folder / "model", fmu.model)
        if short == "2":
            which = 2 * counts[short]  # co-simulation; the next is model exchange
            _add(folder / "state", bytes([which, 0]) + _state(fmu))
            _add(folder / "state", bytes([which + 1, 0]))
        counts[short] += 1
    for short in counts:
        for sequence in _sequences(random.Random(int(short))):
            _add(folder / f"fmi{short}", sequence)
    for location in LOCATIONS:
        _add(folder / "path", location.encode())


def _state(small: SmallFmu) -> bytes:
    """The state after three steps, as fmpy gets it."""
    fmu = FMU2Slave(guid=small.guid, unzipDirectory=str(small.folder), modelIdentifier="it", instanceName="it")
    fmu.instantiate()
    fmu.setupExperiment(startTime=0.0)
    fmu.enterInitializationMode()
    fmu.exitInitializationMode()
    for i in range(3):
        fmu.doStep(i * 1e-5, 1e-5)
    state = fmu.getFMUstate()
    blob = bytes(fmu.serializeFMUstate(state))
    fmu.freeFMUstate(state)
    fmu.terminate()
    fmu.freeInstance()
    return blob


def _sequences(rng: random.Random) -> list[bytes]:
    """Sets, steps and gets from every starting phase on every model, and states kept and restored in between."""
    found = []
    for start in range(32):
        calls = [
            bytes([11, 0, 2, 0, 0, 0, 1, 3, 0, 4, 4, 4, 4]),
            bytes([6, 0, 0, 0, 0]),
            bytes([4, 0, 0, 1, 0]),
            bytes([14, 0, 4, 0, 0, 10, 20, 30, 40, 0, 0]),
            bytes([3 + 16 * (start % 5), 0, 0, 0, *[3] * 8]),
            bytes([8, 0, 2, 2, 0, 30, 31, 0, 0, 0, 1, 1, 1, 1, 1]),
            bytes([4 + 48, 0, 0, 1, 0, 0, 0, 0]),
            bytes([4 + 16, 0, 0, 1, 0]),
        ]
        rng.shuffle(calls)
        found.append(bytes([start]) + b"".join(calls * 2))
        found.append(bytes([start]) + rng.randbytes(200))
    return found


def _add(folder: Path, content: bytes) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{len(list(folder.iterdir())):03}").write_bytes(content)


if __name__ == "__main__":
    write(Path(sys.argv[1]))
