"""The command line and the validation report show what was found."""

import json

import pytest
from conformance_trees import MD, attributes, pack
from typer.testing import CliRunner

from gearpath import console
from gearpath.cli import app
from gearpath.fmu.conformance import Finding, Severity
from gearpath.fmu.validation.suite import conformance_check


def run(*arguments):
    return CliRunner().invoke(app, ["validate", *map(str, arguments)])


def test_any_fmu_without_a_model(trees, tmp_path):
    tree = dict(trees["rich"])
    attributes("//Unit[@name='m']/BaseUnit", m="2")(tree)
    attributes("//DefaultExperiment", stepSize="0")(tree)
    path = pack(tree, tmp_path / "it.fmu")
    result = run(path, "--json")
    assert result.exit_code == console.CHECK_FAILED
    found = {f["rule"]: f for f in json.loads(result.stdout)["findings"]}
    assert set(found) == {"experiment-step", "unit-meaning", "derivative-unit", "binary-not-run"}
    assert found["experiment-step"] | {"message": ""} == {
        "rule": "experiment-step",
        "severity": "error",
        "message": "",
        "clause": "FMI 3.0.1, 2.4.6",
    }
    assert found["experiment-step"]["message"].startswith(MD)
    assert found["unit-meaning"]["severity"] == "warning"
    said = capture(path)
    assert "error experiment-step: modelDescription.xml, DefaultExperiment: stepSize is 0" in said
    assert "(FMI 3.0.1, 2.4.6)" in said
    assert said.rstrip().endswith("1 error, 2 warnings, 1 note")


def capture(path):
    """What the command prints for people."""
    with console.out.capture() as captured:
        run(path)
    return captured.get()


def test_warnings_do_not_fail(trees, tmp_path):
    path = pack(trees["rich"], tmp_path / "it.fmu")
    assert run(path).exit_code == console.DONE


def test_settings_need_a_model(trees, tmp_path):
    path = pack(trees["rich"], tmp_path / "it.fmu")
    result = run(path, "--set", "components.casing.mass=1")
    assert "--set changes a model" in str(result.exception)


@pytest.mark.parametrize(("severities", "passed"), [("", True), ("warning note", True), ("warning error", False)])
def test_errors_fail_the_check_of_a_validation(severities, passed):
    findings = [Finding("a", Severity(s), "b", "c") for s in severities.split()]
    assert conformance_check(findings).passed is passed
