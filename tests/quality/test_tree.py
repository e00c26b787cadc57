"""What keeps the tree in order: style, types, floors."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def check(*command):
    done = subprocess.run([sys.executable, "-m", *command], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_ruff():
    check("ruff", "check", ".")


def test_floors():
    """Nobody imports upwards; floors 1 to 4 need numpy and scipy only."""
    code = "from importlinter.cli import lint_imports; raise SystemExit(lint_imports())"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_floors_1_to_4_start_without_the_heavy_libraries():
    code = (
        "import sys, gearpath.network.assemble, gearpath.network.power\n"
        "heavy = {'pydantic', 'xarray', 'pandas', 'control', 'fmpy', 'typer', 'rich'} & set(sys.modules)\n"
        "raise SystemExit(', '.join(sorted(heavy)) or 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_files_stay_small():
    """One concept a file: 400 lines is a smell."""
    files = [*(ROOT / "solver").rglob("*.py"), *(ROOT / "fmu_src").rglob("*.[ch]")]
    long = {
        str(f.relative_to(ROOT)): n
        for f in files
        if (n := len(f.read_text().splitlines())) > 400 and "runtime" not in f.parts
    }
    assert not long


@pytest.mark.slow
def test_mypy_strict():
    check("mypy")
