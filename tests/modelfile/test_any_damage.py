"""Whatever is done to a file, it loads or is refused with one sentence."""

import tomllib
from datetime import date
from pathlib import Path

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gearpath.errors import InputError, ModelError
from gearpath.modelfile import Model, load

HERE = Path(__file__).parent
SOURCE = tomllib.loads((HERE / "source_table.toml").read_text(encoding="utf-8"))
BASE = load(HERE / "base.toml").to_dict() | SOURCE


def paths(data, start=()):
    """Paths of all entries of nested tables and lists."""
    entries = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in entries:
        yield (*start, key)
        yield from paths(value, (*start, key))


def copied(data):
    if isinstance(data, dict):
        return {key: copied(value) for key, value in data.items()}
    return [copied(value) for value in data] if isinstance(data, list) else data


PATHS = list(paths(BASE))
SCALARS = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.just(10**400),
    st.floats(),
    st.text(max_size=8),
    st.sampled_from(["train", "train.input@0.1", "casing", "ground", "train.mesh", "uy", "30 mm", "{problem}"]),
    st.just(date(2024, 1, 1)),
)
VALUES = st.recursive(
    SCALARS,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner, max_size=2),
    max_leaves=5,
)
DAMAGE = st.tuples(st.sampled_from(PATHS), st.sampled_from(["delete", "set", "rename", "add"]), VALUES)


def damage(data, path, how, value):
    """Delete, overwrite, rename or add an entry, where it is still there."""
    *parents, last = path
    place = data
    for part in parents:
        try:
            place = place[part]
        except (KeyError, IndexError, TypeError):
            return
    if not isinstance(place, dict if isinstance(last, str) else list):
        return
    if isinstance(place, list) and last >= len(place):
        return
    if how == "delete":
        place.pop(last, None) if isinstance(place, dict) else place.pop(last)
    elif how == "rename" and isinstance(place, dict) and last in place:
        place[str(value)] = place.pop(last)
    elif how == "add" and isinstance(place, dict):
        place[str(value)] = value
    else:
        place[last] = value


def outcome(make):
    """(model, None) or (None, refusal); anything else passes through and fails the test."""
    try:
        return make(), None
    except InputError as error:
        return None, error


def check_outcome(data):
    model, error = outcome(lambda: Model.from_dict(data, "file.toml"))
    if error is not None:
        assert isinstance(error, ModelError)
        assert str(error).startswith("file.toml: ")
        assert "\n" not in str(error)
        assert error.problem
        assert error.remedy
        return
    assert Model.from_dict(model.to_dict()) == model
    assert model.system.name == model.name


@settings(max_examples=400, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(DAMAGE, min_size=1, max_size=3))
def test_any_damage(changes):
    data = copied(BASE)
    for path, how, value in changes:
        damage(data, path, how, value)
    check_outcome(data)


def test_every_key_deleted():
    for path in PATHS:
        data = copied(BASE)
        damage(data, path, "delete", None)
        check_outcome(data)


def test_every_key_of_every_type():
    for path in PATHS:
        for value in (
            None,
            True,
            -1,
            0,
            1e308,
            5e-324,
            float("nan"),
            "text",
            [],
            [1.0],
            [[1.0]],
            {},
            {"a": 1},
        ):
            data = copied(BASE)
            damage(data, path, "set", value)
            check_outcome(data)


@settings(max_examples=200, deadline=None)
@given(st.binary(max_size=60) | st.text(max_size=60).map(str.encode))
def test_any_bytes(tmp_path_factory, content):
    path = tmp_path_factory.mktemp("any") / "file.toml"
    path.write_bytes(content)
    _, error = outcome(lambda: load(path))
    assert error is not None
    assert "\n" not in str(error)
