"""The JSON schema says what the tables say."""

import json
import tomllib
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from gearpath.modelfile.joint_tables import MatrixJointTable
from gearpath.modelfile.schema import json_schema, schema_text
from gearpath.modelfile.structure_tables import PlateShape
from gearpath.modelfile.table import Table
from gearpath.modelfile.tables import ActuatorTable, FileTable

ROOT = Path(__file__).parents[2]
HERE = Path(__file__).parent
SCHEMA = json_schema()
TABLES = {
    table.__name__: table
    for base in (Table, ActuatorTable, PlateShape, MatrixJointTable)
    for table in base.__subclasses__()
    if table is not MatrixJointTable
}
VALIDATOR = Draft202012Validator(SCHEMA)
BASE, SOURCE = ((HERE / name).read_text(encoding="utf-8") for name in ("base.toml", "source_table.toml"))
WITH_SOURCE = f"{BASE}\n{SOURCE}"


def test_is_a_schema():
    Draft202012Validator.check_schema(SCHEMA)


def test_stored_copy_is_the_generated_one():
    """Regenerate: python -c "from gearpath.modelfile.joint_tables import MatrixJointTable
    from gearpath.modelfile.schema import schema_text as s; print(s(), end='')"."""
    stored = (ROOT / "models" / "gearpath.schema.json").read_text(encoding="utf-8")
    assert stored == schema_text()
    assert json.loads(stored) == SCHEMA


@pytest.mark.parametrize("path", [*(ROOT / "models").glob("*.toml"), HERE / "base.toml"], ids=lambda p: p.stem)
def test_models_are_valid(path):
    VALIDATOR.validate(tomllib.loads(path.read_text(encoding="utf-8")))


def test_a_source_is_valid():
    VALIDATOR.validate(tomllib.loads(WITH_SOURCE))


def test_every_table_is_there():
    assert set(SCHEMA["$defs"]) == set(TABLES) - {"FileTable"}


@pytest.mark.parametrize("name", sorted(TABLES))
def test_keys_are_the_fields(name):
    schema = SCHEMA if name == "FileTable" else SCHEMA["$defs"][name]
    fields = TABLES[name].model_fields
    assert list(schema["properties"]) == list(fields)
    assert set(schema.get("required", ())) == {key for key, field in fields.items() if field.is_required()}
    assert schema["additionalProperties"] is False
    assert schema["description"]
    for key, entry in schema["properties"].items():
        assert entry["description"], key


def numbers(schema):
    """All keys that are numbers or lists of numbers."""
    for name in sorted(TABLES):
        table = schema if name == "FileTable" else schema["$defs"][name]
        for key, entry in table["properties"].items():
            if entry.get("type") == "number" or entry.get("items", {}).get("type") == "number":
                yield name, key, entry


def test_every_number_has_a_unit():
    """In the description and as x-unit, but for the dimensionless."""
    bare = set()
    for name, key, entry in numbers(SCHEMA):
        unit = entry.get("x-unit") or entry.get("items", {}).get("x-unit")
        if unit is None:
            bare.add((name, key))
        else:
            assert f"in {unit}" in entry["description"]
    assert bare == {
        ("BeamJointTable", "loss_factor"),
        ("BeamJointTable", "shear_coefficient"),
        ("BeamTable", "shear_coefficient"),
        ("FrameTable", "loss_factor"),
        ("MatricesTable", "loss_factor"),
        ("MatricesTable", "modal_damping"),
        ("MeasuredTable", "tolerance"),
        ("ModalTable", "loss_factor"),
        ("FrameTable", "modal_damping"),
        ("GearTrainTable", "modal_damping"),
        ("BearingTable", "loss_factor"),
        ("MountTable", "loss_factor"),
        *(("BallTable", key) for key in ("inner_conformity", "outer_conformity", "poisson_ratio")),
        *((table, key) for table in ("PlateShape", "PlateTable") for key in ("axis_1", "axis_2", "shear_coefficient")),
        ("PlateTable", "loss_factor"),
        ("PlateTable", "modal_damping"),
        ("MaterialTable", "poisson_ratio"),
        ("ShaftTable", "shear_coefficient"),
        ("SidebandTable", "order"),
    }


def test_defaults_are_valid():
    for name in sorted(TABLES):
        table = SCHEMA if name == "FileTable" else SCHEMA["$defs"][name]
        for key, entry in table["properties"].items():
            if "default" in entry:
                resolver = Draft202012Validator({**entry, "$defs": SCHEMA["$defs"]})
                assert resolver.is_valid(entry["default"]), (name, key)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('name = "small"', 'nam = "small"'),
        ("mass = 12.0", 'mass = "12 kg"'),
        ("mass = 12.0", "mass = 0"),
        ("youngs_modulus = 2.07e11", "youngs_modulus = 207"),
        ('kind = "gear_train"', 'kind = "shell"'),
        ("[joints.front]", "[joints.1st]"),
        ("length = 0.2\n", ""),
        ("length = 0.2\n", "length = 0.2\nsections = [{ length = 0.2, outer = 0.03 }]\n"),
        ("damping = 440.0", "damping = 440.0\ndamping_time = 1e-6"),
        ('mesh = "train.mesh"', 'mesh = "train.mesh"\npoint = "casing"\ndof = "uy"'),
        ("elements = [4, 4]", "elements = 0"),
        ("stiffness = 1.0e7", "stiffness = [1.0e7]"),
        ("speed = 3000.0\n", ""),
        ("teeth = 23", "teeth = 0.5"),
        ("phase = -0.7", "phase = -40.0"),
        ("harmonic = 2, order", "order"),
        ("\nharmonics = ", "\ntones = "),
    ],
)
def test_schema_refuses(old, new):
    assert WITH_SOURCE.count(old) == 1
    assert not VALIDATOR.is_valid(tomllib.loads(WITH_SOURCE.replace(old, new)))


def test_file_table_is_the_root():
    assert SCHEMA["description"] == FileTable.__doc__
