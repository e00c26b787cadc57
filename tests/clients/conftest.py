"""The default gearbox as FMUs of both versions, for clients that leave nothing behind and complain of nothing."""

import logging
import re
import tempfile
from pathlib import Path

import pytest
from client_packages import client

import gearpath as gp

client("fmpy")
client("control")

COMPLAINT = re.compile(r"\b(error|warning|fatal|critical|traceback)\b", re.IGNORECASE)


@pytest.fixture(scope="session")
def gearbox():
    return gp.load(Path(__file__).resolve().parents[2] / "models" / "gearbox.toml")


@pytest.fixture(scope="session")
def exported(gearbox, tmp_path_factory):
    """The FMU files by version."""
    folder = tmp_path_factory.mktemp("clients")
    return {fmi: gp.export_fmu(gearbox, folder / f"fmi{fmi[0]}" / "gearbox.fmu", fmi=fmi) for fmi in ("2.0", "3.0")}


@pytest.fixture(params=["2.0", "3.0"])
def fmi(request):
    return request.param


@pytest.fixture
def fmu(exported, fmi):
    return exported[fmi]


@pytest.fixture(autouse=True)
def own_place(tmp_path, monkeypatch):
    """Clients write into a folder of the test's, wherever they like to write."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv("TMPDIR", str(tmp_path))


@pytest.fixture(autouse=True)
def no_complaints(capfd, caplog):
    """No client, and no FMU in one, prints or logs a warning or an error."""
    yield
    printed = [line for text in capfd.readouterr() for line in text.splitlines() if COMPLAINT.search(line)]
    logged = [record.getMessage() for record in caplog.records if record.levelno >= logging.WARNING]
    assert not printed + logged
