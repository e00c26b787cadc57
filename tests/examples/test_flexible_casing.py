"""A casing by finite elements: assembly and couplings against closed forms, the example on a coarse mesh."""

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse.linalg
from readme_numbers import words

skfem = pytest.importorskip("skfem")
ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "examples" / "flexible_casing"
sys.path.insert(0, str(FOLDER))

import casing_checks  # noqa: E402
import casing_machine  # noqa: E402
import casing_matrices  # noqa: E402
import casing_mesh  # noqa: E402
import casing_prisms  # noqa: E402
import flexible_casing  # noqa: E402

import gearpath as gp  # noqa: E402

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("flexible_casing")]
SIZE = 0.05


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """The example as a user runs it, but for the FMU and fewer lines."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(flexible_casing, "LINES", np.linspace(20.0, 5000.0, 250))
        folder = tmp_path_factory.mktemp("flexible_casing")
        result = flexible_casing.main(["--folder", str(folder), "--size", str(SIZE), "--no-fmu"])
    assert (folder / "flexible_casing.png").stat().st_size > 50_000
    return result


@pytest.fixture(scope="module")
def even():
    """The casing with distributing seats."""
    return casing_matrices.casing(SIZE, rigid_seats=False)


@pytest.fixture(scope="module")
def mesh():
    """Finite elements without couplings: basis, K, M."""
    basis = skfem.Basis(casing_mesh.casing_mesh(SIZE), skfem.ElementHexS2(), intorder=4)
    return basis, *casing_matrices.solid(basis)


def test_uniform_strain_has_its_energy(mesh):
    """u = E x: u^T K u = V (lambda (tr E)^2 + 2 mu E:E), whatever the shape of the bricks; rotations cost nothing."""
    basis, K, M = mesh
    E = np.array([[1.0, 0.3, -0.2], [0.3, -0.5, 0.7], [-0.2, 0.7, 0.4]])
    u = (basis.doflocs.T @ E).ravel()
    young, nu = casing_matrices.YOUNG, casing_matrices.POISSON
    mu, bulk = young / (2.0 * (1.0 + nu)), young / (3.0 * (1.0 - 2.0 * nu))
    deviator = E - np.trace(E) / 3.0 * np.eye(3)
    volume = casing_prisms.closed_form(1.0, SIZE).mass
    expected = volume * (bulk * np.trace(E) ** 2 + 2.0 * mu * (deviator**2).sum())
    assert u @ K @ u == pytest.approx(expected, rel=1e-11)
    turned = np.cross([0.3, -1.0, 0.5], basis.doflocs.T).ravel()
    assert abs(turned @ K @ turned) < 1e-12 * expected
    assert np.ones(len(u)) @ M @ np.ones(len(u)) == pytest.approx(3.0 * casing_matrices.DENSITY * volume, rel=1e-12)


def test_mass_and_inertia_with_distributing_couplings(even):
    own = casing_checks.mass_properties(even)
    exact = casing_prisms.closed_form(casing_matrices.DENSITY, SIZE)
    assert own.mass == pytest.approx(exact.mass, rel=1e-11)
    np.testing.assert_allclose(own.centre, exact.centre, atol=1e-11)
    np.testing.assert_allclose(own.inertia, exact.inertia, atol=1e-11)
    assert abs(even.stiffness @ even.rigid()).max() < 1e-12 * abs(even.stiffness).max()


@pytest.mark.parametrize("direction", [0, 1, 2])
def test_force_on_a_distributing_foot_is_uniform_traction(even, mesh, direction):
    """The same motion as under a traction on the uncoupled mesh, held by its inertia: (K + w^2 M) u = f."""
    basis, K, M = mesh
    x, y, z = casing_mesh.FEET["foot_2"]
    half = casing_mesh.FOOT_SIZE / 2
    under = basis.mesh.facets_satisfying(
        lambda p: (abs(p[0] - x) < half) & (abs(p[2] - z) < half) & (abs(p[1] - y) < 1e-6)
    )
    own = skfem.FacetBasis(basis.mesh, basis.elem, facets=under, intorder=4)
    traction = skfem.LinearForm(lambda a, _: a / (2 * half) ** 2).assemble(own)
    force = np.zeros(K.shape[0])
    force[direction::3] = traction
    assert force.sum() == pytest.approx(1.0)
    holding = (2.0 * np.pi * 500.0) ** 2
    expected = scipy.sparse.linalg.spsolve((K + holding * M).tocsc(), force, permc_spec="MMD_AT_PLUS_A")
    load = np.zeros(even.mass.shape[0])
    load[even.rows("foot_2")[direction]] = 1.0
    held = (even.stiffness + holding * even.mass).tocsc()
    motion = scipy.sparse.linalg.spsolve(held, load, permc_spec="MMD_AT_PLUS_A")
    np.testing.assert_allclose(even.T @ motion, expected, atol=1e-8 * abs(expected).max())


def test_rigid_seats_follow_and_are_stiffer_than_distributing_ones(found, even):
    compliance = {}
    for casing in (found.casing, even):
        place = casing.rows("seat_1")[1]
        load = np.zeros(casing.mass.shape[0])
        load[place] = 1.0
        held = (casing.stiffness + (2.0 * np.pi * 500.0) ** 2 * casing.mass).tocsc()
        motion = scipy.sparse.linalg.spsolve(held, load, permc_spec="MMD_AT_PLUS_A")
        compliance[casing is even] = motion[place]
        bore = np.hypot(casing.positions[:, 0] + 0.05, casing.positions[:, 1])
        there = np.flatnonzero((bore < 0.0311) & (casing.positions[:, 2] < 0.0))
        turn, centre = motion[casing.rows("seat_1")[3:]], casing_matrices.PLACES["seat_1"]
        follows = motion[casing.rows("seat_1")[:3]] + np.cross(turn, casing.positions[there] - centre)
        away = abs((casing.T @ motion).reshape(-1, 3)[there] - follows).max()
        assert (away < 1e-12 * abs(follows).max()) == (casing is found.casing)
    assert 1.0 < compliance[True] / compliance[False] < 1.5


def test_gearpath_agrees_with_closed_forms_and_scipy(found):
    assert len(found.differences) == 7
    assert max(found.differences.values()) < 1e-8, found.differences


def test_frequencies_converge_from_above(found):
    first = [frequencies[:3] for frequencies in found.frequencies.values()]
    assert all((coarse >= fine * (1.0 - 1e-9)).all() for coarse, fine in pairwise(first))
    assert abs(first[-1] / [1876.1, 2283.2, 2573.8] - 1.0).max() < 0.025  # elements of 15 mm


def test_readme_says_what_the_run_finds(found):
    readme = (FOLDER / "README.md").read_text(encoding="utf-8")
    blocks = {words(block) for block in readme.split("\n\n")}
    parts = flexible_casing.text(found).split("\n\n")
    assert all(words(part) in blocks for part in parts[:2])
    assert all(words(name) in words(readme) for name in found.differences)
    band, more = (
        [row.split("|")[2:4] for row in block.splitlines()[2:]]
        for block in (parts[3], next(part for part in readme.split("\n\n") if part.startswith("| band")))
    )
    np.testing.assert_allclose(np.array(band, float), np.array(more, float), atol=2.5)  # dB, of a coarse mesh


def test_the_casing_alone_is_exchanged(found):
    """All else is as in models/helical_gearbox.toml."""
    helical, flexible = gp.load(casing_machine.HELICAL).to_dict(), found.model.to_dict()
    for data in (helical, flexible):
        data["components"].pop("casing")
        for name, joint in data["joints"].items():
            place = name.replace("bearing", "seat").replace("mount", "foot")
            joint["between"] = [end.replace(f"casing.{place}", "casing") for end in joint["between"]]
    assert flexible == helical


def test_a_rigid_casing_hides_the_power_above_its_modes(found):
    flexible, rigid = (
        flow.sel(frequency=slice(2500.0, None)).transmitted_power.mean() for flow in found.flows.values()
    )
    assert 10.0 * np.log10(float(flexible / rigid)) > 15.0
