"""Archives that no importer should unpack, and files that are no archives."""

import struct
import zipfile

import pytest
from conformance_trees import MD, pack

from gearpath.fmu.conformance import check_conformance


def rules(path, run=False):
    return {f.rule for f in check_conformance(path, run=run)}


@pytest.fixture
def packed(trees, tmp_path):
    """Path of the hand-made FMU, and a function that adds an entry to it."""
    path = pack(trees["rich"], tmp_path / "it.fmu")

    def add(info, content=b"x", method=zipfile.ZIP_STORED):
        with zipfile.ZipFile(path, "a") as archive:
            archive.writestr(info, content, method)
        return path

    return add


def entry(name, mode=0):
    info = zipfile.ZipInfo("placeholder")
    info.filename = info.orig_filename = name
    info.external_attr = mode << 16
    return info


@pytest.mark.parametrize("name", ["../evil.txt", "/etc/evil", "C:/evil", "resources/../../evil", "resources\\evil.txt"])
def test_paths_that_leave_the_archive(packed, name):
    assert "archive-path" in rules(packed(entry(name)))


def test_nothing_is_unpacked_from_an_archive_with_such_paths(trees, tmp_path):
    path = pack(trees["2"] | {"resources/../../../evil.txt": b"x"}, tmp_path / "it.fmu")
    found = rules(path, run=True)
    assert "archive-path" in found
    assert not list(tmp_path.parent.rglob("evil.txt"))


def test_link(packed):
    assert "archive-link" in rules(packed(entry("resources/link", 0o120777), b"/etc/passwd"))


def test_the_same_name_twice(packed):
    with pytest.warns(UserWarning, match="Duplicate name"):
        path = packed(entry("sources/rich.c"))
    assert "archive-duplicate" in rules(path)


def test_names_that_differ_in_case(packed):
    assert "archive-case" in rules(packed(entry("sources/RICH.c")))


def test_compression_that_is_not_deflate(packed):
    assert "archive-method" in rules(packed(entry("resources/a.txt"), b"x" * 99, zipfile.ZIP_BZIP2))


def test_encryption(packed):
    path = packed(entry("resources/a.txt"))
    data = bytearray(path.read_bytes())
    central = data.rindex(b"PK\1\2")
    struct.pack_into("<H", data, central + 8, 1)
    path.write_bytes(data)
    assert {"archive-method", "archive-damaged"} <= rules(path)


def test_letters_outside_ascii(packed):
    assert "archive-ascii" in rules(packed(entry("resources/größe.txt")))


def test_bomb(packed):
    path = packed(entry("resources/zeros"), b"\0" * (2**24 + 1), zipfile.ZIP_DEFLATED)
    assert "archive-bomb" in rules(path)


def test_damaged_entry(packed):
    path = packed(entry("resources/a.txt"), b"a long enough text")
    path.write_bytes(path.read_bytes().replace(b"a long enough text", b"a long enough teXt"))
    assert "archive-damaged" in rules(path)


def test_damaged_description(trees, tmp_path):
    path = pack(trees["rich"], tmp_path / "it.fmu")
    path.write_bytes(path.read_bytes().replace(b'modelName="Rich"', b'modelName="Poor"'))
    assert "archive-damaged" in rules(path)


def test_suffix(trees, tmp_path):
    assert rules(pack(trees["rich"], tmp_path / "it.zip")) == {"archive-suffix"}


@pytest.mark.parametrize("content", [b"", b"PK", b"no archive at all", b"PK\5\6" + b"\0" * 18])
def test_no_archive(content, tmp_path):
    path = tmp_path / "it.fmu"
    path.write_bytes(content)
    assert rules(path) <= {"archive-unreadable", "description-missing"}
    assert rules(path)


@pytest.mark.parametrize("kept", [0.2, 0.5, 0.9, 0.999])
def test_cut_archive(trees, tmp_path, kept):
    path = pack(trees["2"], tmp_path / "it.fmu")
    data = path.read_bytes()
    path.write_bytes(data[: int(kept * len(data))])
    assert rules(path) == {"archive-unreadable"}


def test_folder_and_nothing(tmp_path):
    assert rules(tmp_path) == {"archive-unreadable"}
    assert rules(tmp_path / "nowhere.fmu") == {"archive-unreadable"}


def test_a_bomb_of_entities_is_not_opened(trees, tmp_path):
    levels = "".join(f'<!ENTITY a{k} "{f"&a{k - 1};" * 10}">' for k in range(1, 12))
    text = f'<?xml version="1.0" encoding="UTF-8"?><!DOCTYPE x [<!ENTITY a0 "x">{levels}]><x>&a11;</x>'
    path = pack(trees["rich"] | {MD: text.encode()}, tmp_path / "it.fmu")
    assert "xml-entities" in rules(path)
