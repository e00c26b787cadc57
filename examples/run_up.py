"""A run-up: the gear mesh source inside the FMU, and the power through the bearings against the speed.

    python examples/run_up.py

The time signal is averaged tone by tone (order tracking) and compared with the FMU's order outputs, which give the
power of each tone at once, as if the speed were steady. Draws build/run_up.svg.
"""

import tempfile
from pathlib import Path

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Slave
from matplotlib.figure import Figure

import gearpath as gp

MODEL = Path(__file__).resolve().parents[1] / "models" / "helical_gearbox.toml"
START, STOP, STEPS, STEP = 300.0, 3000.0, 25_000, 8e-5  # rev/min, s
RATE = (STOP - START) / (STEPS * STEP)  # rev/min per s
REVOLUTIONS = 3.0  # that an average spans


def main() -> None:
    """Print and draw what the run-up shows."""
    model = gp.load(MODEL)
    tones = {tone.name: tone.harmonic * model.system.source.teeth + tone.shift for tone in model.system.source.tones}
    orders = {name: order for name, order in tones.items() if "harmonic" in name}
    pairs = [
        (f"{name}.force_{dof}", f"{name}.velocity_{dof}")
        for name, joint in model.system.joints.items()
        if joint.kind == "bearing"
        for dof in joint.dofs
    ]
    with tempfile.TemporaryDirectory() as folder:
        fmu = Running(gp.export_fmu(model, Path(folder) / "gearbox.fmu"), Path(folder) / "unpacked")
        signal = run_up(fmu, [name for pair in pairs for name in pair])
        speed, tracked = track(signal, pairs, list(orders.values()))
        steady = order_outputs(fmu, speed, list(orders))
        fine = np.linspace(speed[0], speed[-1], 500)
        curves = order_outputs(fmu, fine, list(orders))
        fmu.close()
    print(f"{STEPS} steps of {1e6 * STEP:g} us from {START:g} to {STOP:g} rev/min; power through all bearings, W:")
    print("rev/min  " + "  ".join(f"{name:>26}" for name in orders) + "   (run-up / steady)")
    for k in range(0, len(speed), max(1, len(speed) // 8)):
        both = "  ".join(f"{a:12.3e} /{b:12.3e}" for a, b in zip(tracked[k], steady[k]))
        print(f"{speed[k]:7.0f}  {both}")
    apart = abs(10 * np.log10(np.abs(tracked[:, 0]) / steady[:, 0]))
    print(f"first harmonic: run-up and steady speed differ by {np.median(apart):.2f} dB in the median")
    draw(Path("build") / "run_up.svg", (speed, tracked), (fine, curves), orders)


class Running:
    """An instance of the FMU, with variables by name."""

    def __init__(self, path: Path, folder: Path) -> None:
        description = fmpy.read_model_description(str(path))
        fmpy.extract(str(path), str(folder))
        self.reference = {v.name: v.valueReference for v in description.modelVariables}
        self.slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=str(folder),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=description.modelName,
        )
        self.slave.instantiate()
        self.slave.setupExperiment()
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()

    def set_speed(self, speed: float, slope: float) -> None:
        """The shaft's speed (rev/min), and its slope (rev/min per s) over the next step."""
        at = [self.reference["mesh.speed"]]
        self.slave.setReal(at, [speed])
        self.slave.setRealInputDerivatives(at, [1], [slope])

    def get(self, names: list[str]) -> list[float]:
        """Values of some outputs."""
        return self.slave.getReal([self.reference[name] for name in names])

    def close(self) -> None:
        """End the instance."""
        self.slave.terminate()
        self.slave.freeInstance()


def run_up(fmu: Running, outputs: list[str]) -> dict[str, np.ndarray]:
    """Outputs over time; the speed is linear over every step, so that the source is integrated exactly."""
    values = np.empty((STEPS + 1, len(outputs)))
    values[0] = fmu.get(outputs)
    for k in range(STEPS):
        fmu.set_speed(START + RATE * STEP * k, RATE)
        fmu.slave.doStep(STEP * k, STEP)
        values[k + 1] = fmu.get(outputs)
    return dict(zip(outputs, values.T))


def track(signal: dict[str, np.ndarray], pairs: list[tuple[str, str]], orders: list[float]) -> tuple:
    """Speeds, and the power of each order: 1/2 Re(v* F) of phasors averaged over some revolutions (Hann)."""
    t = STEP * np.arange(STEPS + 1)
    angle = 2 * np.pi / 60 * (START * t + RATE * t**2 / 2)
    F, v = (np.array([signal[pair[side]] for pair in pairs]) for side in (0, 1))
    centres = np.arange(REVOLUTIONS, angle[-1] / (2 * np.pi) - REVOLUTIONS / 2, REVOLUTIONS / 4)
    powers = np.empty((len(centres), len(orders)))
    for k, centre in enumerate(centres):
        away = angle / (2 * np.pi) - centre
        part = np.flatnonzero(abs(away) < REVOLUTIONS / 2)
        window = np.cos(np.pi * away[part] / REVOLUTIONS) ** 2 * np.gradient(angle[part])
        for i, order in enumerate(orders):
            wave = np.exp(-1j * order * angle[part]) * window / window.sum()
            powers[k, i] = 0.5 * np.real(np.vdot(2 * v[:, part] @ wave, 2 * F[:, part] @ wave))
    middle = np.interp(2 * np.pi * centres, angle, t)
    return START + RATE * middle, powers


def order_outputs(fmu: Running, speeds: np.ndarray, tones: list[str]) -> np.ndarray:
    """The FMU's own outputs: power of each tone at steady speed; no time passes."""
    powers = []
    for speed in speeds:
        fmu.set_speed(speed, 0.0)
        powers.append(fmu.get([f"{name}.power" for name in tones]))
    return np.array(powers)


def draw(path: Path, dots: tuple, curves: tuple, orders: dict[str, float]) -> None:
    """Power of each harmonic against the speed: dots from the run-up, lines from the order outputs."""
    figure = Figure(figsize=(8, 5), layout="constrained")
    axes = figure.subplots()
    for i, order in enumerate(orders.values()):
        axes.semilogy(curves[0], curves[1][:, i], color=f"C{i}", label=f"order {order:g}, at steady speed")
        axes.semilogy(dots[0], dots[1][:, i], ".", color=f"C{i}", label=f"order {order:g}, in the run-up")
    axes.set(xlabel="speed of the input shaft, rev/min", ylabel="power through all bearings, W", title=MODEL.stem)
    axes.grid(visible=True, which="both", alpha=0.3)
    figure.legend(loc="outside lower center", ncols=3, fontsize="small")
    path.parent.mkdir(exist_ok=True)
    figure.savefig(path)
    print("wrote", path)


if __name__ == "__main__":
    main()
