"""No file makes the checks fail: every attribute replaced by nonsense, bytes flipped, elements dropped."""

import random

import pytest
from conformance_trees import BUILD, MD, TERMINALS, pack
from lxml import etree

from gearpath.fmu.conformance import check_conformance

NONSENSE = ("", " ", "-1", "0", "x", "99999999999999999999", "NaN", "1e400", "{}", "%s%n", "\u202e", "1 2 3", "true")


def checked(tree, path):
    """Findings; none of them may say that a check itself failed."""
    found = check_conformance(pack(tree, path), run=False)
    broken = [str(f) for f in found if f.rule == "check-incomplete"]
    assert not broken, broken
    return found


@pytest.mark.parametrize("file", [MD, BUILD, TERMINALS])
def test_nonsense_in_attributes(file, trees, tmp_path):
    root = etree.fromstring(trees["rich"][file])
    draw = random.Random(1)
    for element in root.iter("*"):
        for name in element.attrib:
            kept = element.get(name)
            element.set(name, draw.choice(NONSENSE))
            checked(
                trees["rich"] | {file: etree.tostring(root, xml_declaration=True, encoding="UTF-8")}, tmp_path / "a"
            )
            element.set(name, kept)


@pytest.mark.parametrize("base", ["2", "rich"])
def test_all_attributes_nonsense_at_once(base, trees, tmp_path):
    for seed in range(20):
        root, draw = etree.fromstring(trees[base][MD]), random.Random(seed)
        for element in root.iter("*"):
            for name in element.attrib:
                if name != "fmiVersion" and draw.random() < 0.3:
                    element.set(name, draw.choice(NONSENSE))
        tree = {MD: etree.tostring(root, xml_declaration=True, encoding="UTF-8"), "sources/a.c": b""}
        assert checked(tree, tmp_path / "a.fmu")


def test_elements_dropped_and_doubled(trees, tmp_path):
    for seed in range(60):
        draw = random.Random(seed)
        file = draw.choice([MD, BUILD, TERMINALS])
        root = etree.fromstring(trees["rich"][file])
        for element in draw.sample(list(root.iter("*"))[1:], 3):
            if element.getparent() is not None and draw.random() < 0.5:
                element.getparent().remove(element)
            elif element.getparent() is not None:
                element.addnext(etree.fromstring(etree.tostring(element)))
        tree = trees["rich"] | {file: etree.tostring(root, xml_declaration=True, encoding="UTF-8")}
        checked(tree, tmp_path / "a.fmu")


def test_flipped_bytes(trees, tmp_path):
    for seed in range(150):
        draw = random.Random(seed)
        file = draw.choice([MD, BUILD, TERMINALS])
        content = bytearray(trees["rich"][file])
        for _ in range(draw.randint(1, 4)):
            content[draw.randrange(len(content))] = draw.randrange(256)
        checked(trees["rich"] | {file: bytes(content)}, tmp_path / "a.fmu")


def test_flipped_bytes_in_libraries_and_archives(trees, tmp_path):
    names = [name for name in trees["2"] if name.startswith("binaries/")]
    for seed in range(60):
        draw = random.Random(seed)
        content = bytearray(trees["2"][draw.choice(names)])
        for _ in range(20):
            content[draw.randrange(min(len(content), 4000))] = draw.randrange(256)
        tree = {MD: trees["2"][MD], "binaries/linux64/gearbox.so": bytes(content)}
        checked(tree, tmp_path / "a.fmu")
        whole = bytearray(pack({MD: trees["rich"][MD]}, tmp_path / "b.fmu").read_bytes())
        for _ in range(3):
            whole[draw.randrange(len(whole))] = draw.randrange(256)
        (tmp_path / "c.fmu").write_bytes(whole)
        check_conformance(tmp_path / "c.fmu", run=False)
