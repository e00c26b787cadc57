"""Torsion and axial motion of shafts with disks: closed forms of the continuous rod with masses at its ends."""

import numpy as np
import pytest
import scipy.linalg
from scipy.optimize import brentq
from systems import STEEL

from gearpath.components import Disk, GearTrain, Section, Shaft, modes
from gearpath.components.shaft_mesh import mesh_shaft

L, D = 0.4, 0.03
SECTION = Section(L, D)
MASS = STEEL.density * SECTION.area * L
POLAR = STEEL.density * 2 * SECTION.area_moment * L


def disks(scale):
    """Two end disks, of the shaft's own mass and polar inertia times 2 and 5 times `scale`."""
    parts = [("first", 0.0, 2 * scale), ("last", L, 5 * scale)]
    return tuple(Disk(name, z, part * MASS, part * POLAR, part * POLAR) for name, z, part in parts)


def exact(scale, count):
    """k L of the free rod with end masses m1, m2 times its own: (m1 m2 k^2 - 1) sin k = (m1 + m2) k cos k."""
    m1, m2 = 2 * scale, 5 * scale

    def equation(k):
        return (m1 * m2 * k**2 - 1) * np.sin(k) - (m1 + m2) * k * np.cos(k)

    grid = np.linspace(1e-3, 12.0, 3000)
    values = equation(grid)
    at = np.flatnonzero(values[:-1] * values[1:] < 0)[:count]
    return np.array([brentq(equation, grid[i], grid[i + 1], xtol=1e-14) for i in at])


def found(dof, scale, elements, count):
    mesh = mesh_shaft(Shaft(STEEL, (0, 0, 0), (SECTION,), None, (elements,), disks(scale)), [], (dof,))
    values = scipy.linalg.eigh(mesh.stiffness, mesh.mass, eigvals_only=True)
    return np.sqrt(values[1 : count + 1])


@pytest.mark.parametrize(("dof", "modulus"), [("uz", STEEL.youngs_modulus), ("rz", STEEL.shear_modulus)])
def test_frequencies_of_a_rod_with_end_disks_converge_to_the_continuous_rod_as_h_squared(dof, modulus):
    frequencies = exact(0.5, 3) * np.sqrt(modulus / STEEL.density) / L
    errors = np.array([found(dof, 0.5, n, 3) / frequencies - 1 for n in (8, 16, 32)])
    assert np.all((errors > 0) & (errors[-1] < 2e-3))
    orders = np.log2(errors[:-1] / errors[1:])
    assert np.all((orders > 1.9) & (orders < 2.1))


def test_two_heavy_disks_twist_the_shaft_as_a_spring():
    """w^2 = k (1/J1 + 1/J2), k = G J/L, where the disks are heavy beside the shaft; two elements suffice."""
    k = STEEL.shear_modulus * 2 * SECTION.area_moment / L
    scale = 1e6
    expected = np.sqrt(k / POLAR * (1 / (2 * scale) + 1 / (5 * scale)))
    assert found("rz", scale, 2, 1)[0] == pytest.approx(expected, rel=1e-6)


def test_a_free_shaft_in_six_degrees_of_freedom_has_six_rigid_modes_and_uncoupled_families():
    """Axial and torsional frequencies are among those of the whole shaft, which bends alike in both planes."""
    train = GearTrain({"only": Shaft(STEEL, (0.1, 0.2, 0.3), (SECTION,), None, (6,), disks(0.5))}, {})
    frequencies = modes(train.structure(("ux", "uy", "uz", "rx", "ry", "rz"), {})).frequencies
    assert np.count_nonzero(frequencies == 0.0) == 6
    for dof in ("uz", "rz"):
        wanted = found(dof, 0.5, 6, 3) / (2 * np.pi)
        np.testing.assert_allclose(abs(frequencies[:, None] / wanted - 1).min(axis=0), 0.0, atol=1e-9)
    bending = modes(train.structure(("uy", "rx"), {})).frequencies[2:5]
    for f in bending:
        assert np.count_nonzero(abs(frequencies / f - 1) < 1e-9) == 2
