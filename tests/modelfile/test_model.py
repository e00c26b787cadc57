"""The model: loading, what it holds, equality, to_dict and the repr of its system."""

import pickle
from pathlib import Path

import numpy as np
import pytest
from systems import default_gearbox

from gearpath import components, joints
from gearpath.errors import ModelError
from gearpath.joints import Port
from gearpath.modelfile import Model, load
from gearpath.network import system as network_system
from gearpath.network.assemble import assemble

ROOT = Path(__file__).parents[2]
GEARBOX = ROOT / "models" / "gearbox.toml"
BASE = Path(__file__).parent / "base.toml"
SCOPE = {**vars(components), **vars(joints), **vars(network_system)}


@pytest.fixture(params=[GEARBOX, BASE], ids=["gearbox", "base"])
def model(request):
    return load(request.param)


def test_default_gearbox():
    model = load(str(GEARBOX))
    assert (model.name, model.dofs, model.file) == ("gearbox", ("uy", "rx"), str(GEARBOX))
    assert model.frequency.points == 2000
    np.testing.assert_array_equal(model.frequency.frequencies(), np.linspace(20.0, 5000.0, 2000))
    np.testing.assert_array_equal(model.frequencies(), model.frequency.frequencies())
    assert list(model.system.joints) == [f"bearing_{k}" for k in range(1, 5)] + [f"mount_{k}" for k in range(1, 5)]


def test_default_gearbox_is_the_one_written_by_hand():
    built, by_hand = load(GEARBOX).system, default_gearbox()
    assert built.components == by_hand.components
    assert built.excitation == by_hand.excitation
    for name, joint in by_hand.joints.items():
        assert built.joints[name].between == joint.between
        assert built.joints[name].at == joint.at
        np.testing.assert_allclose(built.joints[name].stiffness, joint.stiffness, rtol=1e-15)
        np.testing.assert_allclose(built.joints[name].damping, joint.damping, rtol=1e-15)


def test_round_trip(model):
    again = Model.from_dict(model.to_dict())
    assert again == model
    assert hash(again) == hash(model)
    assert again.system == model.system
    assert again.to_dict() == model.to_dict()


def test_repr_of_the_system_builds_it_again(model):
    assert eval(repr(model.system), SCOPE) == model.system


def test_system_is_plain(model):
    def walk(item):
        if isinstance(item, dict):
            assert all(type(key) is str for key in item)
            item = list(item.values())
        elif hasattr(item, "__dataclass_fields__"):
            item = list(vars(item).values())
        elif isinstance(item, tuple):
            item = list(item)
        else:
            assert type(item) in (float, int, str, bool, type(None)), item
            return
        for part in item:
            walk(part)

    walk(model.system)


def test_model_assembles(model):
    assert assemble(model.system).modal().eigenvalues.size > 0


def test_pickle(model):
    assert pickle.loads(pickle.dumps(model)) == model


def test_defaults_are_content():
    """Leaving a default out or writing it is the same model."""
    data = load(BASE).to_dict()
    del data["excitation"]["displacement"], data["sensors"]["gear"]["quantity"]
    assert Model.from_dict(data) == load(BASE)
    del data["frequency"]
    model = Model.from_dict(data)
    assert (model.frequency.start, model.frequency.stop, model.frequency.points) == (20.0, 5000.0, 2000)
    assert model != load(BASE)


def test_immutable(model):
    with pytest.raises(AttributeError):
        model.file = "other"
    with pytest.raises(ValueError, match="frozen"):
        model.frequency.start = 1.0
    data = model.to_dict()
    data["components"]["casing"]["mass"] = 1.0
    assert model.system.components["casing"].mass == 12.0


def test_from_dict_takes_arrays_and_keeps_no_alias():
    data = load(BASE).to_dict()
    stiffness = np.array([[1.2e8, 1.8e6], [1.8e6, 6.0e4]])
    data["joints"]["front"]["stiffness"] = stiffness
    data["components"]["casing"]["mass"] = np.float64(12.0)
    model = Model.from_dict(data)
    stiffness[:] = 0.0
    assert model == load(BASE)


@pytest.mark.parametrize("data", [None, [], "gearbox.toml", 3])
def test_from_dict_wants_a_table(data):
    with pytest.raises(ModelError, match=r"the file: .* is not a table; write it as a TOML table"):
        Model.from_dict(data)


