"""What the tests say where a program is missing: never silence in CI."""

import subprocess
import sys

import platform_fetch as fetch
import platform_machines
import pytest

ABSENT = fetch.Tool("Nothing", "no-such-package", ("no-such-program", "/no/such/file"))
PRESENT = fetch.Tool("Python", "python3", (sys.executable,))


def test_advice_names_what_is_missing_and_the_command():
    text = fetch.advice((PRESENT, ABSENT))
    assert text == "no Nothing (Debian: no-such-package) here: run `python3 tests/platforms/platform_fetch.py` as root"
    assert fetch.advice((PRESENT,)) == ""


def test_a_missing_program_skips_here_and_fails_where_it_is_required(monkeypatch):
    monkeypatch.delenv(fetch.REQUIRED, raising=False)
    with pytest.raises(pytest.skip.Exception, match=r"fetch\.py"):
        platform_machines.need(PRESENT, ABSENT)
    monkeypatch.setenv(fetch.REQUIRED, "1")
    with pytest.raises(pytest.fail.Exception, match=r"fetch\.py"):
        platform_machines.need(PRESENT, ABSENT)
    platform_machines.need(PRESENT)


def test_without_root_it_says_what_is_missing(monkeypatch):
    monkeypatch.setattr(fetch, "TOOLS", (ABSENT,))
    monkeypatch.setattr(fetch.os, "geteuid", lambda: 1000)
    monkeypatch.setattr(fetch.shutil, "which", lambda name: "/usr/bin/apt-get" if name == "apt-get" else None)
    with pytest.raises(RuntimeError, match="no Nothing"):
        fetch.fetch()


def test_a_package_that_does_not_exist_is_an_error(monkeypatch):
    monkeypatch.setattr(fetch, "TOOLS", (ABSENT,))
    monkeypatch.setattr(fetch.os, "geteuid", lambda: 0)
    monkeypatch.setattr(fetch.shutil, "which", lambda name: "/usr/bin/apt-get" if name == "apt-get" else None)
    monkeypatch.setattr(fetch.platform, "machine", lambda: "x86_64")

    def no_such_package(command, **_):
        code = 100 if "install" in command else 0
        return subprocess.CompletedProcess(command, code, "", "E: Unable to locate package no-such-package\n")

    monkeypatch.setattr(fetch.subprocess, "run", no_such_package)
    with pytest.raises(RuntimeError, match=r"apt-get install .* ended with code 100: E: Unable to locate"):
        fetch.fetch()


def test_elsewhere_it_does_not_try(monkeypatch):
    monkeypatch.setattr(fetch, "TOOLS", (ABSENT,))
    monkeypatch.setattr(fetch.shutil, "which", lambda _: None)
    with pytest.raises(RuntimeError, match="Debian's packages"):
        fetch.fetch()
