"""Both FMUs in libcosim (by libcosimpy), connected there; `run` starts `cosimulate_libcosim.py JOB`.

libcosim ends the process on an error, so it gets one of its own. Its fixed-step algorithm moves all FMUs, reads all
outputs and then sets the connected inputs, as the loop of cosimulate_fmpy.py does.
"""

import json
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path

import numpy as np


def is_installed() -> bool:
    """Whether libcosimpy is here (python -m pip install libcosimpy: Linux and Windows on x86-64)."""
    return find_spec("libcosimpy") is not None


def run(
    gearbox: Path, controller: Path | None, step: float, steps: int, outputs: Sequence[str]
) -> dict[str, np.ndarray]:
    """As cosimulate_fmpy.run."""
    from plant import SENSORS, STRUTS  # not in the other process: it starts in a tenth of the time

    with tempfile.TemporaryDirectory() as folder:
        job, result = Path(folder) / "job.json", Path(folder) / "result.npy"
        places = {"gearbox": str(gearbox.resolve()), "controller": str(controller.resolve()) if controller else ""}
        job.write_text(
            json.dumps(
                {
                    **places,
                    "result": str(result),
                    "step": step,
                    "steps": steps,
                    "outputs": list(outputs),
                    "sensors": SENSORS,
                    "struts": STRUTS,
                }
            )
        )
        done = subprocess.run(
            [sys.executable, str(Path(__file__)), str(job)], cwd=folder, capture_output=True, text=True, check=False
        )
        if done.returncode:
            raise RuntimeError(f"libcosim ended with {done.returncode}:\n{done.stdout}{done.stderr}")
        rows = np.load(result)
    return dict(zip((*outputs, *STRUTS), rows.T))


def drive(job: dict) -> np.ndarray:
    """In its own process: connect, move, read; (steps, outputs and struts)."""
    from libcosimpy.CosimEnums import CosimVariableType
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    log_output_level(CosimLogLevel.WARNING)
    execution = CosimExecution.from_step_size(step_size=round(job["step"] * 1e9))  # ns
    slaves = {
        name: execution.add_local_slave(CosimLocalSlave(fmu_path=job[name], instance_name=name))
        for name in ("gearbox", "controller")
        if job[name]
    }
    at = {
        name: {variable.name.decode(): variable.reference for variable in execution.slave_variables(slave)}
        for name, slave in slaves.items()
    }
    wires = [("gearbox", "controller", name) for name in job["sensors"]]
    wires += [("controller", "gearbox", name) for name in job["struts"]]
    for source, target, name in wires if "controller" in slaves else []:
        failed = execution.connect_real_variables(slaves[source], at[source][name], slaves[target], at[target][name])
        if failed:
            raise RuntimeError(f"libcosim does not connect {name}")
    observer = CosimObserver.create_time_series()
    execution.add_observer(observer)
    watched = [(slaves["gearbox"], at["gearbox"][name]) for name in job["outputs"]]
    if "controller" in slaves:
        watched += [(slaves["controller"], at["controller"][name]) for name in job["struts"]]
    for place in watched:
        observer.start_time_series(*place, CosimVariableType.REAL)
    if not execution.step(job["steps"]):
        raise RuntimeError(f"libcosim: {execution.status()}")
    rows = np.zeros((job["steps"], len(job["outputs"]) + len(job["struts"])))
    for column, place in enumerate(watched):
        rows[:, column] = observer.time_series_real_samples(*place, 1, job["steps"])[2]
    return rows


if __name__ == "__main__":
    task = json.loads(Path(sys.argv[1]).read_text())
    np.save(task["result"], drive(task))
