"""The paper's test rig by CalculiX, in solid elements, against our plates, frames and joints.

Lowest natural frequencies, free in space, held to 1 %: they differ by 0.7 % at most, from our grids and from the end
effects that beams leave out. Footprints of half the size change them by 2 to 3 %, joints as thick as the shafts by 8 %.
"""

from pathlib import Path

import numpy as np
import pytest
import solid_rig as rig
from scipy.sparse.linalg import eigsh

from gearpath.components import DOFS, Footprint, Material, Plate
from gearpath.modelfile.model import Model
from gearpath.modelfile.reading import read_toml
from gearpath.network.assemble import assemble
from gearpath.network.natural import natural_frequencies

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("calculix")]

FILE = Path(__file__).resolve().parents[2] / "models" / "test_rig.toml"
STEEL = Material(rig.YOUNG, rig.POISSON, rig.DENSITY)
FOOTPRINTS = {name: Footprint((0.0, y, 0.0), (rig.FOOT, rig.FOOT)) for name, y in rig.SHAFTS.items()}
AGREEMENT = 0.01


@pytest.fixture(scope="module")
def system():
    """The shipped model, up to 600 Hz."""
    return Model.from_dict(read_toml(FILE)).replace({"frequency.stop": 600.0}).system


def elastic(part, count):
    """Lowest elastic natural frequencies of a free component, Hz."""
    structure = part.structure(DOFS, {})
    shift = -((2 * np.pi * 30.0) ** 2)
    values = np.sort(eigsh(structure.stiffness, 6 + count, structure.mass, sigma=shift, return_eigenvectors=False))
    return np.sqrt(values[6:]) / (2 * np.pi)


@pytest.mark.parametrize("rigid", [False, True], ids=["plain", "footprints"])
@pytest.mark.parametrize(
    ("lengths", "elements"), [(rig.SMALL, (24, 43)), (rig.LARGE, (26, 34))], ids=["small", "large"]
)
def test_plates(lengths, elements, rigid, calculix, tmp_path):
    """Eight modes; our error falls as h^2, so the small plate up to 3.5 kHz takes the finer grid."""
    footprints = FOOTPRINTS if rigid else {}
    ours = elastic(Plate(STEEL, (0.0, 0.0, 0.0), lengths, rig.THICKNESS, elements, footprints=footprints), 8)
    theirs = rig.free_plate(lengths, rigid, rig.Grid()).frequencies(calculix, tmp_path, 8)
    np.testing.assert_allclose(ours, theirs, rtol=AGREEMENT)


def test_large_plate_of_the_model(system, calculix, tmp_path):
    theirs = rig.free_plate(rig.LARGE, True, rig.Grid()).frequencies(calculix, tmp_path, 8)
    np.testing.assert_allclose(elastic(system.components["plate"], 8), theirs, rtol=AGREEMENT)


def test_source(system, calculix, tmp_path):
    theirs = rig.source(rig.Grid()).frequencies(calculix, tmp_path, 12)
    np.testing.assert_allclose(elastic(system.components["source"], 12), theirs, rtol=AGREEMENT)


def test_assembly(system, calculix, tmp_path):
    """Reduced components coupled through the joints, as every computation with the model uses them."""
    ours = natural_frequencies(assemble(system).modal())
    assert ours[5] < 0.01 * ours[6]
    theirs = rig.assembly(rig.Grid()).frequencies(calculix, tmp_path, 12)
    np.testing.assert_allclose(ours[6:18], theirs, rtol=AGREEMENT)
