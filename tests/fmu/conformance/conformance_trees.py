"""An FMU as a dictionary of files, and small edits of it."""

import zipfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

from lxml import etree

Tree = dict[str, bytes]
MD = "modelDescription.xml"
BUILD = "sources/buildDescription.xml"
TERMINALS = "terminalsAndIcons/terminalsAndIcons.xml"


def tree_of(path: Path) -> Tree:
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def pack(tree: Tree, path: Path) -> Path:
    """Stored, not deflated: faster."""
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in tree.items():
            archive.writestr(name, content)
    return path


def edited(edit: Callable[..., None], *arguments, file: str = MD) -> Callable[[Tree], None]:
    """An edit of a tree made of an edit of the root element of one file."""

    def apply(tree: Tree) -> None:
        root = etree.fromstring(tree[file])
        edit(root, *arguments)
        tree[file] = etree.tostring(root, xml_declaration=True, encoding="UTF-8")

    return apply


def one(root, path: str):
    """The first element of an XPath; a mutant whose place is missing would prove nothing."""
    found = root.xpath(path)
    assert found, f"no {path}"
    return found[0]


def _set(root, path, **attributes):
    for name, value in attributes.items():
        element = one(root, path)
        if value is None:
            del element.attrib[name]
        else:
            element.set(name, value)


def attributes(path: str, file: str = MD, **values: str | None) -> Callable[[Tree], None]:
    """Set attributes, or remove those that are None."""
    return edited(partial(_set, path=path, **values), file=file)


def key_of(root, name: str) -> str:
    """What the model structure calls a variable: its index in FMI 2, its value reference in FMI 3."""
    variables = list(one(root, "//ModelVariables"))
    place = [v.get("name") for v in variables].index(name)
    return str(place + 1) if root.get("fmiVersion").startswith("2") else variables[place].get("valueReference")


def _aim(root, path, attribute, names):
    one(root, path).set(attribute, " ".join(key_of(root, name) for name in names))


def aim(path: str, attribute: str, *names: str) -> Callable[[Tree], None]:
    """Let an attribute point to variables by name."""
    return edited(_aim, path, attribute, names)


def _share(root, name, other):
    variables = {v.get("name"): v for v in one(root, "//ModelVariables")}
    variables[name].set("valueReference", variables[other].get("valueReference"))


def share(name: str, other: str) -> Callable[[Tree], None]:
    """Give a variable the value reference of another."""
    return edited(_share, name, other)


def _remove(root, path):
    element = one(root, path)
    element.getparent().remove(element)


def _twice(root, path):
    element = one(root, path)
    element.addnext(etree.fromstring(etree.tostring(element)))


def _exchange(root, first, second):
    a, b = one(root, first), one(root, second)
    place = b.getnext()
    a.addprevious(b)
    if place is None:
        a.getparent().append(a)
    else:
        place.addprevious(a)


def _add(root, path, text):
    one(root, path).append(etree.fromstring(text))


def remove(path: str, file: str = MD) -> Callable[[Tree], None]:
    return edited(_remove, path, file=file)


def twice(path: str, file: str = MD) -> Callable[[Tree], None]:
    return edited(_twice, path, file=file)


def exchange(first: str, second: str, file: str = MD) -> Callable[[Tree], None]:
    """The element of the second path goes before that of the first, which takes its place."""
    return edited(_exchange, first, second, file=file)


def add(path: str, text: str, file: str = MD) -> Callable[[Tree], None]:
    return edited(_add, path, text, file=file)


def without(*names: str) -> Callable[[Tree], None]:
    """Remove files, or all files of folders that end in a slash."""

    def apply(tree: Tree) -> None:
        gone = [n for n in tree if any(n == name or (name.endswith("/") and n.startswith(name)) for name in names)]
        assert gone, f"no {names}"
        for name in gone:
            del tree[name]

    return apply


def renamed(old: str, new: str) -> Callable[[Tree], None]:
    """Rename a file, or all below a folder."""

    def apply(tree: Tree) -> None:
        moved = {name: content for name, content in tree.items() if name.startswith(old)}
        assert moved, f"no {old}"
        for name, content in moved.items():
            del tree[name]
            tree[new + name.removeprefix(old)] = content

    return apply


def written(name: str, content: bytes = b"x") -> Callable[[Tree], None]:
    return lambda tree: tree.update({name: content})


def replaced(name: str, old: bytes, new: bytes) -> Callable[[Tree], None]:
    def apply(tree: Tree) -> None:
        assert old in tree[name], f"no {old!r} in {name}"
        tree[name] = tree[name].replace(old, new)

    return apply


def both(*edits: Callable[[Tree], None]) -> Callable[[Tree], None]:
    def apply(tree: Tree) -> None:
        for edit in edits:
            edit(tree)

    return apply
