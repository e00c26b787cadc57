"""What the README and the examples show is run; .ci/run finds the README's commands."""

import os
import re
import runpy
import subprocess
from pathlib import Path

import matplotlib as mpl
import pytest

mpl.use("Agg")
ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text()


# folders of several files, run as a whole by their tests
WITH_TESTS_OF_THEIR_OWN = {"active_mounts", "flexible_casing", "run_up"}
EXAMPLES = [path for path in (ROOT / "examples").rglob("*.py") if path.parent.name not in WITH_TESTS_OF_THEIR_OWN]


@pytest.mark.parametrize("path", sorted(EXAMPLES), ids=lambda p: p.stem)
def test_example_runs(path, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(path), run_name="__main__")
    assert capsys.readouterr().out


def test_ten_lines_of_python_run(tmp_path, monkeypatch):
    (tmp_path / "models").symlink_to(ROOT / "models")
    monkeypatch.chdir(tmp_path)
    scope = {}
    exec(re.search(r"```python\n(.*?)```", README, re.DOTALL)[1], scope)
    assert (tmp_path / "build" / "gearbox.fmu").is_file()
    assert abs(scope["result"]["bearing_1.force_uy"]).max() > 1.0
    assert scope["change"].sizes == {"frequency": 2000}


@pytest.mark.parametrize(("name", "part"), [("main-job", "build_fmu.py models/gearbox.toml"), ("tests", "pytest")])
def test_ci_reads_the_readme_commands(name, part):
    script = (ROOT / ".ci" / "run").read_text()
    command_of = re.search(r"command_of\(\).*?\n\}", script, re.DOTALL)[0]
    done = subprocess.run(
        ["bash", "-c", f"{command_of}\ncommand_of {name}"], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert part in done.stdout
    assert len(done.stdout.strip().splitlines()) == 1


def test_links_in_the_readme_lead_somewhere():
    for target in re.findall(r"\]\(([^)#]+)\)", README):
        assert target.startswith("http") or os.path.exists(ROOT / target), target
