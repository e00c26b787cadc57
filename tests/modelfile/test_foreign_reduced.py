"""Casings from files, bolted rigidly, in reduced models and reduced FMUs."""

import numpy as np
import pytest
from foreign_cases import frame_model, matrices_of, with_casing, written

import gearpath as gp


@pytest.fixture(scope="module")
def bolted(tmp_path_factory):
    """The gearbox in a frame given by matrices, damped by 1 %, which stands on the ground by one rigid foot."""
    folder = tmp_path_factory.mktemp("bolted")
    model = frame_model()
    K, M, ports = matrices_of(model)
    table = written("sparse npz", K, M, ports, folder) | {"loss_factor": 0.0, "modal_damping": 0.01}
    data = with_casing(model, table, folder).to_dict()
    data["joints"]["mount_1"] = {"kind": "rigid", "between": data["joints"]["mount_1"]["between"]}
    return gp.Model.from_dict(data, str(folder / "model.toml"))


def test_the_reduced_model_keeps_its_certificate(bolted):
    found = gp.reduce(bolted, tolerance=1e-3)
    f = np.linspace(50.0, 2000.0, 3000)
    H = gp.frequency_response(bolted, f).values
    gain = abs(H).max(axis=0)
    deviation = abs(np.moveaxis(found(2j * np.pi * f), -1, 0) - H).max(axis=0)
    assert (
        deviation <= found.certificate.error * np.maximum(gain, 1e-9 * gain.max(axis=0)) + 1e-12 * gain.max(axis=0)
    ).all()
    assert found.certificate.error <= 1e-3
    assert found.certificate.order < 0.4 * found.certificate.complete
    assert found.certificate.passive


@pytest.mark.slow
def test_the_reduced_fmu_is_valid(bolted, tmp_path):
    path = gp.export_fmu(bolted, tmp_path / "it.fmu", tolerance=1e-3, documentation=False)
    report = gp.validate_fmu(path, bolted)
    assert report.passed, [check for check in report.checks if not check.passed]
