"""First steps: exchange a bearing, close a loop with python-control, simulate the FMU with fmpy.

python examples/first_steps.py
"""

import tempfile
from pathlib import Path

import control
import fmpy

import gearpath as gp

MODEL = Path(__file__).resolve().parents[1] / "models" / "gearbox.toml"


def main() -> None:
    """Print what each step finds."""
    model = gp.load(MODEL)
    softer = model.replace({"joints.bearing_1.stiffness": [[6.0e7, 9.0e5], [9.0e5, 3.0e4]]})
    before, after = (gp.power_flow(m, [500.0, 1000.0, 2000.0]).alpha.values for m in (model, softer))
    print("alpha at 500, 1000, 2000 Hz:", before, "with a softer bearing 1:", after)

    plant = gp.state_space(model)
    print("state space:", plant.nstates, "states, damping of the slowest mode", f"{-plant.poles().real.max():.1f} 1/s")
    gain = abs(control.evalfr(plant["casing/velocity_uy", "mesh/force"], 2j * 3.141592653589793 * 1000.0))
    print(f"casing velocity per mesh force at 1 kHz: {gain:.3g} m/(N s)")

    with tempfile.TemporaryDirectory() as folder:
        fmu = gp.export_fmu(model, Path(folder) / "gearbox.fmu")
        result = fmpy.simulate_fmu(
            str(fmu),
            stop_time=0.01,
            output_interval=1e-5,
            start_values={"mesh.force": 10.0},
            output=["bearing_1.force_uy", "casing.velocity_uy"],
        )
    print("largest force of bearing 1 after a step of 10 N at the mesh:", abs(result["bearing_1.force_uy"]).max(), "N")


if __name__ == "__main__":
    main()
