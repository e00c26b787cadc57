"""Sparse structures: a plate against a general eigensolver, and one of 50,000 degrees of freedom within 2 GB."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse.linalg

from gearpath.components import DOFS, Material
from gearpath.components.footprint import Footprint
from gearpath.components.plate import Plate
from gearpath.reduction import free_interface, lanczos, reduced_modes, reduced_structure, static_defect

SCRIPT = Path(__file__).resolve().parents[2] / "benchmarks" / "reduction.py"


@pytest.fixture(scope="module")
def plate():
    """A small plate with a rigid seat, a mounting point on a node and a sensor between nodes (rows of many entries)."""
    steel, sides = Material(2.07e11, 0.3, 7850.0), (0.4, 0.3)
    seats = {"seat": Footprint((-0.05, 0.0, 0.0), (0.06, 0.06))}
    part = Plate(steel, (0.0, 0.0, 0.0), sides, 0.01, (12, 10), footprints=seats, modal_damping=0.01)
    return part.structure(DOFS, {"seat": "seat", "mount": (0.15, -0.1, 0.0)}, {"sensor": (0.111, 0.083, 0.0)})


@pytest.mark.parametrize(
    "method", [lambda s: lanczos(s, 72), lambda s: free_interface(s, 20, residual=True)], ids=["lanczos", "free"]
)
def test_frequencies_of_a_plate(plate, method):
    """Lowest modes against a shifted sparse eigensolver, and the rigid ones exactly zero."""
    found = method(plate)
    shifted = scipy.sparse.linalg.eigsh(plate.stiffness, 14, M=plate.mass, sigma=-1e5, return_eigenvectors=False)
    values = reduced_modes(plate, found).eigenvalues
    assert np.all(values[:6] == 0.0)
    np.testing.assert_allclose(np.sqrt(values[6:14]), np.sqrt(np.sort(shifted)[6:]), rtol=1e-6)
    assert static_defect(plate, found) < 1e-8


def test_ports_of_a_reduced_plate(plate):
    """Receptance between the ports against a sparse direct solution (undamped, between resonances)."""
    small = reduced_structure(plate, lanczos(plate, 72))
    rows, few = (np.vstack(list(item.ports.values())) for item in (plate, small))
    w = 2.0 * np.pi * 431.0
    exact = rows @ scipy.sparse.linalg.splu((plate.stiffness - w**2 * plate.mass).tocsc()).solve(rows.T)
    reduced = few @ scipy.linalg.solve(small.stiffness - w**2 * small.mass, few.T)
    size = np.sqrt(abs(np.diag(exact)))
    assert np.max(abs(reduced - exact) / np.outer(size, size)) < 1e-5


@pytest.mark.slow
def test_a_large_plate_is_reduced_within_two_gigabytes():
    """Peak resident memory of a process of its own, the error estimate included; a coarse mesh finds the same plate."""
    found = {}
    for elements in (40, 91):
        command = [sys.executable, str(SCRIPT), "--child", "lanczos", str(elements)]
        found[elements] = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    assert found[91]["coordinates"] >= 50_000
    assert found[91]["size"] == 90
    assert found[91]["peak_mb"] <= found[91]["estimate_peak_mb"] < 2048
    np.testing.assert_allclose(found[91]["frequencies"], found[40]["frequencies"], rtol=0.02)
