"""Validation of FMUs with a source: it is silenced for the other checks, and its own checks see what is wrong."""

import zipfile

import numpy as np
import pytest
from source_machine import NAMES, SPEED, TEETH, Machine, tones, with_source

import gearpath as gp
from gearpath.fmu.simulation import running
from gearpath.fmu.validation import source
from gearpath.network.assemble import assemble


def network_of(model):
    return assemble(model.system).modal()


@pytest.fixture(scope="module", params=["2.0", "3.0"])
def path(request, model, tmp_path_factory):
    return gp.export_fmu(model, tmp_path_factory.mktemp("valid") / "it.fmu", fmi=request.param)


def figures(path, model):
    network = network_of(model)
    with running(path) as fmu:
        return [check.figure for check in source.checks(fmu, network, network.source, 1e-10, 1e-9)]


def test_a_good_fmu_passes(path, model):
    assert max(figures(path, model)) < 1e-11


def test_tones_that_are_off_and_a_shaft_at_rest_are_checked_too(tmp_path):
    model = with_source(speed=0.0, harmonics=[{"order": 1, "amplitude": 0.0}], sidebands=[])
    assert max(figures(gp.export_fmu(model, tmp_path / "off.fmu"), model)) < 1e-11


@pytest.mark.parametrize(
    ("changes", "seen"),
    [
        ({"source.harmonics.0.phase": 0.3 + 1e-6}, [True, False]),  # as the model has it, which is not the FMU's
        ({"source.teeth": TEETH + 1}, [True, True]),
        ({"source.sidebands.1.order": 0.98 + 1e-6}, [True, True]),
    ],
)
def test_another_source_does_not_pass(path, model, changes, seen):
    assert [figure > 1e-9 for figure in figures(path, model.replace(changes))] == seen


def test_expected_histories_are_those_of_the_closed_form(model):
    machine, network = Machine(model), network_of(model)
    found = source.expected(network, network.source, 1e-5)
    x, e = machine.at_steady_speed(tones(), SPEED, 1e-5, source.STEPS)
    for name, values in zip(machine.names, machine.outputs(x, e).T):
        np.testing.assert_allclose(found[name], values, rtol=0, atol=1e-11 * abs(values).max())


def test_only_a_native_fmu_has_a_source_to_silence(model):
    network = network_of(model)
    assert source.silenced(network, "native") == {f"{name}.amplitude": 0.0 for name in NAMES}
    assert source.silenced(network, "python") == {}
    assert source.silenced(network_of(model.replace({"source": None})), "native") == {}


def test_the_python_kind_leaves_it_out_and_says_so(model, tmp_path):
    """The same FMU as without the table."""
    with pytest.warns(UserWarning, match="no gear mesh source"):
        made = [gp.export_fmu(model, tmp_path / "1.fmu", kind="python")]
    made.append(gp.export_fmu(model.replace({"source": None}), tmp_path / "2.fmu", kind="python"))
    assert made[0].read_bytes() == made[1].read_bytes()
    with running(made[0]) as fmu:
        fmu.start()
        assert not [v.name for v in fmu.description.modelVariables if v.name.startswith(NAMES)]
    with zipfile.ZipFile(made[0]) as archive:
        assert "no gear mesh source" in archive.read("documentation/index.html").decode()
