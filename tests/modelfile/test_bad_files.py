"""Every bad file is refused with one sentence: file, key, value, remedy. The edits are in bad_files.toml."""

import tomllib
from pathlib import Path

import pytest

from gearpath.errors import InputError, ModelError
from gearpath.modelfile import load

HERE = Path(__file__).parent
BASE = (HERE / "base.toml").read_text(encoding="utf-8")
STRUCTURES = (HERE / "base_structures.toml").read_text(encoding="utf-8")
CASES = tomllib.loads((HERE / "bad_files.toml").read_text(encoding="utf-8"))["case"]
SOURCE = f"{BASE}\n{(HERE / 'source_table.toml').read_text(encoding='utf-8')}"
SOURCE_CASES = tomllib.loads((HERE / "bad_sources.toml").read_text(encoding="utf-8"))["case"]
STRUCTURE_CASES = tomllib.loads((HERE / "bad_structures.toml").read_text(encoding="utf-8"))["case"]


@pytest.mark.parametrize("case", CASES, ids=[case["message"].split(": ")[0] for case in CASES])
def test_bad_file(case, tmp_path):
    check(BASE, case, tmp_path / "bad.toml")


@pytest.mark.parametrize("case", STRUCTURE_CASES, ids=[case["message"].split(": ")[0] for case in STRUCTURE_CASES])
def test_bad_file_with_structures(case, tmp_path):
    check(STRUCTURES, case, tmp_path / "bad.toml")


@pytest.mark.parametrize("case", SOURCE_CASES, ids=[case["message"].split(": ")[0] for case in SOURCE_CASES])
def test_bad_source(case, tmp_path):
    check(SOURCE, case, tmp_path / "bad.toml")


def test_base_of_structures_is_good(tmp_path):
    path = tmp_path / "good.toml"
    path.write_text(STRUCTURES, encoding="utf-8")
    assert set(load(path).system.components) == {"post", "lid"}


def check(base, case, path):
    assert base.count(case["old"]) == 1
    path.write_text(base.replace(case["old"], case["new"]), encoding="utf-8")
    with pytest.raises(ModelError) as caught:
        load(path)
    error = caught.value
    assert str(error) == f"{path}: {case['message']}"
    assert str(error) == f"{error.file}: {error.key}: {error.problem}; {error.remedy}"


def test_cases_are_distinct():
    assert len({(case["old"], case["new"]) for case in CASES}) == len(CASES) >= 45


def test_no_such_file(tmp_path):
    with pytest.raises(InputError) as caught:
        load(tmp_path / "none.toml")
    expected = f"{tmp_path / 'none.toml'}: there is no such file; give the path of a model file (TOML)"
    assert str(caught.value) == expected


def test_folder(tmp_path):
    with pytest.raises(InputError) as caught:
        load(tmp_path)
    # Windows refuses to open a folder as if it were locked.
    assert str(caught.value).startswith(f"{tmp_path}: ")
    assert "; " in str(caught.value)


def test_unreadable_path():
    with pytest.raises(InputError, match=r"cannot be read .*; check the path and its permissions"):
        load("\0.toml")


def test_not_utf8(tmp_path):
    path = tmp_path / "latin.toml"
    path.write_bytes(b"# first line\nname = 'Geh\xe4use'\n")
    with pytest.raises(ModelError) as caught:
        load(path)
    expected = f"{path}: line 2: byte 0xe4 is not UTF-8; save the file as UTF-8 text"
    assert str(caught.value) == expected


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "name: is missing"),
        ("a = " + "[" * 5000, "the file: is nested too deeply; write flat tables"),
        ("a = " + "[" * 240 + "]" * 240, "a: unknown key"),
        (f"name = {'1' * 5000}", "the file: is not TOML"),
        (
            BASE.replace("mass = 12.0", f"mass = {'1' * 4000}"),
            "components.casing.mass: an integer of more than 60 digits is not a finite number",
        ),
    ],
    ids=["empty", "endless", "nested", "long", "large"],
)
def test_odd_text(text, message, tmp_path):
    path = tmp_path / "odd.toml"
    path.write_text(text)
    with pytest.raises(ModelError) as caught:
        load(path)
    assert str(caught.value).startswith(f"{path}: {message}")
    assert "\n" not in str(caught.value)


def test_byte_order_mark_is_accepted(tmp_path):
    path = tmp_path / "notepad.toml"
    path.write_bytes(b"\xef\xbb\xbf" + BASE.encode())
    assert load(path).name == "small"
