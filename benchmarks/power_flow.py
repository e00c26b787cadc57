"""Power flow of the default gearbox: time a line against a plain batched numpy implementation, and peak memory.

    python benchmarks/power_flow.py [MODEL]

The peer does what one would write first: all component mobilities as one batch, numpy.linalg.solve for all lines, the
power ratio alone. Gearpath computes input power, all paths with both velocities, and the dissipation of every element.
"""

import sys
import time
import tracemalloc
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

import gearpath as gp
from gearpath.api import modal_network
from gearpath.network.power import power_flow

DEFAULT = Path(__file__).resolve().parents[1] / "models" / "gearbox.toml"


def plain_alpha(network, omega):
    """Power ratio by one batched solve over all lines: Eq. 3 to 5 with Z instead of an inverted bearing matrix."""
    load = next(item for item in network.loads if item.name == network.excitation)
    P = network.relative
    K, C = network.interface_matrices()
    w = omega[:, None]
    response = 1j * w / (network.eigenvalues - w**2 + 1j * w * network.damping)
    W = (P * response[:, None, :]) @ P.T
    Z = K / (1j * w[:, :, None]) + C
    free = response * load.column * (w**2 if load.is_transmission_error else 1.0)
    g = np.linalg.solve(np.eye(len(P)) + Z @ W, Z @ (free @ P.T)[:, :, None])[:, :, 0]
    velocity = free - response * (g @ P)
    input_power = 0.5 * np.real(velocity @ load.column) * (omega**2 if load.is_transmission_error else 1.0)
    paths = [joint for joint in network.joints if joint.name in network.paths]
    slices = network.joint_slices()
    receiver = np.vstack([joint.receiver for joint in paths])
    forces = np.hstack([g[:, slices[joint.name]] for joint in paths])
    return 0.5 * np.real((velocity @ receiver.T).conj() * forces).sum(axis=1) / input_power


def median_ms(functions, repeats=15):
    """Median process time of each function, interleaved, ms."""
    times = {name: [] for name in functions}
    for _ in range(repeats):
        for name, function in functions.items():
            start = time.process_time()
            function()
            times[name].append(time.process_time() - start)
    return {name: 1e3 * float(np.median(values)) for name, values in times.items()}


def peak_mb(function):
    """Peak of what a call allocates, MB."""
    tracemalloc.start()
    function()
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak / 1e6


def main() -> None:
    """Print the table."""
    model = gp.load(sys.argv[1] if len(sys.argv) > 1 else DEFAULT)
    network = modal_network(model)
    omega = 2 * np.pi * np.linspace(20.0, 5000.0, 2000)
    deviation = np.max(abs(plain_alpha(network, omega) / power_flow(network, omega).share() - 1))
    print(f"{len(network.relative)} interface degrees of freedom, {network.eigenvalues.size} modes, {len(omega)} lines")
    print(f"both agree to {deviation:.1e}")
    with threadpool_limits(1):
        times = median_ms(
            {
                "plain batched numpy": lambda: plain_alpha(network, omega),
                "gearpath power_flow (arrays)": lambda: power_flow(network, omega),
                "gp.power_flow (model to dataset)": lambda: gp.power_flow(model, omega / (2 * np.pi)),
            }
        )
    plain = times["plain batched numpy"]
    for name, ms in times.items():
        print(f"{name:34s} {ms:7.1f} ms {1e3 * ms / len(omega):6.1f} us a line   ratio to plain {ms / plain:.2f}")
    many = np.linspace(20.0, 5000.0, 200_000)
    print(f"peak memory of gp.power_flow with 200,000 lines: {peak_mb(lambda: gp.power_flow(model, many)):.0f} MB")
    tenth = 2 * np.pi * many[::10]
    print(f"peak memory of plain numpy with 20,000 lines: {peak_mb(lambda: plain_alpha(network, tenth)):.0f} MB")


if __name__ == "__main__":
    main()
