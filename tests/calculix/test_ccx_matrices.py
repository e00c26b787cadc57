"""Matrices that CalculiX writes itself, as a component: its natural frequencies are CalculiX's own."""

import subprocess

import numpy as np
import pytest
from ccx_deck import Deck
from ccx_solids import plate

import gearpath as gp

pytestmark = pytest.mark.xdist_group("calculix")

STEEL = (2.07e11, 0.3, 7850.0)


def block(layers):
    """A free steel block of 240 x 180 x 60 mm, ports at two corner nodes."""
    deck = Deck(*STEEL[:2])
    x, y = np.linspace(-0.12, 0.12, 5), np.linspace(-0.09, 0.09, 4)
    part = deck.add("BLOCK", plate(x, y, 0.0, 0.06, layers), STEEL[2])
    corners = [
        part.select(lambda a, b, c, s=s: (a * s > 0.119) & (b * s > 0.089) & (c * s > 0.029))[0] for s in (1, -1)
    ]
    return deck, [int(node) for node in corners]


@pytest.mark.parametrize("layers", [1, 2])
def test_natural_frequencies_are_those_of_calculix(calculix, tmp_path, layers):
    deck, corners = block(layers)
    wanted = deck.frequencies(calculix, tmp_path, 8)
    text = deck.text(1).replace("*FREQUENCY\n", "*FREQUENCY, SOLVER=MATRIXSTORAGE\n")
    (tmp_path / "block.inp").write_text(text)
    done = subprocess.run(
        [calculix.program, "block"],
        cwd=tmp_path,
        env=calculix.environment(),
        capture_output=True,
        text=True,
        check=False,
    )
    assert (tmp_path / "block.sti").is_file(), done.stdout[-2000:]
    data = {
        "name": "block",
        "dofs": ["ux", "uy", "uz"],
        "frequency": {"start": 10.0, "stop": float(1.2 * wanted[-1]), "points": 20},
        "components": {
            "block": {
                "kind": "matrices",
                "file": "block.sti",
                "ports": {"one": {"node": corners[0]}, "other": {"node": corners[1]}},
            }
        },
        "joints": {
            "spring": {"kind": "mount", "between": ["block.one", "ground"], "stiffness": np.diag([1e-3] * 3).tolist()}
        },
        "excitation": {"point": "block.other", "dof": "uz"},
    }
    model = gp.Model.from_dict(data, str(tmp_path / "model.toml"))
    found = gp.natural_frequencies(model)
    elastic = found[found > 10.0][:8]
    assert len(found[found <= 10.0]) == 6
    np.testing.assert_allclose(elastic, wanted, rtol=1e-6)
