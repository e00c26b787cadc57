"""Every fault in conformance_mutants is seen by its rule; the good files have no finding at all."""

import pytest
from conformance_mutants import ALL
from conformance_trees import pack

from gearpath.fmu.conformance import check_conformance


def test_there_are_enough_mutants():
    assert len(ALL) >= 60
    assert len({m.name for m in ALL}) == len(ALL)


@pytest.mark.parametrize("base", ["2", "3", "rich"])
def test_the_good_files_have_no_finding(base, trees, tmp_path):
    assert check_conformance(pack(trees[base], tmp_path / "good.fmu"), run=False) == ()


@pytest.mark.parametrize("mutant", ALL, ids=lambda m: m.name)
def test_mutant_is_caught(mutant, trees, tmp_path):
    tree = dict(trees[mutant.base])
    mutant.edit(tree)
    found = check_conformance(pack(tree, tmp_path / "mutant.fmu"), run=False)
    assert mutant.rule in {f.rule for f in found}, "\n".join(map(str, found)) or "no finding"
    assert not any(f.rule == "check-incomplete" for f in found), "\n".join(map(str, found))
    for finding in found:
        assert finding.message
        assert finding.clause.startswith(("FMI 2.0.4, ", "FMI 3.0.1, ", "good practice"))
