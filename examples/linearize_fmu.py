"""Linearise an FMU, close a loop around it with python-control, and check the loop on the exact frequency response.

    python examples/linearize_fmu.py

A damper on the casing, as a controller would make it: the force against the casing's velocity. Any FMU with model
exchange can take the place of the gearbox; nothing below knows what is inside.
"""

import tempfile
from pathlib import Path

import control
import numpy as np
from matplotlib.figure import Figure

import gearpath as gp

MODEL = Path(__file__).resolve().parents[1] / "models" / "gearbox.toml"
SHAKER = {"shaker": {"component": "casing", "dof": "uy"}}
GAIN = 5000.0  # N s/m


def main() -> None:
    """Print the poles with and without the controller, and draw the transfer to a mount."""
    model = gp.load(MODEL).replace({"actuators": SHAKER})
    with tempfile.TemporaryDirectory() as folder:
        fmu = gp.export_fmu(model, Path(folder) / "gearbox.fmu", fmi="3.0", documentation=False)
        machine = gp.linearize(
            fmu,
            inputs=["mesh.transmission_error", "actuators.shaker"],
            outputs=["casing.velocity_uy", "mount_1.force_uy"],
        )
    print(f"{machine.name}: {machine.nstates} states by {machine.method}, by differences {machine.error:.0e} off")
    controller = control.ss([], [], [], [[-GAIN]], inputs="casing/velocity_uy", outputs="actuators/shaker")
    loop = control.interconnect(
        [machine, controller], inputs=["mesh/transmission_error"], outputs=["mount_1/force_uy", "casing/velocity_uy"]
    )
    for name, system in (("without", machine), ("with", loop)):
        print(f"{name:>7} the controller: " + ", ".join(slowest(system)))

    exact = gp.to_frd(model, np.linspace(50.0, 1000.0, 400), ["casing.velocity_uy"], ["actuators.shaker"])
    closed = control.feedback(exact, GAIN)
    s = 1j * closed.omega
    same = control.feedback(machine["casing/velocity_uy", "actuators/shaker"], GAIN)(s)
    apart = abs(closed.frdata[0, 0] - same).max() / abs(same).max()
    print(f"closed loop of the FMU and of the exact frequency response: {apart:.0e} apart")
    draw(Path("build") / "linearize_fmu.svg", closed.omega / (2 * np.pi), machine, loop)


def slowest(system: control.StateSpace) -> list[str]:
    """Frequency and damping ratio of the lowest modes."""
    poles = system.poles()
    poles = sorted(poles[poles.imag > 0.0], key=abs)[:4]
    return [f"{abs(pole) / (2 * np.pi):.0f} Hz ({-100 * pole.real / abs(pole):.1f} %)" for pole in poles]


def draw(path: Path, f: np.ndarray, machine: control.StateSpace, loop: control.StateSpace) -> None:
    """Force of a mount per transmission error, N/um."""
    figure = Figure(figsize=(8, 4.5), layout="constrained")
    axes = figure.subplots()
    pair = ("mount_1/force_uy", "mesh/transmission_error")
    axes.semilogy(f, 1e-6 * abs(machine[pair](2j * np.pi * f)), label="without the controller")
    axes.semilogy(f, 1e-6 * abs(loop(2j * np.pi * f)[0, 0]), label="with it")
    axes.set(xlabel="frequency, Hz", ylabel="mount force per transmission error, N/um")
    axes.grid(visible=True, which="both", alpha=0.3)
    axes.legend()
    path.parent.mkdir(exist_ok=True)
    figure.savefig(path)
    print("wrote", path)


if __name__ == "__main__":
    main()