def test_from_dict_refuses_none_and_cycles():
    data = load(BASE).to_dict()
    data["joints"]["foot"]["damping"] = None
    with pytest.raises(ModelError, match=r"^joints.foot.damping: None is not a number; give the damping"):
        Model.from_dict(data)
    data["joints"] = data
    with pytest.raises(ModelError, match="nested too deeply"):
        Model.from_dict(data)


def test_what_the_system_holds():
    system = load(BASE).system
    output = system.components["train"].shafts["output"]
    assert output.length == pytest.approx(0.2)
    assert output.shear_coefficient is None
    wide = (1 + 0.25**2) ** 2
    hollow = 6 * 1.3 * wide / (8.8 * wide + 23.6 * 0.25**2)
    assert [output.shear_coefficient_of(s) for s in output.sections] == pytest.approx([hollow, 6 * 1.3 / 8.8])
    assert system.components["train"].shafts["input"].shear_coefficient_of(output.sections[0]) == 0.886
    assert output.elements == (8,)
    assert system.joints["front"].between == (Port("train", "input", z=0.0), Port("casing"))
    np.testing.assert_allclose(system.joints["front"].damping, [[120.0, 1.8], [1.8, 0.06]], rtol=1e-15)
    foot = system.joints["foot"]
    assert (foot.dofs, foot.stiffness, foot.damping, foot.scalar) == (("uy",), ((1.0e7,),), ((440.0,),), True)
    assert system.sensors["gear"].port == Port("train", "input", disk="pinion")
    assert system.sensors["top"].at is None
    assert system.actuators["shaker"].at == (0.1, 0.0, 0.0)


def test_point_excitation():
    data = load(BASE).to_dict()
    data["excitation"] = {"point": "train.input.pinion", "dof": "uy", "force": 2}
    excitation = Model.from_dict(data).system.excitation
    assert excitation == network_system.PointExcitation(Port("train", "input", disk="pinion"), "uy", 2.0)


def test_all_freedoms_by_default():
    data = load(BASE).to_dict()
    del data["dofs"]
    for name in ("front", "rear"):
        data["joints"][name]["stiffness"] = np.diag([1e8, 1e8, 1e8, 1e4, 1e4, 0.0])
        data["joints"][name].pop("damping", None)
    model = Model.from_dict(data)
    assert model.dofs == ("ux", "uy", "uz", "rx", "ry", "rz")
    assert np.shape(model.system.joints["rear"].damping) == (6, 6)
    assert not np.any(model.system.joints["rear"].damping)


def two_trains(gap):
    """Base with a second train that is coupled to the end of the input shaft, `gap` metres from it."""
    data = load(BASE).to_dict()
    shaft = {"material": "steel", "origin": [-0.05, 0.0, 0.1 + gap], "length": 0.2, "diameter": 0.03}
    data["components"]["motor"] = {"kind": "gear_train", "shafts": {"rotor": shaft}}
    data["components"]["train"]["shafts"]["input"]["elements"] = 4
    data["joints"]["coupling"] = {
        "kind": "mount",
        "between": ["train.input@0.2", "motor.rotor@0.0"],
        "stiffness": 1e7,
    }
    return data


def test_coupling_of_two_shafts():
    assert Model.from_dict(two_trains(0.0)).system.joints["coupling"].at is None
    with pytest.raises(ModelError, match=r"^joints.coupling.between: the stations .* are 0.02 m apart; "):
        Model.from_dict(two_trains(0.02))


@pytest.mark.parametrize("freedoms", [["uy", "rx"], ["uy", "rz"]])
def test_gears_in_series_are_no_loop(freedoms):
    data = load(BASE).to_dict()
    data["dofs"] = freedoms
    train = data["components"]["train"]
    wheel = dict(train["shafts"]["output"]["disks"][0], name="last")
    train["shafts"]["third"] = {**train["shafts"]["input"], "origin": [0.15, 0.0, -0.1], "disks": [wheel]}
    train["shafts"]["third"]["elements"] = 4
    train["meshes"]["second"] = {
        "between": ["output.wheel", "third.last"],
        "stiffness": 1e8,
        "base_radii": [0.05, 0.05],
    }
    data["joints"]["third"] = {
        "kind": "bearing",
        "between": ["train.third@0.0", "casing"],
        "stiffness": [[1e8, 0.0], [0.0, 0.0]],
    }
    data["sensors"]["top"]["dof"] = "uy"
    assemble(Model.from_dict(data).system).modal()
    data["joints"]["front"]["between"][0] = "train.input@0.2"
    del train["meshes"]["second"]
    assemble(Model.from_dict(data).system).modal()
