"""Native FMU of a model against python-control: 10,000 steps of 1, 10, 50 and 100 us with held inputs; time a step.

python benchmarks/fmu_accuracy.py [MODEL]
"""

import sys
import tempfile
import time
from pathlib import Path

import control
import numpy as np

import gearpath as gp
from gearpath.api import modal_network
from gearpath.fmu.simulation import running

DEFAULT = Path(__file__).resolve().parents[1] / "models" / "gearbox.toml"
STEPS = 10_000


def main() -> None:
    """Print a line for each step size."""
    model = gp.load(sys.argv[1] if len(sys.argv) > 1 else DEFAULT)
    plant, network = gp.state_space(model), modal_network(model)
    names = [name.replace("/", ".") for name in plant.output_labels]
    scale = np.array([1e-6 if load.is_transmission_error else 1.0 for load in network.loads])
    with tempfile.TemporaryDirectory() as folder:
        fmu_path = gp.export_fmu(model, Path(folder) / "it.fmu")
        for step in (1e-6, 1e-5, 5e-5, 1e-4):
            t = step * np.arange(STEPS + 1)
            rate = 0.4 / step / t[-1] * np.linspace(0.9, 1.0, len(scale))
            u = scale[:, None] * np.sin(np.pi * rate[:, None] * t**2)
            expected = control.forced_response(control.sample_system(plant, step, "zoh"), t, u).outputs.T
            with running(fmu_path) as fmu:
                fmu.start()
                start = time.process_time()
                found = fmu.run(dict(zip((load.name for load in network.loads), u)), step, names)
                spent = time.process_time() - start
            deviation = np.max(abs(found - expected).max(axis=0) / abs(expected).max(axis=0))
            each = 1e6 * spent / STEPS
            print(
                f"step {1e6 * step:4.0f} us: {deviation:.1e} of the largest value; {each:.0f} us a step (fmpy)"
            )


if __name__ == "__main__":
    main()
