"""Clients in a process of their own: C++ libraries that end the process on an error, or need their own environment."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
from client_reference import FREQUENCY, LOADS, WATCHED

HERE = Path(__file__).parent
COMPLAINT = re.compile(r"\[(warning|error|fatal|critical)\]|Traceback|exception", re.IGNORECASE)


def drive(script, fmu, steps, folder, *, parameters=None, environment=None, outputs=WATCHED):
    """Run `drive_<client>.py` over the steps; the outputs at the end of every step, by name.

    Fails where the process does not end with 0, or where anything that it prints is a warning or an error.
    """
    job, result = folder / "job.json", folder / "result.json"
    job.write_text(
        json.dumps(
            {
                "fmu": str(fmu),
                "step": steps.step,
                "inputs": list(LOADS),
                "values": steps.loads.tolist(),
                "start": {"frequency": FREQUENCY, **(parameters or {})},
                "outputs": list(outputs),
                "result": str(result),
            }
        )
    )
    done = subprocess.run(
        [sys.executable, HERE / script, job],
        cwd=folder,
        env={**os.environ, "TMPDIR": str(folder), **(environment or {})},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    assert not [line for line in said.splitlines() if COMPLAINT.search(line)], said
    return dict(zip(outputs, np.array(json.loads(result.read_text())).T))
