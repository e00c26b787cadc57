"""Ecos (with fmi4c) runs one FMU: `drive_ecospy.py JOB`, see client_process.py."""

import json
import sys
from pathlib import Path

from ecospy import EcosLib, EcosSimulation, EcosSimulationStructure

EcosLib.set_log_level("debug")
job = json.loads(Path(sys.argv[1]).read_text())
rows = []
with EcosSimulationStructure() as structure:
    structure.add_model("gearbox", job["fmu"])
    assert structure.add_parameter_set("start", {f"gearbox::{name}": value for name, value in job["start"].items()})
    with EcosSimulation(structure=structure, step_size=job["step"]) as simulation:
        assert simulation.init(parameter_set="start"), EcosLib.get_last_error()
        for values in job["values"]:
            for name, value in zip(job["inputs"], values):
                simulation.set_real(f"gearbox::{name}", value)
            simulation.step()
            rows.append([simulation.get_real(f"gearbox::{name}") for name in job["outputs"]])
        simulation.terminate()
Path(job["result"]).write_text(json.dumps(rows))
