"""Reduced models: the order that each method needs, against each other in the same run; time and peak memory.

python benchmarks/reduced_models.py [ELEMENTS]      elements along each side of the flexible casing, 90 unless given

The beam has 102 coordinates, four ports and a damping ratio of 0.5 %. The flexible casing is a plate of 51,462
coordinates at 90 elements, which carries the four bearings of the default gearbox.
"""

import resource
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import gearpath as gp
from gearpath.components import Material, Plate
from gearpath.components.footprint import Footprint
from gearpath.joints import Port
from gearpath.network.assemble import assemble
from gearpath.network.modal import ModalNetwork
from gearpath.network.system import System
from gearpath.statespace.reduced import reduced_network

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "statespace"))

from reduction_cases import beam, true_error  # noqa: E402


def flexible_gearbox(elements: int) -> System:
    """The default gearbox, its casing a steel plate of 400 x 400 x 20 mm across the shafts, damped by 1 %."""
    system = gp.load(ROOT / "models" / "gearbox.toml").system
    steel = Material(2.07e11, 0.3, 7850.0)
    seats, joints = {}, {}
    for name, joint in system.joints.items():
        shaft, casing = joint.between
        if joint.kind == "bearing":
            x = -0.05 if shaft.shaft == "input" else 0.05
            y = 0.05 if (shaft.z or 0.0) > 0.1 else -0.05
            seats[name] = Footprint((x, y, 0.0), (0.03, 0.03))
            joints[name] = replace(joint, between=(shaft, replace(casing, place=name)))
        else:
            x, _, z = joint.at or (0.0, 0.0, 0.0)
            seats[name] = Footprint((1.8 * x, 1.3 * z, 0.0), (0.02, 0.02))
            joints[name] = replace(
                joint, between=(Port("casing", place=name), casing if casing.is_ground else Port("ground"))
            )
    middle, sides = (0.0, 0.0, 0.0), (0.4, 0.4)
    plate = Plate(steel, middle, sides, 0.02, (elements, elements), footprints=seats, modal_damping=0.01)
    components = {**system.components, "casing": plate}
    return replace(system, components=components, joints=joints, sensors={}, band=5000.0)


def timed(work: Callable[[], object]) -> tuple[object, float]:
    start = time.perf_counter()
    found = work()
    return found, time.perf_counter() - start


def by_method(title: str, network: ModalNetwork, band: tuple[float, float], order: int) -> None:
    """Errors of all methods at one order."""
    print(f"\n{title}: {len(network.eigenvalues)} coordinates, {band[0]:g} to {band[1]:g} Hz, order {order}")
    for method in ("rational_krylov", "craig_bampton", "modal"):
        found, seconds = timed(lambda m=method: reduced_network(network, order=order, band=band, method=m))
        certificate = found.certificate  # type: ignore[attr-defined]
        print(
            f"  {method:16} certified {certificate.error:8.1e}   {seconds:6.2f} s with certificate, "
            f"{'passive' if certificate.passive else 'NOT passive'}"
        )


def by_tolerance(title: str, network: ModalNetwork, band: tuple[float, float]) -> None:
    """Orders for a few tolerances."""
    print(f"\n{title}: {len(network.eigenvalues)} coordinates, {band[0]:g} to {band[1]:g} Hz")
    for tolerance in (1e-2, 1e-3, 1e-6):
        found, seconds = timed(lambda t=tolerance: reduced_network(network, tolerance=t, band=band))
        certificate = found.certificate  # type: ignore[attr-defined]
        print(
            f"  tolerance {tolerance:.0e}: order {certificate.order:4d}, certified {certificate.error:.1e}, "
            f"{'stable, passive' if certificate.stable and certificate.passive else 'NOT passive'}, {seconds:.2f} s"
        )


def main() -> None:
    elements = int(sys.argv[1]) if len(sys.argv) > 1 else 90
    by_method("beam", beam(), (50.0, 8000.0), 16)
    small = reduced_network(beam(), order=16, band=(50.0, 8000.0)).network
    print(f"  true error of rational Krylov on a grid ten times finer: {true_error(beam(), small, (50.0, 8000.0)):.1e}")
    for name in ("gearbox", "helical_gearbox"):
        model = gp.load(ROOT / "models" / f"{name}.toml")
        by_tolerance(name, assemble(model.system).modal(), (20.0, 5000.0))
    system = flexible_gearbox(elements)
    network, seconds = timed(lambda: assemble(system).modal())
    size = 6 * (elements + 1) ** 2
    print(f"\nflexible casing of about {size} coordinates: assembled and brought to its modes in {seconds:.1f} s")
    by_tolerance("gearbox with flexible casing", network, (20.0, 5000.0))  # type: ignore[arg-type]
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (2**20 if sys.platform == "darwin" else 2**10)
    print(f"peak memory {peak:.0f} MB")


if __name__ == "__main__":
    main()
