"""Orders over the speed, and spectrograms over time."""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from orders import spectrogram

HIGHEST = 1500.0  # Hz, of spectrograms
RANGE = 80.0  # dB, of their colours


def draw_orders(path: Path, speed: np.ndarray, fine: np.ndarray, harmonics: dict[str, list[Any]]) -> None:
    """Force into the ground of each order: dots from the run-up, lines at steady speed."""
    figure = Figure(figsize=(9, 5.5), layout="constrained")
    axes = figure.subplots()
    for color, (name, order) in enumerate((name, one) for name, found in harmonics.items() for one in found):
        axes.semilogy(fine, order.steady_force, color=f"C{color}", label=f"{name}, order {order.order:g}, predicted")
        axes.semilogy(speed, order.ground_force, ".", ms=3, color=f"C{color}", label="in the run-up")
    axes.set(xlabel="speed of the input shaft, rev/min", ylabel="RMS force into the ground, N")
    axes.grid(visible=True, which="both", alpha=0.3)
    figure.legend(loc="outside lower center", ncols=2, fontsize="small")
    figure.savefig(path)
    print("wrote", path)


def draw_spectrograms(path: Path, signals: dict[str, np.ndarray], step: float, speeds: tuple[float, float]) -> None:
    """Force of a mount over frequency and time, in dB of the largest value."""
    figure = Figure(figsize=(11, 5), layout="constrained")
    axes = figure.subplots(1, len(signals), sharey=True)
    shown = {name: spectrogram(signal, step) for name, signal in signals.items()}
    largest = max(amplitudes.max() for _, _, amplitudes in shown.values())
    image = None
    for panel, (name, (t, f, amplitudes)) in zip(axes, shown.items()):
        low = f <= HIGHEST
        level = 20.0 * np.log10(np.maximum(amplitudes[low], 1e-9 * largest) / largest)
        image = panel.pcolormesh(t, f[low], level, vmin=-RANGE, vmax=0.0, shading="nearest", rasterized=True)
        panel.set(xlabel="time, s", title=f"mount_1.force_uy, {name} mounts", xlim=(0.0, len(signals[name]) * step))
    axes[0].set(ylabel=f"frequency, Hz ({speeds[0]:g} to {speeds[1]:g} rev/min)")
    figure.colorbar(image, ax=axes, label=f"dB re {largest:.3g} N")
    figure.savefig(path, dpi=110)
    print("wrote", path)
