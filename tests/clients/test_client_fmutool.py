"""FMU Manipulation Toolbox: `fmutool -check`, the schemas of the standard and semantic rules of its own."""

import re
import subprocess
import sys
import zipfile

import pytest
from client_packages import installed

installed("fmu_manipulation_toolbox")

CODE = "from fmu_manipulation_toolbox.cli.fmutool import fmutool; fmutool()"
PROBLEMS = 7  # its exit code where the check finds any


def fmutool(*arguments, folder):
    return subprocess.run(
        [sys.executable, "-c", CODE, *arguments], cwd=folder, capture_output=True, text=True, timeout=120, check=False
    )


def complaints(done):
    """Lines of the level WARNING and above; the others begin with INFO."""
    return [line for line in (done.stdout + done.stderr).splitlines() if line.strip() and "INFO" not in line[:20]]


def test_check(fmu, fmi, tmp_path):
    done = fmutool("-input", fmu, "-check", folder=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert not complaints(done)
    assert f"compliant with FMI-{fmi}" in done.stdout + done.stderr
    assert "No semantic error" in done.stdout + done.stderr


def test_summary(fmu, tmp_path):
    """It finds the states, and the sources that it counts as a platform."""
    done = fmutool("-input", fmu, "-summary", folder=tmp_path)
    assert done.returncode == 0
    assert not complaints(done)
    assert "continuous states : 144" in done.stdout + done.stderr
    assert "RT (sources available)" in done.stdout + done.stderr


@pytest.mark.parametrize(
    ("version", "old", "new"),
    [
        ("2.0", r'<Unknown index="\d+"', '<Unknown index="1"'),  # an input among the outputs
        ("2.0", 'causality="output"', 'causality="outward"'),
        ("3.0", r'<Output valueReference="\d+"', '<Output valueReference="0"'),
        ("3.0", 'causality="output"', 'causality="outward"'),
    ],
)
def test_the_check_can_fail(exported, version, old, new, tmp_path):
    changed = tmp_path / "changed.fmu"
    with zipfile.ZipFile(exported[version]) as source, zipfile.ZipFile(changed, "w") as target:
        for item in source.infolist():
            content = source.read(item)
            if item.filename == "modelDescription.xml":
                content, changes = re.subn(old.encode(), new.encode(), content, count=1)
                assert changes == 1
            target.writestr(item, content)
    done = fmutool("-input", changed, "-check", folder=tmp_path)
    assert done.returncode == PROBLEMS
    assert complaints(done)
