"""The sweep of a machine with a measured component: its line, its check, and the note of power that it gives off."""

import json
import re

import numpy as np
import pytest
from test_measured_files import GOOD, PORTS, W, build, machine, mobility, write_npz, write_uff

from gearpath.console import load_with
from gearpath.network.foreign import described
from gearpath.study.sweeping import reference_checks, run


def test_the_check_solves_the_machine_with_the_mobilities(tmp_path, capsys):
    write_npz(tmp_path, mobility())
    assert run(build(tmp_path, machine(GOOD)), None, check=True, json=False)
    out = capsys.readouterr().out
    assert out.count("passed") == 5
    assert "time twin" not in out
    assert "note" not in out


def test_power_that_the_data_give_off(tmp_path, capsys):
    """A cross mobility beyond what passive driving points allow, |Y_ab|^2 <= Re Y_aa Re Y_bb at a resonance."""
    Y = mobility()
    Y[:, 1, 2] *= 5.0
    Y[:, 2, 1] *= 5.0
    write_npz(tmp_path, Y)
    model = build(tmp_path, machine(GOOD))
    run(model, None, check=False, json=False)
    assert re.search(r"note: foundation gives off power on \d+ % of the lines", capsys.readouterr().out)
    failed = {check.name for check in reference_checks(model, quiet=True) if not check.passed}
    assert failed <= {"net power returned to the source", "alpha above 1"}
    assert failed


def test_the_line_of_a_measured_component(tmp_path):
    """Masses 1 / (w |Y_aa|) of the first line, 4 Hz, and the freedoms that a port lacks."""
    write_npz(tmp_path, mobility())
    model = build(tmp_path, machine(GOOD))
    mass = 1.0 / (W[0] * abs(np.diag(mobility()[0])))
    words = (
        f"measured, 3 channels, 100 lines from 4 to 400 Hz, at the first like {mass.min():.3g} to {mass.max():.3g} kg"
    )
    assert described(model.system) == {"foundation": words + "; without ux: foot"}
    spring = build(tmp_path, machine({**GOOD, "ports": {**PORTS, "foot": {"ux": 2}}}, joints=_joints_of_seat()))
    assert described(spring.system)["foundation"].endswith("; without uy: foot")


def _joints_of_seat():
    ends = ["block", "foundation.seat"]
    return {"bearing": {**machine(GOOD)["joints"]["bearing"], "between": ends}}


def test_a_foundation_on_springs_is_described_by_its_stiffness(tmp_path):
    k = np.array([2e6, 3e6, 4e6])
    Y = np.einsum("fa,ab->fab", 1j * W[:, None] / (k * (1 + 0.1j)), np.eye(3))
    write_npz(tmp_path, Y)
    words = described(build(tmp_path, machine(GOOD)).system)["foundation"]
    assert "at the first like 2.01e+06 to 4.02e+06 N/m" in words


@pytest.mark.filterwarnings("error")
def test_a_contradicted_unit_is_one_note(tmp_path, capsys):
    write_uff(tmp_path, mobility() * (1j * W)[:, None, None], (1, 2, 2), length=None, labels=("g", "N"))
    ports = {"seat": {"ux": "1:ux", "uy": "2:uy"}, "foot": {"uy": "3:uy"}}
    data = machine({"file": "data.unv", "unit_motion": "m/s^2", "ports": ports})
    path = tmp_path / "model.toml"
    path.write_text("\n".join(f"{key} = {_toml(value)}" for key, value in data.items()))
    load_with(path, [])
    assert capsys.readouterr().err.count("counts, though the file says g on an axis") == 1


def _toml(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {_toml(item)}" for key, item in value.items()) + " }"
    return json.dumps(value)
