"""Order tracking: phasors of what turns with the shaft, from signals sampled in time."""

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.signal import ShortTimeFFT
from scipy.signal.windows import hann

REVOLUTIONS = 1.0  # that an average spans: 26 tooth meshings, 16 ms at 1200 rev/min with the Hann window's half width


def shaft_angle(times: np.ndarray, start: float, rate: float) -> np.ndarray:
    """rad, of a speed (rev/min) that grows by `rate` (rev/min per s) from `start`."""
    return np.asarray(2.0 * np.pi / 60.0 * (start * times + 0.5 * rate * times**2))


def centres(angle: np.ndarray) -> np.ndarray:
    """Where averages lie (rad): half of one apart, none over the ends; the first two revolutions are left out."""
    return np.asarray(2.0 * np.pi * np.arange(2.0, angle[-1] / (2.0 * np.pi) - REVOLUTIONS / 2.0, REVOLUTIONS / 2.0))


def tracked(
    record: Mapping[str, np.ndarray], names: Sequence[str], angle: np.ndarray, order: float, phase: float = 0.0
) -> np.ndarray:
    """Peak phasors (C, names) of an order at all centres, against cos(order angle + phase).

    X = 2 integral x e^(-i (order theta + phase)) w dtheta / integral w dtheta, w a Hann window over the angle.
    """
    signals = np.array([record[name] for name in names])
    found = []
    for centre in centres(angle):
        away = (angle - centre) / (2.0 * np.pi * REVOLUTIONS)
        part = np.flatnonzero(abs(away) < 0.5)
        window = np.cos(np.pi * away[part]) ** 2 * np.gradient(angle[part])
        wave = 2.0 * np.exp(-1j * (order * angle[part] + phase)) * window / window.sum()
        found.append(signals[:, part] @ wave)
    return np.array(found)


def spectrogram(signal: np.ndarray, step: float, length: float = 0.1) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (T,), frequencies (F,) and amplitudes (F, T), of tones their peak value; a Hann window of `length` (s)."""
    size = round(length / step)
    transform = ShortTimeFFT(hann(size, sym=False), size // 8, 1.0 / step, scale_to="magnitude")
    amplitudes = 2.0 * abs(transform.stft(signal))
    return transform.t(len(signal)), transform.f, amplitudes
