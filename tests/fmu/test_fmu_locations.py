"""Resource locations: file URIs with odd characters, and the paths they mean on Windows."""

import subprocess
import sys

import pytest
from fmu_driver import Fmu
from fmu_helpers import ROOT


@pytest.mark.parametrize(
    "folder",
    ["a b", "ü", "100%", "a+b", "#1", "50%25", "what?", "a;b=c&d", "日本", "%zz", "x" * 200, "100%41"],
)
def test_resource_locations(unpacked, tmp_path, folder):
    target = tmp_path / folder / "resources"
    target.mkdir(parents=True)
    (target / "model.bin").write_bytes((unpacked.folder / "resources" / "model.bin").read_bytes())
    encoded = target.as_uri()
    forms = [
        encoded,
        encoded + "/",
        encoded.replace("file:///", "file:/"),
        encoded.replace("file:///", "FILE:///"),
        encoded.replace("file:///", "file://localhost/"),
        f"file://{target}",  # not encoded
        str(target),  # a plain path
    ]
    for location in forms:
        fmu = Fmu(unpacked, location=location)
        assert fmu.c.value, (location, fmu.messages)
        fmu.free()


def test_message_about_an_odd_path_is_a_safe_format(unpacked):
    """The logger reads messages as printf formats: a path must not bring conversions into them."""
    fmu = Fmu(unpacked, location="file:///nowhere/%25s%25n/100%25#1")
    message = fmu.messages[-1]
    assert message.replace("%%", "").count("%") == 0
    assert message.replace("##", "").count("#") == 0
    long = Fmu(unpacked, location="file:///" + "y%25" * 5000)
    assert len(long.messages[-1]) < 1000
    assert long.messages[-1].replace("%%", "").count("%") == 0


PROBE = """
#include <stdio.h>
#include "gp_path.h"
int main(int argc, char **v) {
    GpText t;
    char *path;
    gp_text_clear(&t);
    path = argc == 2 ? gp_location_path(v[1], 1, 1, &t) : NULL;
    fputs(path ? path : t.text, stdout);
    return path ? 0 : 1;
}
"""


@pytest.fixture(scope="module")
def windows_path(tmp_path_factory):
    """The decoding for Windows, which is plain C, run here."""
    pytest.importorskip("ziglang")
    compiler = [sys.executable, "-m", "ziglang", "cc"]
    folder, source = tmp_path_factory.mktemp("probe"), ROOT / "fmu_src"
    (folder / "probe.c").write_text(PROBE)
    files = [folder / "probe.c", source / "gp_path.c", source / "gp_text.c"]
    subprocess.run([*compiler, "-I", source, *files, "-o", folder / "probe"], check=True)

    def decode(location):
        return subprocess.run([folder / "probe", location], capture_output=True, text=True, check=False).stdout

    return decode


@pytest.mark.parametrize(
    ("location", "path"),
    [
        ("file:///C:/a%20b/resources", "C:/a b/resources"),
        ("file:/C:/x", "C:/x"),
        ("file://C:/x", "C:/x"),
        ("file:///c|/x", "c:/x"),
        ("file://localhost/D:/x+y#1", "D:/x+y#1"),
        ("file:///C:/%C3%BC", "C:/ü"),
        ("file://server/share/x", "//server/share/x"),
        ("file:////server/share/x", "//server/share/x"),
        ("C:\\x y\\100%41", "C:\\x y\\100%41"),
        ("\\\\server\\share", "\\\\server\\share"),
        ("file:///C:/100%", "C:/100%"),
    ],
)
def test_windows_locations(windows_path, location, path):
    assert windows_path(location) == path
