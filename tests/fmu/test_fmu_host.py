"""The runtime in a C host, compiled with the address and undefined-behaviour sanitizers: no finding."""

import shutil
import subprocess

import pytest
from fmu_helpers import HEADERS, ROOT


@pytest.mark.slow
@pytest.mark.skipif(not shutil.which("gcc"), reason="needs gcc")
def test_sanitizers_find_nothing(unpacked, tmp_path):
    sources = [str(p) for p in sorted((ROOT / "fmu_src").glob("*.c"))]
    host = str(ROOT / "tests" / "fmu" / "host.c")
    flags = ["-std=gnu99", "-g", "-O1", "-Wall", "-Wextra", "-Werror"]
    flags += ["-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-isystem", str(HEADERS)]
    subprocess.run(
        ["gcc", *flags, host, *sources, "-o", str(tmp_path / "host"), "-lm"],
        check=True,
    )
    names = [v.name for v in unpacked.description.modelVariables]
    assert names[5] == "bearing_1.stiffness[1,2]"
    arguments = [
        unpacked.location,
        unpacked.description.guid,
        str(len(names)),
        "1000",
        str(names.index("bearing_1.force_uy")),
    ]
    done = subprocess.run([tmp_path / "host", *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "cycle" in done.stdout
    assert done.stderr == ""
