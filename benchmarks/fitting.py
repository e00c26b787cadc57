"""Fit of measured mobilities: states, error, passivity and seconds, for a synthetic structure with and without noise.

python benchmarks/fitting.py [SEEDS]      structures of each kind, 3 unless given

8 ports, 36 modes of which 20 lie in the band, 2000 lines, one thread (processor time); every other structure floats on
six rigid-body modes. The deviation is from the mobilities without noise.
"""

import os
import sys
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import gearpath as gp


def structure(seed, modes=36, in_band=20, ports=8, lines=2000):
    """Lines (Hz) and mobilities of random real modes, 10 to 2000 Hz, damping ratios 0.2 to 3 %."""
    rng = np.random.default_rng(seed)
    f = np.linspace(10.0, 2000.0, lines)
    w = 2 * np.pi * f
    poles = np.concatenate([rng.uniform(40, 1950, in_band), rng.uniform(2050, 6000, modes - in_band)])
    w_r = 2 * np.pi * poles[:, None]
    zeta = np.exp(rng.uniform(np.log(0.002), np.log(0.03), modes))[:, None]
    shapes, rigid = rng.normal(size=(ports, modes)), rng.normal(size=(ports, 6 * (seed % 2)))
    Y = np.einsum("ar,rf,br->fab", shapes, 1j * w / (w_r**2 - w**2 + 2j * zeta * w_r * w), shapes)
    return f, Y + (rigid @ rigid.T) / (1j * w)[:, None, None]


def main(seeds):
    """Print one line a fit."""
    print("noise  seed  states  in band  error     rms       deviation  passive  seconds")
    for noise in (0.0, 0.01, 0.05):
        for seed in range(seeds):
            f, Y = structure(seed)
            rng = np.random.default_rng(1000 + seed)
            mess = (rng.normal(size=Y.shape) + 1j * rng.normal(size=Y.shape)) / np.sqrt(2)
            measured = Y + noise * abs(Y).max(axis=0) * mess
            start = time.process_time()
            fit = gp.fit_mobility(f, measured)
            seconds = time.process_time() - start
            off = (abs(fit.mobility(2 * np.pi * f) - Y) / abs(Y).max(axis=0)).max()
            rms = np.sqrt((fit.rms**2).mean())
            print(
                f"{noise:5.2f}  {seed:4d}  {2 * fit.order:6d}  {fit.in_band:7d}  {fit.worst.value:.2e}  {rms:.2e}  "
                f"{off:.2e}   {fit.passive!s:7}  {seconds:5.1f}",
                flush=True,
            )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 3)
