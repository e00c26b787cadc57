"""FMUs of a gearbox whose casing is bolted to a beam: two components, with two damping ratios, that move as one."""

from pathlib import Path

import numpy as np
import pytest
from fmu_driver import OK, Fmu

import gearpath as gp
from gearpath.fmu.conformance import check_conformance

MODEL = gp.load(Path(__file__).parents[2] / "models" / "gearbox.toml")
HERTZ = [90.0, 640.0, 2100.0]


def bolted():
    """The gearbox on a beam (0.4 m, damping ratio 0.03) that stands on two of its mounts and on the floor."""
    data = MODEL.to_dict()
    data["components"]["base"] = {
        "kind": "gear_train",
        "modal_damping": 0.03,
        "shafts": {"beam": {"material": "steel", "origin": [0.0, 0.0, -0.2], "length": 0.4, "diameter": 0.05}},
    }
    data["components"]["base"]["shafts"]["beam"]["elements"] = 3
    for name, end in (("bolt_1", 0.08), ("bolt_2", 0.32)):
        data["joints"][name] = {"kind": "rigid", "between": [f"base.beam@{end}", "casing"]}
    data["joints"]["wall"] = {"kind": "rigid", "between": ["base.beam@0.0", "ground"], "dofs": ["uy"]}
    del data["joints"]["mount_3"], data["joints"]["mount_4"]
    return type(MODEL).from_dict(data)


@pytest.fixture(scope="module")
def model():
    return bolted()


@pytest.fixture(scope="module")
def path(model, tmp_path_factory):
    return gp.export_fmu(model, tmp_path_factory.mktemp("fmu") / "bolted.fmu")


def test_frequency_outputs_are_the_power_flow_for_any_damping(model, path, tmp_path):
    fmu = Fmu(Fmu.unpack(path, tmp_path / "it"))
    fmu.start()
    for ratio in (0.03, 0.1):
        changed = model.replace({"components.base.modal_damping": ratio})
        flow = gp.power_flow(changed, HERTZ)
        assert fmu.set({"base.modal_damping": ratio}) == OK
        for k, hertz in enumerate(HERTZ):
            assert fmu.set({"frequency": hertz}) == OK
            alpha, real, imaginary = fmu.get(["alpha", "frf.bearing_2.force_uy.re", "frf.bearing_2.force_uy.im"])
            force = complex(flow.force.sel(path="bearing_2.uy")[k]) / model.system.excitation.displacement
            assert alpha == pytest.approx(float(flow.alpha[k]), rel=1e-9)
            assert complex(real, imaginary) == pytest.approx(force, rel=1e-9)
    fmu.free()


def test_names_follow_the_standard(path):
    assert not check_conformance(path)
    description = Fmu.unpack(path, path.parent / "names").description
    assert "'casing+base'.mode_1.x" in [variable.name for variable in description.modelVariables]


def test_power_is_lost_where_the_joined_body_bends(model):
    flow = gp.power_flow(model, np.array(HERTZ))
    lost = flow.dissipated_power.sel(element="casing+base")
    assert (lost > 0.0).all()
    np.testing.assert_allclose(flow.dissipated_power.sum("element"), flow.input_power, rtol=1e-8)
