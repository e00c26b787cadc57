"""A wheel in an empty environment outside the checkout does everything that the checkout does."""

import json
import os
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("wheel")]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "-w", folder, ROOT]
    subprocess.run(command, check=True)
    return next(folder.glob("gearpath-*.whl"))


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """The folder of an environment that holds the wheel and what it depends on, and nothing else."""
    folder = tmp_path_factory.mktemp("empty")
    venv.create(folder / "venv", with_pip=True)
    python = folder / "venv" / "bin" / "python"
    subprocess.run([python, "-m", "pip", "install", "--quiet", f"{wheel}[all]"], check=True)
    (folder / "gearbox.toml").write_bytes((ROOT / "models" / "gearbox.toml").read_bytes())
    return folder


def run(folder, *arguments):
    clean = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "PYTEST", "COV"))}
    command = [folder / "venv" / "bin" / "gearpath", *arguments]
    return subprocess.run(command, cwd=folder, env=clean, capture_output=True, text=True, check=False)


def test_wheel_holds_runtimes_sources_and_types(wheel):
    names = set(zipfile.ZipFile(wheel).namelist())
    inside = "gearpath/fmu/runtime/"
    folders = ("linux64", "win64", "darwin64", "aarch64-linux", "aarch64-darwin", "x86_64-darwin")
    assert all(any(n.startswith(f"{inside}binaries/{folder}/") for n in names) for folder in folders)
    assert {f"{inside}sources/gp_model.c", f"{inside}pythonfmu/slave.py", "gearpath/py.typed"} <= names
    assert "gearpath/models/gearbox.toml" in names


def test_the_package_is_the_installed_one(installed):
    code = "import gearpath; print(gearpath.__file__)"
    done = subprocess.run(
        [installed / "venv" / "bin" / "python", "-I", "-c", code],
        cwd=installed,
        capture_output=True,
        text=True,
        check=True,
    )
    assert str(installed) in done.stdout


def test_sweep_with_check(installed):
    done = run(installed, "sweep", "gearbox.toml", "--set", "frequency.points=40", "--check", "--json")
    assert done.returncode == 0, done.stderr
    assert all(check["passed"] for check in json.loads(done.stdout)["checks"])


def test_whole_main_job(installed):
    done = run(installed, "build", "gearbox.toml")
    assert done.returncode == 0, done.stdout + done.stderr
    assert {p.name for p in (installed / "build" / "gearbox").iterdir()} == {
        "gearbox.fmu",
        "gearbox-fmi3.fmu",
        "gearbox-python.fmu",
        "report.html",
    }


def test_paper(installed):
    done = run(installed, "paper", "-o", "paper.html", "--json")
    assert done.returncode == 0, done.stderr
    assert (installed / "paper.html").stat().st_size > 1e6


def test_schema(installed):
    assert json.loads(run(installed, "schema").stdout)
