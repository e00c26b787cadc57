"""The table of rules: complete, proven by mutants, and the page that is made of it."""

import subprocess
import sys
from pathlib import Path

import pytest
from conformance_mutants import ALL

from gearpath.fmu.conformance.rules import all_rules, page, rules_of
from gearpath.fmu.conformance.unit_names import meaning

HERE = Path(__file__).parent
PACKAGE = HERE.parents[2] / "solver" / "gearpath" / "fmu" / "conformance"
PAGE = HERE.parents[2] / "docs" / "conformance.md"


def test_the_page_is_up_to_date():
    command = "python -m gearpath.fmu.conformance.rules > docs/conformance.md"
    assert PAGE.read_text("utf-8") == page(), f"run: {command}"


def test_every_module_with_rules_is_on_the_page():
    defining = {p.stem for p in PACKAGE.glob("*.py") if rules_of(p.stem)}
    assert len(defining) > 15
    assert {rule.id for name in defining for rule in rules_of(name)} == set(all_rules())


def test_every_rule_is_proven_by_a_mutant_or_a_test():
    """Every id occurs among the mutants or, for archives and running binaries, in a test of its own."""
    tests = "".join(p.read_text("utf-8") for p in HERE.glob("test_conformance_*.py"))
    proven = {m.rule for m in ALL}
    unproven = [id for id in all_rules() if id not in proven and f'"{id}"' not in tests]
    assert unproven == []


def test_the_checks_share_no_code_with_the_exporter():
    """They read the file: of the package they import errors only."""
    code = "import sys, gearpath.fmu.conformance.probe; print(*(m for m in sys.modules if m.startswith('gearpath.')))"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    allowed = {"gearpath._version", "gearpath.errors", "gearpath.fmu", "gearpath.fmu.conformance"}
    assert {m for m in loaded if not m.startswith("gearpath.fmu.conformance.")} == allowed


@pytest.mark.parametrize(
    ("name", "factor", "exponents"),
    [
        ("N.m.s/rad", 1.0, {"kg": 1, "m": 2, "s": -1, "rad": -1}),
        ("(m/s2)/m", 1.0, {"s": -2}),
        ("(N.m)/m", 1.0, {"kg": 1, "m": 1, "s": -2}),
        ("kN/mm", 1e6, {"kg": 1, "s": -2}),
        ("1/s", 1.0, {"s": -1}),
        ("kg*m^2", 1.0, {"kg": 1, "m": 2}),
        ("m-1", 1.0, {"m": -1}),
        ("mm", 1e-3, {"m": 1}),
        ("1", 1.0, {}),
        ("%", 0.01, {}),
    ],
)
def test_unit_names_are_understood(name, factor, exponents):
    assert meaning(name) == (pytest.approx(factor), exponents)


@pytest.mark.parametrize("name", ["furlong", "degC", "m/(s", "dB", "€"])
def test_other_unit_names_are_left_alone(name):
    assert meaning(name) is None
