"""A model file with a measured component, all the way: power flow of the data, FMUs of its fit."""

import numpy as np
import pytest
from test_measured_files import GOOD, build, machine, mobility, write_npz

import gearpath as gp
from gearpath.errors import InputError


@pytest.fixture(scope="module")
def model(tmp_path_factory):
    folder = tmp_path_factory.mktemp("measured")
    write_npz(folder, mobility())
    return build(folder, machine(GOOD))


def test_power_flow_of_the_data(model):
    """Closed form: the block drives the seat through the bearing; the foot stands on the mount."""
    f = model.frequencies()
    flow = gp.power_flow(model, f)
    np.testing.assert_allclose(flow.dissipated_power.sum("element"), flow.input_power, rtol=1e-9)
    w = 2 * np.pi * np.arange(4.0, 401.0, 4.0)[[20, 50]]
    flow = gp.power_flow(model, w / (2 * np.pi))
    for k, (one, Y) in enumerate(zip(w, mobility(w))):
        body = np.diag([1 / 3.0, 1 / 3.0, 0.0]) / (1j * one) + 0j
        arm = np.array([0.0, 0.1, 0.0])  # of uy at the bearing, under a turn about z: rigid block, centre at the origin
        turn = np.outer(arm, arm) / 0.1 / (1j * one)
        block = (body + turn)[:2, :2]
        foot = 1e5 / (1j * one) + 10.0
        seat = Y[:2, :2] - np.outer(Y[:2, 2], Y[2, :2]) / (Y[2, 2] + 1 / foot)
        Z = 2e6 / (1j * one) + 20.0
        force = np.linalg.solve(np.eye(2) / Z + block + seat, body[:2, 1])
        np.testing.assert_allclose(flow.force.values[:, k], force, rtol=1e-9, atol=1e-12)
        power = 0.5 * np.real(np.vdot(seat @ force, force))
        np.testing.assert_allclose(flow.transmitted_power.values[k], power, rtol=1e-9)


def test_lines_off_the_band_are_refused(model):
    with pytest.raises(InputError, match="1000 Hz is outside 4 to 400 Hz, where foundation was measured"):
        gp.power_flow(model, [100.0, 1000.0])


def test_state_space_is_that_of_the_fit(model):
    pytest.importorskip("control")
    system = gp.state_space(model)
    w = 2 * np.pi * np.arange(12.0, 400.0, 28.0)  # measured lines
    wanted = gp.frequency_response(model, w / (2 * np.pi), "bearing.force_uy", "excitation.force").values[:, 0, 0]
    column = system.input_labels.index("excitation/force")
    row = system.output_labels.index("bearing/force_uy")
    found = np.array([system(1j * one)[row, column] for one in w])
    assert abs(found - wanted).max() < 0.02 * abs(wanted).max()


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["native", "python"])
def test_fmus_of_both_kinds_pass_the_validation(model, tmp_path, kind):
    """Each kind is held against the power flow of the fit, python-control and the other kind."""
    path = gp.export_fmu(model, tmp_path / f"{kind}.fmu", kind=kind, documentation=False)
    report = gp.validate_fmu(path, model)
    assert report.passed, [check for check in report.checks if not check.passed]
    assert "4 to 400 Hz" in report.notes["foundation"]
