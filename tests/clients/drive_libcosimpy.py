"""libcosim (with the FMI Library) runs one FMU: `drive_libcosimpy.py JOB`, see client_process.py."""

import json
import sys
from pathlib import Path

from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimManipulator import CosimManipulator
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave

log_output_level(CosimLogLevel.INFO)
job = json.loads(Path(sys.argv[1]).read_text())
execution = CosimExecution.from_step_size(step_size=round(job["step"] * 1e9))
slave = execution.add_local_slave(CosimLocalSlave(fmu_path=job["fmu"], instance_name="gearbox"))
references = {variable.name.decode(): variable.reference for variable in execution.slave_variables(slave)}
loads, observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
assert execution.add_manipulator(loads)
assert execution.add_observer(observer)
for name, value in job["start"].items():
    assert execution.real_initial_value(slave, references[name], value), name
inputs = [references[name] for name in job["inputs"]]
outputs = [references[name] for name in job["outputs"]]
rows = []
for values in job["values"]:
    assert loads.slave_real_values(slave, inputs, values)
    assert execution.step(), execution.status()
    rows.append(observer.last_real_values(slave, outputs))
Path(job["result"]).write_text(json.dumps(rows))
