"""The model's data as tables."""

from pathlib import Path

import pytest

import gearpath as gp
from gearpath.report.model_tables import source_table

MODELS = Path(__file__).resolve().parents[2] / "models"


def test_every_tone_of_the_source_with_its_order():
    table = source_table(gp.load(MODELS / "helical_gearbox.toml").system)
    assert "1480 rev/min" in table.caption
    rows = {str(row[0]): row[1:] for row in table.groups[0].rows}
    assert rows["mesh.harmonic_2"][0] == "64"  # twice 32 teeth
    assert rows["mesh.sideband_1"][0] == "31"  # one shaft order below the first harmonic
    assert len(rows) == 7


@pytest.mark.parametrize("name", ["gearbox", "test_rig"])
def test_no_source_no_table(name):
    assert not source_table(gp.load(MODELS / f"{name}.toml").system).groups[0].rows
