"""Bearing geometry, load and torque as parameters of the python kind: the same as another model file."""

import warnings
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("fmpy")
pytest.importorskip("pythonfmu")

import fmpy
from fmpy.fmi1 import FMICallException
from python_gearbox import Host

import gearpath as gp
from gearpath.errors import InputError
from gearpath.fmu.python_design import design_parameters, redesign

MODELS = Path(__file__).parents[2] / "models"
PAIR = {"catalogue": "7206B-like", "arrangement": "back_to_back", "distance": 0.016, "preload": 300.0}
BALL = {"type": "ball", "balls": 9, "ball_diameter": 9.525e-3, "pitch_diameter": 46.0e-3}
BALL |= {"inner_conformity": 0.515, "outer_conformity": 0.525, "contact_angle": 0.0}
FREQUENCY = 731.0


def model(**changes):
    """A ball bearing and a pair that the torque loads, rollers with a load of their own, a matrix."""
    data = gp.load(MODELS / "gearbox.toml").to_dict()
    bearings = {
        "bearing_1": {"geometry": BALL, "damping_time": 1e-6},
        "bearing_2": {**PAIR, "damping": [[120.0, 0.0], [0.0, 0.06]]},
        "bearing_3": {"catalogue": "NU206-like", "load": {"uy": 900.0}, "damping_time": 1e-6},
    }
    for name, bearing in bearings.items():
        data["joints"][name] = {"kind": "bearing", "between": data["joints"][name]["between"], **bearing}
    found = gp.Model.from_dict({**data, "operation": {"torque": 100.0, "speed": 500.0}})
    return found.replace(changes) if changes else found


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return gp.export_fmu(model(), tmp_path_factory.mktemp("python") / "bearings.fmu", kind="python")


@contextmanager
def hosted(path, **values):
    host = Host(path)
    host.start(**values)
    try:
        yield host
    finally:
        host.free()


CHANGES = [
    {"bearing_1.geometry.ball_diameter": 8.5e-3, "bearing_1.geometry.balls": 8.0},
    {"operation.torque": 35.0},
    {"bearing_2.preload": 900.0, "bearing_2.distance": 0.02},
    {"bearing_3.load.uy": 4000.0},
    {"gear_train.input.diameter": 0.026},  # a softer shaft tilts its bearings more
]


def as_file(change):
    """The keys of the model file that say the same."""
    keys = {"gear_train.input.diameter": "components.gear_train.shafts.input.diameter"}
    return {
        keys.get(name, name if name.startswith("operation") else f"joints.{name}"): int(value)
        if "balls" in name
        else value
        for name, value in change.items()
    }


@pytest.mark.parametrize("change", CHANGES, ids=lambda change: next(iter(change)))
def test_a_changed_design_is_the_changed_model(path, change):
    with warnings.catch_warnings(), hosted(path, **change, frequency=FREQUENCY) as host:
        warnings.simplefilter("ignore")
        changed = model(**as_file(change))
        flow = gp.power_flow(changed, [FREQUENCY])
        names = ("alpha", "alpha_moment", "bearing_2.alpha", "bearing_1.stiffness[1,1]", "bearing_1.damping[1,2]")
        found = host.get(*names)
        K, C = (np.array(getattr(changed.system.joints["bearing_1"], what)) for what in ("stiffness", "damping"))
        by_joint = sum(float(flow.path_alpha.sel(path=f"bearing_2.{dof}")[0]) for dof in ("uy", "rx"))
        expected = [float(flow.alpha[0]), float(flow.alpha_moment[0]), by_joint, K[0, 0], C[0, 1]]
        assert found == pytest.approx(expected, rel=1e-9, abs=1e-9 * abs(by_joint))
        assert not np.isclose(flow.alpha[0], gp.power_flow(model(), [FREQUENCY]).alpha[0], rtol=1e-6)


def test_stiffness_is_the_derivative_of_the_load(path):
    """At another load than the exported one, by differences of the bearing's own load."""
    change = {"bearing_3.load.uy": 2500.0}
    with hosted(path, **change) as host:
        (stiffness,) = host.get("bearing_3.stiffness[1,1]")
    row = gp.catalogue_bearing("NU206-like")
    place = row.equilibrium({"uy": 2500.0}).displacement
    step = np.array([0.0, 1e-9, 0.0, 0.0, 0.0, 0.0])
    slope = (row.load(place + step) - row.load(place - step))[1] / 2e-9
    assert stiffness == pytest.approx(slope, rel=1e-6)


def test_declared_as_what_they_are(path):
    found = {v.name: v for v in fmpy.read_model_description(str(path)).modelVariables}
    assert found["bearing_1.stiffness[1,2]"].causality == "calculatedParameter"
    assert found["bearing_1.damping[1,1]"].causality == "calculatedParameter"
    assert found["bearing_2.stiffness[1,1]"].causality == "calculatedParameter"
    assert found["bearing_2.damping[1,1]"].causality == "parameter"  # a matrix of its own
    assert found["bearing_4.stiffness[1,1]"].causality == "parameter"
    for name in ("operation.torque", "operation.speed", "bearing_2.distance", "bearing_3.load.uy"):
        assert (found[name].causality, found[name].variability) == ("parameter", "fixed")
    assert found["bearing_1.geometry.balls"].start == "9.0"
    assert found["operation.torque"].unit == "N.m"


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("bearing_1.stiffness[1,1]", 1e8),
        ("bearing_1.geometry.balls", 8.5),
        ("bearing_1.geometry.ball_diameter", -1.0),
        ("operation.torque", np.nan),
    ],
)
def test_refused(path, name, value):
    host = Host(path)
    host.slave.setupExperiment(startTime=0.0)
    before = host.get(name)
    with pytest.raises(FMICallException, match="fmi2SetReal"):
        host.set({name: value})
    assert host.get(name) == before
    host.start()
    host.free()


def test_what_cannot_be_built_or_carried_is_said():
    system = model().system
    for values, words in (
        ({"bearing_1.geometry.balls": 40.0}, "do not fit"),
        ({"operation.torque": -5.0}, "is below 0"),
        ({"bearing_2.preload": -5.0}, "is below 0"),
        ({"bearing_1.geometry.inner_conformity": 0.4}, "inner_conformity: 0.4"),
        ({"bearing_3.load.uy": 1e15}, "cannot carry"),
    ):
        with pytest.raises(InputError, match=words):
            redesign(system, values)


def test_a_contact_angle_takes_the_place_of_the_clearance():
    loose = model(**{"joints.bearing_1.geometry.radial_clearance": 5e-6}).system
    row = redesign(loose, {"bearing_1.geometry.contact_angle": 0.2}).joints["bearing_1"].mounting.row
    assert (row.contact_angle, row.radial_clearance) == (0.2, 0.0)
    with pytest.raises(InputError, match="radial_clearance: "):
        redesign(loose, {"bearing_1.geometry.contact_angle": 0.2, "bearing_1.geometry.radial_clearance": 5e-6})


def test_reading_gives_what_was_set():
    system = model().system
    for parameter in design_parameters(system):
        if "bearing" not in parameter.name and "operation" not in parameter.name:
            continue
        value = parameter.read(system)
        again = parameter.edit(system, value)
        assert parameter.read(again) == value
        assert again.joints == system.joints, parameter.name
