"""A gearbox casing from a finite element code: 20-node bricks by scikit-fem, power flow and FMU by Gearpath.

    python examples/flexible_casing/flexible_casing.py [--folder build/flexible_casing] [--size 0.025] [--even-seats]

Needs `pip install "gearpath[all,examples]"`. Writes casing.npz, flexible_casing.toml, flexible_casing.fmu and
flexible_casing.png; prints the tables of the README.
"""

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from casing_checks import elastic_modes, largest_differences
from casing_machine import rigid_twin, write_machine
from casing_matrices import DENSITY, Casing, casing
from casing_picture import draw
from casing_prisms import closed_form

import gearpath as gp

COARSER = (2.0, 1.4)  # times as long as the elements of the model, to see the frequencies converge
BANDS = ((20, 500), (500, 1000), (1000, 2000), (2000, 3500), (3500, 5000))  # Hz
TOLERANCE, FMU_BAND = 1e-2, (20.0, 2500.0)  # Hz; three harmonics of 32 teeth at 1480 rev/min reach 2368 Hz
LINES = np.linspace(20.0, 5000.0, 997)  # Hz
PATHS = 5


@dataclass(frozen=True)
class Found:
    """The casing, its free frequencies (Hz) by size of the elements and the shapes of the finest, and what follows."""

    casing: Casing
    frequencies: dict[float, np.ndarray]
    shapes: np.ndarray
    model: gp.Model
    flows: dict[str, xr.Dataset]
    differences: dict[str, float]


def computed(folder: Path, size: float, rigid_seats: bool = True) -> Found:
    """Everything but the FMU; casing.npz and the model file go into the folder."""
    meshes = {length: casing(length, rigid_seats) for length in (*(factor * size for factor in COARSER), size)}
    modes = {length: elastic_modes(mesh.stiffness, mesh.mass, 6) for length, mesh in meshes.items()}
    own = meshes[size]
    own.write(folder / "casing.npz")
    model = write_machine(folder / "flexible_casing.toml")
    flows = {
        "flexible casing": gp.power_flow(model, LINES),
        "rigid casing of the same mass and inertia": gp.power_flow(rigid_twin(closed_form(DENSITY, size)), LINES),
    }
    differences = dict(largest_differences(own, model, flows["flexible casing"]))
    frequencies = {length: found for length, (found, _) in modes.items()}
    return Found(own, frequencies, modes[size][1], model, flows, differences)


def text(found: Found) -> str:
    """All tables."""
    exact = closed_form(DENSITY, found.casing.size)
    sizes = f"{found.casing.mesh.t.shape[1]} bricks, {found.casing.mass.shape[0]} coordinates, {exact.mass:.2f} kg"
    parts = (convergence(found), agreement(found), bands(found), ranking(found))
    return "\n\n".join([sizes, *("\n".join(part) for part in parts)])


def convergence(found: Found) -> Iterator[str]:
    """Frequencies of the free casing on each mesh."""
    yield "| elements, mm | first six elastic frequencies of the free casing, Hz |"
    yield "| ---: | --- |"
    for size, frequencies in found.frequencies.items():
        yield f"| {1e3 * size:.0f} | {', '.join(f'{f:.1f}' for f in frequencies)} |"


def agreement(found: Found) -> Iterator[str]:
    """Largest differences of the checks."""
    yield "| compared | relative difference |"
    yield "| --- | ---: |"
    for name, value in found.differences.items():
        yield f"| {name} | {'below 1e-10' if value < 1e-10 else f'{value:.0e}'} |"


def bands(found: Found) -> Iterator[str]:
    """Mean level of the power into the casing and alpha of the summed powers, flexible and rigid."""
    yield "| band, Hz | flexible, dB re 1 pW | rigid | alpha, flexible | rigid |"
    yield "| --- | ---: | ---: | ---: | ---: |"
    for low, high in BANDS:
        inside = [flow.sel(frequency=slice(low, high)) for flow in found.flows.values()]
        levels = [float(10.0 * np.log10(part.transmitted_power.mean() / 1e-12)) for part in inside]
        ratios = [float(part.transmitted_power.sum() / part.input_power.sum()) for part in inside]
        cells = [f"{value:.1f}" for value in levels] + [f"{value:.2f}" for value in ratios]
        yield f"| {low} to {high} | {' | '.join(cells)} |"


def ranking(found: Found) -> Iterator[str]:
    """The paths with the largest part of the power, from 1 kHz on, where the casing is no longer rigid."""
    yield "| rank | flexible | of the power | rigid | of the power |"
    yield "| ---: | --- | ---: | --- | ---: |"
    columns = []
    for flow in found.flows.values():
        part = flow.sel(frequency=slice(1000.0, None))
        power = (part.path_alpha * part.input_power).sum("frequency")
        share = power / power.sum()
        best = np.argsort(-abs(share.values))[:PATHS]
        columns.append([f"{flow.path.values[k]} | {float(share[k]):.2f}" for k in best])
    for rank, cells in enumerate(zip(*columns), 1):
        yield f"| {rank} | {' | '.join(cells)} |"


def exported(model: gp.Model, path: Path) -> str:
    """The machine as an FMU that is reduced for the harmonics of its mesh, and what its validation says."""
    report = gp.validate_fmu(gp.export_fmu(model, path, tolerance=TOLERANCE, band=FMU_BAND, documentation=False), model)
    lines = [f"wrote {path}: {len(report.checks)} checks, {'all passed' if report.passed else 'not all passed'}"]
    lines += [f"{one.name}: {one.figure:.2g} ({one.what})" for one in report.checks if one.name.startswith("reduction")]
    return "\n".join(lines)


def main(arguments: Sequence[str] | None = None) -> Found:
    """Compute, print, export, validate, draw."""
    parser = argparse.ArgumentParser(description="A gearbox casing from a finite element code.")
    parser.add_argument("--folder", type=Path, default=Path("build") / "flexible_casing", help="for all files")
    parser.add_argument("--size", type=float, default=0.025, help="of the elements, m")
    parser.add_argument("--even-seats", action="store_true", help="bearings press evenly on bores that may ovalise")
    parser.add_argument("--no-fmu", action="store_true", help="leave the FMU out")
    given = parser.parse_args(arguments)
    found = computed(given.folder, given.size, not given.even_seats)
    print(text(found))
    frequencies = found.frequencies[given.size]
    draw(given.folder / "flexible_casing.png", found.flows, found.casing, frequencies, found.shapes)
    if not given.no_fmu:
        print(exported(found.model, given.folder / "flexible_casing.fmu"))
    return found


if __name__ == "__main__":
    main()
