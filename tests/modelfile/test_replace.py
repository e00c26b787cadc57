"""Changing a model by dotted paths."""

from pathlib import Path

import numpy as np
import pytest

from gearpath.errors import ModelError
from gearpath.modelfile import load

BASE = Path(__file__).parent / "base.toml"


@pytest.fixture(scope="module")
def model():
    return load(BASE)


def train(model):
    return model.system.components["train"]


def test_stiffness(model):
    changed = model.replace({"joints.front.stiffness": [[1.2e8, 0], [0, 0]]})
    assert changed.system.joints["front"].stiffness == ((1.2e8, 0.0), (0.0, 0.0))
    assert changed.system.joints["front"].damping[0] == pytest.approx((120.0, 0.0))
    assert changed != model
    assert model == load(BASE)
    assert changed.file == model.file
    assert changed.replace({"joints.front.stiffness": [[1.2e8, 1.8e6], [1.8e6, 6.0e4]]}) == model


def test_array_and_matrix_entries(model):
    changed = model.replace({"joints.front.stiffness": np.diag([1e8, 0.0])})
    assert changed.system.joints["front"].stiffness == ((1e8, 0.0), (0.0, 0.0))
    changed = model.replace({"joints.front.stiffness.0.1": 1e6, "joints.front.stiffness.1.0": 1e6})
    assert changed.system.joints["front"].stiffness == ((1.2e8, 1e6), (1e6, 6.0e4))
    with pytest.raises(ModelError, match="the matrix is not symmetric"):
        model.replace({"joints.front.stiffness.0.1": 1e6})


@pytest.mark.parametrize("disk", ["0", "pinion"])
def test_disk_by_index_or_name(model, disk):
    changed = model.replace({f"components.train.shafts.input.disks.{disk}.z": 0.12})
    assert train(changed).shafts["input"].disks[0].z == 0.12


def test_index(model):
    changed = model.replace({"components.casing.centre_of_gravity.0": np.float64(0.04)})
    assert changed.system.components["casing"].centre_of_gravity == (0.04, 0.0, 0.0)


def test_keys_left_to_their_defaults(model):
    path = "components.train.shafts.output.shear_coefficient"
    assert train(model.replace({path: 0.9})).shafts["output"].shear_coefficient == 0.9
    bare = model.replace({"excitation.displacement": 2e-6, "components.casing.inertia.xy": 0.01})
    assert bare.system.excitation.displacement == 2e-6
    assert bare.system.components["casing"].inertia["xy"] == 0.01


def test_damping_replaces_damping_time_and_back(model):
    changed = model.replace({"joints.front.damping": [[10.0, 0.0], [0.0, 1.0]]})
    assert changed.system.joints["front"].damping == ((10.0, 0.0), (0.0, 1.0))
    assert "damping_time" not in changed.to_dict()["joints"]["front"]
    assert changed.replace({"joints.front.damping_time": 1e-6}) == model


def test_diameter_replaces_sections_and_back(model):
    shaft = "components.train.shafts.output"
    changed = model.replace({f"{shaft}.length": 0.2, f"{shaft}.diameter": 0.05})
    assert [section.outer for section in train(changed).shafts["output"].sections] == [0.05]
    assert (
        changed.replace({f"{shaft}.sections": model.to_dict()["components"]["train"]["shafts"]["output"]["sections"]})
        == model
    )
    with pytest.raises(ModelError, match=r"output.length: is missing; give length and diameter in m, or sections"):
        model.replace({f"{shaft}.diameter": 0.05})


def test_point_replaces_mesh_and_back(model):
    changed = model.replace({"excitation.point": "casing", "excitation.dof": "uy"})
    assert changed.system.excitation.dof == "uy"
    assert changed.replace({"excitation.mesh": "train.mesh"}) == model


def test_both_of_an_exclusive_pair_are_refused(model):
    with pytest.raises(ModelError, match=r"joints.foot.damping_time: 1e-06 s is given beside damping"):
        model.replace({"joints.foot.damping": 1.0, "joints.foot.damping_time": 1e-6})


def test_nothing(model):
    assert model.replace({}) == model


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        ("joints.front.stifness", 1.0, 'there is no "stifness" in joints.front; did you mean \'stiffness\'?'),
        ("joints.fornt.stiffness", 1.0, "there is no \"fornt\" in joints; did you mean 'front'?"),
        ("joint.front.stiffness", 1.0, "there is no \"joint\" in the model; did you mean 'joints'?"),
        ("", 1.0, 'there is no "" in the model; known: name, dofs, frequency, materials, components, joints, '
                  "excitation, actuators, sensors, operation, catalogue_file, source"),
        ("name.first", "a", 'there is no "first" in name; end the path before it'),
        ("components.train.shafts.input.disks.2.z", 0.1,
         'there is no "2" in components.train.shafts.input.disks; known: pinion, 0'),
        ("components.casing.centre_of_gravity.3", 0.1,
         'there is no "3" in components.casing.centre_of_gravity; known: 0, 1, 2'),
        ("components.train.shafts.input.sections.0.outer", 0.1,
         'there is no "0" in components.train.shafts.input.sections; end the path before it'),
        ("components.casing.mass", -1, "-1 kg is not above 0; give the mass in kg, above 0"),
        ("joints.foot.stiffness", "1e7 N/m",
         '"1e7 N/m" is text, not a number; give the stiffness in N/m, at least 0, without quotes or unit'),
        ("joints.foot.damping", True, "true is not a number; give the damping in N s/m, at least 0"),
    ],
)  # fmt: skip
def test_refused(model, path, value, message):
    with pytest.raises(ModelError) as caught:
        model.replace({path: value})
    key = path or '""'
    assert str(caught.value) == f"{BASE}: {key}: {message}"


def test_path_must_be_text(model):
    with pytest.raises(ModelError, match=r'3: this is not a path; write it as text, "joints.bearing_1.stiffness"'):
        model.replace({3: 1.0})
