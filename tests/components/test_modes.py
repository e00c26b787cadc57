"""Modes of structures that are hard to solve, and of those that must be refused."""

from dataclasses import replace

import numpy as np
import pytest
from systems import default_gear_train, default_gearbox, random_gearbox

from gearpath.components import Section, ShaftPoint, modes
from gearpath.errors import AccuracyError
from gearpath.network.assemble import assemble
from gearpath.network.power import power_flow

STATIONS = {"a": ShaftPoint("input", 0.0), "b": ShaftPoint("output", 0.25)}
OMEGA = 2 * np.pi * np.geomspace(20.0, 5000.0, 40)


def stepped(offset):
    """The gear stays at 0.125 m, the section changes `offset` behind it."""
    train = default_gear_train(elements=(8,))
    sections = (Section(0.125 + offset, 0.03), Section(0.125 - offset, 0.032))
    return replace(train, shafts={**train.shafts, "input": replace(train.shafts["input"], sections=sections)})


def alpha(offset):
    system = default_gearbox()
    machine = replace(system, components={**system.components, "gear_train": stepped(offset)})
    return power_flow(assemble(machine).modal(), OMEGA).share()


@pytest.fixture(scope="module")
def expected():
    """Alpha as a function of the offset: the cubic through machines without a short span."""
    offsets = np.array([0.0, 5e-4, 1e-3, 1.5e-3])
    values = [alpha(x) for x in offsets]

    def interpolate(offset):
        weights = [np.prod([(offset - b) / (a - b) for b in offsets if b != a]) for a in offsets]
        return np.array(weights) @ values

    return interpolate


@pytest.mark.parametrize("offset", [1e-4, 1e-5, 5e-6])
def test_a_very_short_span_does_no_harm(expected, offset):
    np.testing.assert_allclose(alpha(offset), expected(offset), rtol=1e-6)


@pytest.mark.parametrize("offset", [3e-6, 1e-6, 1e-7])
def test_a_span_too_short_for_the_digits_is_refused(offset):
    with pytest.raises(AccuracyError, match="one of its spans is too short"):
        alpha(offset)


@pytest.mark.parametrize("offset", [1e-3, 1e-5])
@pytest.mark.parametrize("which", range(4))
def test_an_undeclared_rigid_mode_is_refused(offset, which):
    structure = stepped(offset).structure(("uy", "rx"), STATIONS)
    fewer = np.delete(structure.rigid_modes, which, axis=1)
    with pytest.raises(AccuracyError, match="move in more ways without deforming"):
        modes(replace(structure, rigid_modes=fewer))


@pytest.mark.parametrize("offset", [1e-3, 1e-5])
def test_a_declared_motion_that_deforms_is_refused(offset):
    """Rigid motion of the input shaft alone deforms the mesh, which is 1e5 times softer than the shortest span."""
    structure = stepped(offset).structure(("uy", "rx"), STATIONS)
    motion = np.zeros((structure.size, 1))
    motion[: structure.size // 2 : 2] = 1.0
    motion[len(motion) // 2 :] = 0.0
    uy = structure.ports["a"][1]
    assert uy @ motion == 1.0
    with pytest.raises(AccuracyError, match="1 of the 5 rigid-body modes that the structure declares deform it"):
        modes(replace(structure, rigid_modes=np.hstack([structure.rigid_modes, motion])))


@pytest.mark.parametrize("seed", [282, 487])
def test_close_modes_stay_orthogonal(seed):
    """Modes 4e-4 apart of trains whose highest eigenvalue is 1e5 times theirs."""
    structure = assemble(random_gearbox(seed, 3, helical=True)).structures["train"]
    basis = modes(structure)
    elastic = basis.frequencies[basis.frequencies > 0.0]
    assert np.min(np.diff(elastic[:8]) / elastic[:7]) < 1e-3
    np.testing.assert_allclose(basis.shapes.T @ structure.mass @ basis.shapes, np.eye(structure.size), atol=1e-12)
