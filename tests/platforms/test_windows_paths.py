"""Odd places of an FMU on Windows: drive letters, spaces, UTF-8, percent signs, long paths, in all their spellings."""

import shutil
from urllib.parse import quote

import pytest
from platform_script import Script, parsed

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("platforms")]
FOLDERS = ["a b", "ü", "日本 – ß", "100%", "50%25", "%zz", "100%41", "a+b", "#1", "a;b=c&d", "[x]{y}", "x" * 180]


@pytest.fixture(params=FOLDERS)
def unpacked_at(request, fmu, tmp_path, windows):
    """The FMU's folder at an odd place: its resources and the Windows library."""
    folder = tmp_path / request.param
    for file in ("resources/model.bin", fmu.library(windows).relative_to(fmu.folder)):
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(fmu.folder / file, folder / file)
    return folder


def spellings(resources: str, fmi: str) -> list[str]:
    """How importers may write the place of the resources; `resources` is drive Z's path with slashes."""
    backslashes = resources.replace("/", "\\")
    if fmi == "3.0":
        return [f"{resources}/", resources, backslashes, f"{backslashes}\\", f"\\\\?\\{backslashes}\\"]
    encoded = quote(resources[2:])
    everything = "".join(f"%{byte:02X}" if chr(byte) != "/" else "/" for byte in resources[2:].encode())
    return [
        f"file:///Z:{encoded}",
        f"file:///z:{encoded}/",
        f"file:/Z:{encoded}",
        f"file://localhost/Z:{encoded}",
        f"file:///Z%3A{encoded}",
        f"FILE:///Z|{encoded}",
        f"file:///Z:{everything}",
        f"file:///{resources}",  # not encoded
        resources,  # plain paths
        backslashes,
    ]


def test_odd_folders(unpacked_at, fmu, windows, run):
    script = Script(fmu, windows, unpacked_at / fmu.library(windows).relative_to(fmu.folder))
    locations = spellings(windows.path(unpacked_at / "resources"), fmu.fmi)
    for location in locations:
        script.instantiate("cs", location)
        script.call("free")
    calls = parsed(run(script))
    assert [call.status for call in calls if call.name == "instantiate"] == [0] * len(locations), [
        " ".join(call.words) for call in calls if call.name == "log"
    ]


def test_a_missing_folder_gives_a_sentence(fmu, windows, run):
    """The place is in the message, its percent signs whole, and nothing crashes."""
    script = Script(fmu, windows)
    place = "Q:/100%25 nowhere/%s%n" if fmu.fmi == "3.0" else "file:///Q:/100%25 nowhere/%s%n"
    script.instantiate("cs", place)
    script.instantiate("me", place)
    calls = parsed(run(script))
    messages = [" ".join(call.words) for call in calls if call.name == "log"]
    assert len(messages) == 2
    for message in messages:
        assert place in message
        assert "model.bin cannot be opened" in message
    assert [call.status for call in calls if call.name == "instantiate"] == [3, 3]
