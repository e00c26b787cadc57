"""The documents: links lead somewhere, functions that they name exist, formulas stay within what GitHub renders."""

import ast
import re
import xml.etree.ElementTree as ET
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
DOCUMENTS = sorted((ROOT / "docs").glob("*.md"))
THEORY = ROOT / "docs" / "theory.md"
LINK = re.compile(r"!?\[([^\]]*)\]\(([^)\s]+)\)")
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
INLINE = re.compile(r"\$([^$]+)\$")


def links(path):
    """Text and target of every link of a document."""
    return LINK.findall(FENCE.sub("", path.read_text(encoding="utf-8")))


def anchors(path):
    """Anchors that GitHub gives the headings of a document."""
    headings = re.findall(r"^#+ (.+)$", path.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@cache
def names(path):
    """Functions, classes and constants of a module, methods as Class.method and by their own name."""
    found = set()
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            found.add(node.name)
        if isinstance(node, ast.ClassDef):
            methods = {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
            found |= methods | {f"{node.name}.{method}" for method in methods}
        if isinstance(node, ast.Assign):
            found |= {target.id for target in node.targets if isinstance(target, ast.Name)}
    return found


def named(path):
    """Links of a document whose text is a name in a Python file: (name, file)."""
    found = [(text.strip("`"), target) for text, target in links(path) if re.fullmatch(r"`[\w.]+`", text)]
    return [(name, path.parent / target) for name, target in found if target.endswith(".py")]


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda p: p.stem)
def test_links_lead_somewhere(path):
    for text, target in links(path):
        if target.startswith("http"):
            continue
        file, _, anchor = target.partition("#")
        there = path.parent / file if file else path
        assert there.exists(), f"{text}: {target}"
        assert not anchor or anchor in anchors(there), f"{text}: {target}"


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda p: p.stem)
def test_named_functions_exist(path):
    for name, file in named(path):
        assert name in names(file.resolve()), f"{name} is not in {file.name}"


@pytest.mark.parametrize("path", [*DOCUMENTS, ROOT / "docs" / "frames.svg"], ids=lambda p: p.stem)
def test_no_machine_paths(path):
    text = path.read_text(encoding="utf-8")
    assert not re.search(r"(?<![\w.])/(home|root|tmp|work|usr|mnt|Users)\b|\b[A-Z]:\\\w|file:", text)


def test_every_equation_appears():
    """1 to 22, as "Eq. 3", "Eq. 1 to 4", "(17a, 17b)" or a tag of a formula."""
    text = THEORY.read_text(encoding="utf-8")
    found = set()
    for first, last in re.findall(r"Eq\. (\d+)(?:[a-f])?(?:(?: to | and |–)(\d+))?", text):
        found |= set(range(int(first), int(last or first) + 1))
    listed = {int(n) for part in re.findall(r"\\(?:tag|text)\{([^}]*)\}", text) for n in re.findall(r"\d+", part)}
    rows = re.findall(r"^\| (?:before |after )?(\d+)", text, re.MULTILINE)
    assert found | listed == set(range(1, 23))
    assert {3, 5, 7, 8, 9, 10, 12, 13, 15, 16, 18, 19, 21} <= {int(row) for row in rows}


def test_theory_links_every_part_of_the_physics():
    """The modules that evaluate an equation are named, and every misprint has its test."""
    files = {file.resolve().relative_to(ROOT).as_posix() for _, file in named(THEORY)}
    for module in (
        *("components/beam", "components/dofs", "components/gear_mesh", "components/mobility", "components/modes"),
        *("components/gear_train", "components/rigid_body", "joints/beam_joint", "joints/joint"),
        *("network/synthesis", "network/power", "network/excitations", "network/reference", "network/time_twin"),
        *("reduction/held", "reduction/fixed", "reduction/free", "reduction/record", "reduction/errors"),
    ):
        assert f"solver/gearpath/{module}.py" in files
    for row in re.findall(r"^\| (?:(?:before |after )?\d|Fig\.).*$", THEORY.read_text(encoding="utf-8"), re.MULTILINE):
        assert "tests/" in row or "the same test" in row, row


def test_formulas_are_whole_and_survive_markdown():
    """Markdown removes a backslash before punctuation and takes "}_", ")_" and "*" for emphasis.

    None of them is in inline formulas; displayed ones are fenced, where nothing is touched.
    """
    text = THEORY.read_text(encoding="utf-8")
    displayed = [body for kind, body in FENCE.findall(text) if kind == "math"]
    prose = re.sub(r"`[^`]*`", "", FENCE.sub("", text))
    assert prose.count("$") % 2 == 0
    inline = INLINE.findall(prose)
    assert len(displayed) > 15
    assert len(inline) > 100
    for formula in inline:
        assert not re.search(r"\\[^A-Za-z ]|[}\])]_|\*|<|\n|^ | $", formula), formula
    for row in re.findall(r"^\|.*$", prose, re.MULTILINE):
        assert not any("|" in formula for formula in INLINE.findall(row)), row
    for formula in [*displayed, *inline]:
        plain = re.sub(r"\\[{}]", "", formula)
        assert plain.count("{") == plain.count("}"), formula
        begun, ended = (sorted(re.findall(rf"\\{word}\{{(\w+)\}}", formula)) for word in ("begin", "end"))
        assert begun == ended, formula


def test_the_drawing_is_plain():
    """Well-formed, titled, without scripts, handlers or anything from elsewhere; marks that it uses are defined."""
    tree = ET.parse(ROOT / "docs" / "frames.svg")
    elements = list(tree.iter())
    kinds = {element.tag.rsplit("}", 1)[1] for element in elements}
    assert kinds <= {"svg", "title", "style", "defs", "marker", "path", "rect", "g", "text", "use", "circle"}
    assert "title" in kinds
    defined = {element.get("id") for element in elements}
    text = (ROOT / "docs" / "frames.svg").read_text(encoding="utf-8")
    for element in elements:
        assert not any(name.startswith("on") for name in element.attrib)
        if href := element.get("href"):
            assert href.startswith("#")
            assert href[1:] in defined
    assert set(re.findall(r"url\(#(\w+)\)", text)) <= defined
    assert set(re.findall(r"url\(([^)]*)\)", text)) == {f"#{name}" for name in ("dark", "red", "blue")}
    classes = {name for element in elements for name in (element.get("class") or "").split()}
    assert classes <= set(re.findall(r"\.(\w+) \{", text))


def test_the_readme_leads_to_the_theory():
    assert "(docs/theory.md)" in (ROOT / "README.md").read_text(encoding="utf-8")
