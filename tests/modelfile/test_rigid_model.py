"""Rigid joints in a model file: what they become, and every mistake as one sentence (bad_rigid.toml)."""

import tomllib
from pathlib import Path

import pytest
from test_bad_files import check

from gearpath.errors import ModelError
from gearpath.joints import Joint, Port
from gearpath.modelfile import Model, load
from gearpath.network.assemble import assemble

HERE = Path(__file__).parent
TEXT = "".join((HERE / name).read_text(encoding="utf-8") for name in ("base.toml", "rigid_table.toml"))
CASES = tomllib.loads((HERE / "bad_rigid.toml").read_text(encoding="utf-8"))["case"]
DATA = tomllib.loads(TEXT)


@pytest.mark.parametrize("case", CASES, ids=[case["message"].split(": ")[0] for case in CASES])
def test_bad_file(case, tmp_path):
    check(TEXT, case, tmp_path / "bad.toml")


def test_a_rigid_joint_has_no_matrices(tmp_path):
    path = tmp_path / "good.toml"
    path.write_text(TEXT, encoding="utf-8")
    model = load(path)
    between = (Port("casing"), Port("frame"))
    assert model.system.joints["weld"] == Joint("rigid", between, ("uy",), (), (), (0.0, -0.1, 0.05))
    network = assemble(model.system)
    assert "weld" not in [joint.name for joint in network.joints]
    assert not [output.name for output in network.outputs if output.name.startswith("weld")]
    assert list(network.modal().components) == ["train", "casing+frame"]


def test_left_out_dofs_are_all_that_both_ends_have():
    joints = {**DATA["joints"], "weld": {**DATA["joints"]["weld"]}}
    del joints["weld"]["dofs"]
    model = Model.from_dict({**DATA, "joints": joints})
    assert model.system.joints["weld"].dofs == ()
    assert len(assemble(model.system).rigid[0].rows) == 2
    changed = model.replace({"joints.weld.dofs": ["rx"]})
    assert len(assemble(changed.system).rigid[0].rows) == 1


def test_rigid_joints_alone_carry_no_force():
    weld = {"kind": "rigid", "between": ["train.input@0.0", "casing"]}
    other = {"kind": "rigid", "between": ["casing", "frame"], "at": [0.0, 0.0, 0.0]}
    with pytest.raises(ModelError, match=r"^joints: all of them are rigid, .*; add a bearing or a mount$"):
        Model.from_dict({**DATA, "joints": {"weld": weld, "other": other}})


def test_bearings_that_lead_in_a_circle_through_a_joined_body_are_refused():
    """front leads from the train to the casing, back from the frame, which is one with it, to the train."""
    back = {"kind": "bearing", "between": ["frame", "train.output@0.0"], "stiffness": [[1e8, 0.0], [0.0, 0.0]]}
    with pytest.raises(ModelError, match=r"^joints.back.between: .* leads from frame to train, and other joints lead"):
        Model.from_dict({**DATA, "joints": {**DATA["joints"], "back": back}})
