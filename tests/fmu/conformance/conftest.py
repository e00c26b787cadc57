"""Good FMUs of the test network as dictionaries of files."""

import re
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from conformance_rich import rich
from conformance_trees import Tree, pack, tree_of
from fmu_helpers import export, stale
from fmu_networks import gearbox

_HEADER = re.compile(r"sources/fmi[23].*(Functions|FunctionTypes|TypesPlatform|PlatformTypes)\.h")


@pytest.fixture(scope="session")
def trees(tmp_path_factory) -> dict[str, Tree]:
    """ "2" and "3": exported, as importers want them; "rich": by hand."""
    if stale():
        pytest.fail(stale(), pytrace=False)
    folder, found = tmp_path_factory.mktemp("conformance"), {"rich": rich()}
    documentation = {"documentation/index.html": b"<!doctype html><title>A gearbox</title>"}
    for version in "23":
        path = export(gearbox(), folder / f"{version}.fmu", fmi=f"{version}.0", extra_files=documentation)
        tree = tree_of(path)
        found[version] = {name: content for name, content in tree.items() if not _HEADER.fullmatch(name)}
    return found


@pytest.fixture(scope="session")
def good(trees, tmp_path_factory) -> dict[str, Path]:
    """The exported files as archives."""
    folder = tmp_path_factory.mktemp("good")
    return {base: pack(trees[base], folder / f"good{base}.fmu") for base in trees}
