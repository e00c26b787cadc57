"""Native FMU of a model against python-control: 10,000 steps of 1 to 100 us, inputs held and linear; time a step.

    python benchmarks/fmu_accuracy.py [MODEL]

python-control discretises by scipy's matrix exponential, which is accurate relative to the largest pole only: over
10,000 steps of 100 us the default gearbox then differs by 2.5e-11 from an evaluation in extended precision, the FMU
by 2e-13. So python-control gets the state equations in modal coordinates, where every block of A has a size of its own;
the coordinates are found here, in extended precision, by LAPACK and Newton's iteration.
"""

import sys
import tempfile
import time
from pathlib import Path

import control
import numpy as np
import scipy.linalg

import gearpath as gp
from gearpath.api import modal_network
from gearpath.fmu.simulation import running

DEFAULT = Path(__file__).resolve().parents[1] / "models" / "gearbox.toml"
STEPS = 10_000


def in_modal_coordinates(plant: control.StateSpace) -> control.StateSpace:
    """The same transfers, A in blocks [[a, b], [-b, a]] of its poles a + i b."""
    poles, V = scipy.linalg.eig(plant.A)
    A, identity = plant.A.astype(np.longdouble), np.eye(len(poles))
    inverse = scipy.linalg.inv(V).astype(np.clongdouble)
    V = V.astype(np.clongdouble)
    upper = poles.imag > 0
    for _ in range(3):
        inverse = inverse @ (2 * identity - V @ inverse)
        nearly = inverse @ (A @ V)
        poles = nearly.diagonal().copy()
        gap = poles - poles[:, None]
        np.fill_diagonal(gap, np.inf)
        V = V @ (identity + (nearly - np.diag(poles)) / gap)
    for _ in range(3):
        inverse = inverse @ (2 * identity - V @ inverse)
    poles = (inverse @ (A @ V)).diagonal()[upper]
    B, C = inverse[upper] @ plant.B, plant.C @ V[:, upper]
    blocks = scipy.linalg.block_diag(*([[p.real, p.imag], [-p.imag, p.real]] for p in poles.astype(complex)))
    inputs = np.stack([2 * B.real, -2 * B.imag], axis=1).reshape(len(blocks), -1)
    outputs = np.stack([C.real, C.imag], axis=2).reshape(-1, len(blocks))
    return control.StateSpace(blocks, inputs.astype(float), outputs.astype(float), plant.D)


def deviation(model, fmu_path, step: float, *, linear: bool, fmi_steps: int = STEPS) -> tuple[float, float]:
    """Largest deviation relative to each output's largest value, and CPU time of a step through fmpy, us."""
    plant, loads = gp.state_space(model), modal_network(model).loads
    names = [name.replace("/", ".") for name in plant.output_labels]
    scale = np.array([1e-6 if load.is_transmission_error else 1.0 for load in loads])
    t = step * np.arange(fmi_steps + 1)
    rate = 0.4 / step / t[-1] * np.linspace(0.9, 1.0, len(scale))
    u = scale[:, None] * np.sin(np.pi * rate[:, None] * t**2)
    modal = in_modal_coordinates(plant)
    twin = modal if linear else control.sample_system(modal, step, "zoh")  # continuous: inputs are interpolated
    expected = control.forced_response(twin, t, u).outputs.T
    with running(fmu_path) as fmu:
        fmu.start()
        start = time.process_time()
        found = fmu.run(dict(zip((load.name for load in loads), u)), step, names, interpolate=linear)
        spent = time.process_time() - start
    return float(np.max(abs(found - expected).max(axis=0) / abs(expected).max(axis=0))), 1e6 * spent / fmi_steps


def main() -> None:
    """Print a line for each step size and interpolation."""
    model = gp.load(sys.argv[1] if len(sys.argv) > 1 else DEFAULT)
    with tempfile.TemporaryDirectory() as folder:
        for fmi in ("2.0", "3.0"):
            path = gp.export_fmu(model, Path(folder) / f"fmi{fmi}.fmu", fmi=fmi)
            for step in (1e-6, 1e-5, 5e-5, 1e-4):
                for linear in (False, True):
                    found, each = deviation(model, path, step, linear=linear)
                    what = "linear" if linear else "held"
                    print(
                        f"FMI {fmi}, step {1e6 * step:4.0f} us, inputs {what}: {found:.1e} of the largest value; "
                        f"{each:.0f} us a step (fmpy)",
                        flush=True,
                    )


if __name__ == "__main__":
    main()
