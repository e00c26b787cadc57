"""The gear mesh source of a model file: what it becomes, where it acts, and how it is changed."""

import tomllib
from pathlib import Path

import pytest

from gearpath import components, joints
from gearpath.errors import ModelError
from gearpath.modelfile import Model, load
from gearpath.network import system
from gearpath.network.assemble import assemble
from gearpath.network.records import MeshSource, Tone

HERE = Path(__file__).parent
ROOT = HERE.parents[1]


@pytest.fixture(scope="module")
def model():
    base, source = ((HERE / name).read_text(encoding="utf-8") for name in ("base.toml", "source_table.toml"))
    return Model.from_dict(tomllib.loads(f"{base}\n{source}"))


def test_what_it_becomes(model):
    assert model.system.source == MeshSource(
        load="mesh.transmission_error",
        speed=3000.0,
        teeth=23,
        tones=(
            Tone("mesh.harmonic_1", 1.0, 0.0, 2e-6, 0.0),
            Tone("mesh.harmonic_3", 3.0, 0.0, 0.0, -0.7),
            Tone("mesh.sideband_1", 1.0, -1.0, 3e-7, 0.0),
            Tone("mesh.sideband_2", 2.0, 0.98, 1e-7, 0.0),
        ),
    )
    network = assemble(model.system).modal()
    assert network.source == model.system.source
    assert network.source.load in [load.name for load in network.loads]


def test_left_out_there_is_none(model):
    assert load(ROOT / "models" / "gearbox.toml").system.source is None
    without = model.replace({"source": None})
    assert without.system.source is None
    assert assemble(without.system).modal().source is None
    assert without.replace({"source": model.to_dict()["source"]}) == model


def test_values_are_replaced_by_path(model):
    numbers = {"source.speed": -1500, "source.teeth": 31}
    source = model.replace(numbers | {"source.harmonics.0.amplitude": 0, "source.sidebands.1.order": 2}).system.source
    assert (source.speed, source.teeth) == (-1500.0, 31)
    assert [tone.amplitude for tone in source.tones] == [0.0, 0.0, 3e-7, 1e-7]
    assert [tone.shift for tone in source.tones] == [0.0, 0.0, -1.0, 2.0]
    more = [{"order": k, "amplitude": 1e-6 / k} for k in range(1, 8)]
    assert len(model.replace({"source.harmonics": more}).system.source.tones) == 9


def test_a_path_into_a_table_that_is_left_out(model):
    with pytest.raises(ModelError, match=r'there is no "speed" in source; set all of source, which is left out$'):
        model.replace({"source": None}).replace({"source.speed": 100.0})


def test_it_acts_beside_any_excitation(model):
    network = assemble(model.replace({"excitation.point": "casing", "excitation.dof": "uy"}).system).modal()
    assert network.excitation == "excitation.force"
    assert network.source.load == "mesh.transmission_error"
    assert network.source.load in [load.name for load in network.loads]


def test_without_a_mesh():
    rig = load(ROOT / "models" / "test_rig.toml").to_dict()
    source = {"speed": 1000.0, "teeth": 20, "harmonics": [{"order": 1, "amplitude": 1e-6}]}
    with pytest.raises(
        ModelError, match=r"^source: there is no gear mesh that it could act on; add a mesh, or leave the table out$"
    ):
        Model.from_dict(rig | {"source": source})


def test_of_several_meshes_one_is_named(model):
    data = model.to_dict()
    train = data["components"]["train"]
    train["shafts"]["third"] = train["shafts"]["output"] | {"origin": [0.15, 0.0, -0.1]}
    train["meshes"]["second"] = train["meshes"]["mesh"] | {"between": ["output.wheel", "third.wheel"]}
    with pytest.raises(
        ModelError, match=r'^source.mesh: is missing; give one of the meshes, "train.mesh" or "train.second"$'
    ):
        Model.from_dict(data)
    data["source"]["mesh"] = "train.second"
    source = Model.from_dict(data).system.source
    assert source.load == "second.transmission_error"
    assert source.tones[0].name == "second.harmonic_1"


def test_repr_of_the_system_builds_it_again(model):
    scope = {**vars(components), **vars(joints), **vars(system)}
    assert eval(repr(model.system), scope) == model.system
