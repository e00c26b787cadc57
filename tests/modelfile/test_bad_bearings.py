"""Bad rolling bearings are refused with one sentence, good ones say what they are; edits are in bad_bearings.toml."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from jsonschema import Draft202012Validator

import gearpath as gp
from gearpath.errors import ModelError
from gearpath.modelfile.schema import json_schema

HERE = Path(__file__).parent
BASE = (HERE / "base_bearings.toml").read_text(encoding="utf-8")
CASES = tomllib.loads((HERE / "bad_bearings.toml").read_text(encoding="utf-8"))["case"]
VALIDATOR = Draft202012Validator(json_schema())


@pytest.mark.parametrize("case", CASES, ids=[case["message"].split("; ")[0] for case in CASES])
def test_bad_bearing(case, tmp_path):
    path = tmp_path / "bad.toml"
    assert BASE.count(case["old"]) == 1
    text = BASE.replace(case["old"], case["new"])
    if "table operation with" in case["message"] or "comes apart" in case["message"]:
        text = text.replace("[operation]\ntorque = 100.0\n", "")
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ModelError) as caught:
        gp.load(path)
    assert str(caught.value) == f"{path}: {case['message']}"


def model(**front):
    data = tomllib.loads(BASE)
    data["joints"]["front"] = {**data["joints"]["front"], **front}
    return gp.Model.from_dict(data)


def test_base_is_good():
    VALIDATOR.validate(tomllib.loads(BASE))
    found = model()
    again = type(found).from_dict(found.to_dict())
    assert found == again
    assert found.system.joints["front"].mounting.follows_operation


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('catalogue = "6206-like"', ""),
        ('catalogue = "6206-like"', 'catalogue = "6206-like"\nstiffness = 1.0'),
        ('catalogue = "6206-like"', 'catalogue = "6206-like"\nload = { rz = 1.0 }'),
        ("rollers = 13", "rolers = 13"),
        ('type = "roller"', 'type = "ball"'),
        ("torque = 100.0", "torque = -1.0"),
    ],
)
def test_schema_refuses(old, new):
    assert not VALIDATOR.is_valid(tomllib.loads(BASE.replace(old, new)))


def test_load_by_name_holds_the_rest():
    """And a list on dofs frees them all; both against the bearing by itself."""
    row = gp.catalogue_bearing("6206-like")
    by_name = model(load={"uy": 900.0}).system.joints["front"]
    K = row.equilibrium({"uy": 900.0}).stiffness
    assert np.array_equal(by_name.stiffness, K[np.ix_([1, 3], [1, 3])])
    by_list = model(load=[900.0, 0.5]).system.joints["front"]
    K = row.equilibrium({"uy": 900.0, "rx": 0.5}).stiffness
    assert np.array_equal(by_list.stiffness, K[np.ix_([1, 3], [1, 3])])
    assert np.allclose(by_list.damping, 1e-6 * np.array(by_list.stiffness), rtol=1e-15)


def test_displacement_and_preload():
    row = gp.catalogue_bearing("7206B-like")
    front = model(catalogue="7206B-like", displacement={"uy": 5e-6, "uz": 2e-5}).system.joints["front"]
    K = row.stiffness([0.0, 5e-6, 2e-5, 0.0, 0.0, 0.0])
    assert np.array_equal(front.stiffness, K[np.ix_([1, 3], [1, 3])])
    preloaded = model(catalogue="7206B-like", preload=700.0, displacement={"uy": 0.0}).system.joints["front"]
    K = row.equilibrium({"uz": 700.0}).stiffness
    assert np.allclose(preloaded.stiffness, K[np.ix_([1, 3], [1, 3])], rtol=1e-9)
    turned = model(catalogue="7206B-like", preload=700.0, displacement={"uy": 0.0}, mirrored=True).system.joints[
        "front"
    ]
    assert np.allclose(turned.stiffness, K[np.ix_([1, 3], [1, 3])] * np.array([[1, -1], [-1, 1]]), rtol=1e-9)


@pytest.mark.parametrize(("arrangement", "side"), [("back_to_back", 1.0), ("face_to_face", -1.0)])
def test_pairs(arrangement, side):
    """Tilt stiffness of a preloaded pair about its middle: 2 (Kyy L^2/4 +- L |Ky,thx| + Kthth), + back to back."""
    L, force = 0.02, 600.0
    pair = model(
        catalogue="7206B-like", preload=force, arrangement=arrangement, distance=L, displacement={"uy": 0.0}
    ).system.joints["front"]
    K = gp.catalogue_bearing("7206B-like").equilibrium({"uz": force}).stiffness
    expected = 2.0 * (K[1, 1] * L**2 / 4.0 + side * L * abs(K[1, 3]) + K[3, 3])
    assert pair.stiffness[1][1] == pytest.approx(expected, rel=1e-9)
    assert pair.stiffness[0][0] == pytest.approx(2.0 * K[1, 1], rel=1e-9)


def test_own_catalogue(tmp_path):
    """Beside the model file, and before the one that comes with the package."""
    (tmp_path / "mine.toml").write_text(
        '[mine]\ntype = "ball"\nballs = 8\nball_diameter = 9e-3\npitch_diameter = 45e-3\n'
        "inner_conformity = 0.52\nouter_conformity = 0.52\ncontact_angle = 0.0\n",
        encoding="utf-8",
    )
    path = tmp_path / "model.toml"
    text = BASE.replace('name = "small"', 'name = "small"\ncatalogue_file = "mine.toml"')
    path.write_text(text.replace('"6206-like"', '"mine"'), encoding="utf-8")
    assert gp.load(path).system.joints["front"].mounting.bearing.balls == 8
    assert gp.load(path).replace({"joints.front.catalogue": "6206-like"}).system
    path.write_text(text.replace('"6206-like"', '"none"'), encoding="utf-8")
    with pytest.raises(ModelError, match=r'joints.front.catalogue: there is no bearing "none"; known: '):
        gp.load(path)
    (tmp_path / "mine.toml").unlink()
    with pytest.raises(ModelError, match=r"catalogue_file: mine.toml: there is no such file"):
        gp.load(path)


def test_replace_of_keys_that_exclude_each_other():
    found = model()
    given = found.replace({"joints.front.stiffness": [[1e8, 0.0], [0.0, 1e4]]})
    assert given.system.joints["front"].mounting is None
    geometry = {"type": "ball", "balls": 9, "ball_diameter": 9.525e-3, "pitch_diameter": 46e-3}
    geometry |= {"inner_conformity": 0.515, "outer_conformity": 0.525, "contact_angle": 0.0}
    back = given.replace({"joints.front.geometry": geometry})
    assert back.system == found.system
    fewer = back.replace({"joints.front.geometry.balls": 8})
    assert fewer.system.joints["front"].stiffness != back.system.joints["front"].stiffness
    assert found.replace({"operation.torque": 50.0}).table.operation.torque == 50.0
