"""Faults of a binary, put between it and the checks."""

import pytest

from gearpath.fmu.conformance import probe_calls, probe_slopes, probe_state
from gearpath.fmu.conformance.archive import Archive
from gearpath.fmu.conformance.documents import DESCRIPTION, parse
from gearpath.fmu.conformance.instance import CallError, Instance
from gearpath.fmu.conformance.reading import read
from gearpath.fmu.conformance.running import library_of, unpack


@pytest.fixture(scope="module")
def look(good, tmp_path_factory):
    """Run one check of a good FMU in this process; rules that were found."""
    archives = {base: Archive.open(good[base]) for base in "23"}
    folders = {base: tmp_path_factory.mktemp(f"unpacked{base}") for base in "23"}
    fmus = {base: read(archives[base], int(base), parse(archives[base], DESCRIPTION)[0], {}) for base in "23"}
    for base in "23":
        unpack(fmus[base], folders[base])

    def run(module, base, interface):
        found = module.check(fmus[base], folders[base], library_of(fmus[base], interface, folders[base]), interface)
        return {finding.rule for finding in found}

    yield run
    for archive in archives.values():
        archive.file.close()


@pytest.fixture
def fault(monkeypatch):
    """Replace a method of every instance by a function of what the method gives and its arguments."""

    def put(name, changed):
        original = getattr(Instance, name)
        monkeypatch.setattr(Instance, name, lambda self, *a, **k: changed(original(self, *a, **k), *a))

    return put


KINDS = [(base, interface) for base in "23" for interface in ("ModelExchange", "CoSimulation")]


@pytest.mark.parametrize(("base", "interface"), KINDS)
@pytest.mark.parametrize("module", [probe_calls, probe_state, probe_slopes])
def test_without_a_fault_nothing_is_found(look, module, base, interface):
    assert look(module, base, interface) == set()


@pytest.mark.parametrize(("base", "interface"), KINDS)
@pytest.mark.parametrize("error", [1.001, -1.0, 0.0])
def test_wrong_directional_derivative(look, fault, base, interface, error):
    fault("directional", lambda found, *_: error * found)
    found = look(probe_slopes, base, interface)
    assert "directional-derivative" in found
    assert found <= {"directional-derivative", "adjoint-derivative"}  # which is no longer the transposed one


def test_one_wrong_entry_of_the_directional_derivative(look, fault):
    def changed(found, _, known, *__):
        if known.name == "gear_train.mode_7.x":
            found[12] += 0.01 * abs(found).max()
        return found

    fault("directional", changed)
    assert look(probe_slopes, "2", "ModelExchange") == {"directional-derivative"}


@pytest.mark.parametrize("interface", ["ModelExchange", "CoSimulation"])
def test_wrong_adjoint_derivative(look, fault, interface):
    fault("adjoint", lambda found, *_: 1.01 * found)
    assert look(probe_slopes, "3", interface) == {"adjoint-derivative"}


@pytest.mark.parametrize("base", ["2", "3"])
def test_a_state_that_is_not_restored(look, monkeypatch, base):
    monkeypatch.setattr(Instance, "restore", lambda *_: None)
    assert look(probe_state, base, "CoSimulation") == {"state-restore"}


@pytest.mark.parametrize("base", ["2", "3"])
def test_a_state_that_does_not_survive_as_bytes(look, monkeypatch, base):
    kept = []
    save = Instance.save

    def saved(self):
        kept.append(save(self))
        return kept[-1]

    def other(self, _):
        self.step(1e-4)
        return save(self)

    monkeypatch.setattr(Instance, "save", saved)
    monkeypatch.setattr(Instance, "deserialized", other)
    assert look(probe_state, base, "CoSimulation") == {"state-serialize"}


@pytest.mark.parametrize("base", ["2", "3"])
def test_nominal_values(look, fault, base):
    fault("nominals", lambda found, *_: 0.0 * found)
    assert look(probe_calls, base, "ModelExchange") == {"binary-nominals"}


@pytest.mark.parametrize("base", ["2", "3"])
def test_derivatives_in_another_order(look, fault, base):
    fault("derivatives", lambda found, *_: found[::-1])
    assert look(probe_calls, base, "ModelExchange") == {"binary-states"}


def test_version_of_the_binary(look, monkeypatch):
    monkeypatch.setattr(Instance, "getVersion", lambda _: "2.0", raising=False)
    assert look(probe_calls, "3", "CoSimulation") == {"binary-version"}
    monkeypatch.setattr(Instance, "getVersion", lambda _: "1.0", raising=False)
    assert look(probe_calls, "2", "CoSimulation") == {"binary-version"}


@pytest.mark.parametrize("base", ["2", "3"])
def test_any_token_is_accepted(look, monkeypatch, base):
    create = Instance.create

    def lenient(self):
        self.calls.guid = self.fmu.token
        create(self)

    monkeypatch.setattr(Instance, "create", lenient)
    assert look(probe_calls, base, "CoSimulation") == {"binary-token-any"}


def test_a_call_that_fails_is_told_with_its_reason(look, monkeypatch):
    def fails(self, size):
        self.doStep(-1.0, size)

    monkeypatch.setattr(Instance, "step", fails)
    with pytest.raises(CallError, match=r"doStep failed.*fmi2DoStep"):
        look(probe_calls, "2", "CoSimulation")
