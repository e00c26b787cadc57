"""What the validation must catch, and what it must not: deviations, NaN, zeros, rounding, altered FMUs."""

import zipfile
from pathlib import Path

import numpy as np
import pytest

import gearpath as gp
from gearpath.fmu.simulation import running
from gearpath.fmu.validation import exchange, measure, spectrum, suite, tones
from gearpath.network.records import Output
from gearpath.network.time_twin import time_twin

MODEL = Path(__file__).resolve().parents[2] / "models" / "gearbox.toml"
OUTPUTS = (
    Output("a.force_uy", "N", "force", None, "a", 0),
    Output("a.force_rx", "N.m", "force", None, "a", 1),
    Output("c.velocity_uy", "m/s", "velocity", np.ones(1)),
)
DRIVE = measure.Drive(1.0, 1e4)


def values(force=100.0, moment=1.0, velocity=1e-3):
    wave = np.sin(np.arange(50.0))
    return {"a.force_uy": force * wave, "a.force_rx": moment * wave, "c.velocity_uy": velocity * wave}


@pytest.fixture(scope="module")
def model():
    return gp.load(MODEL)


@pytest.fixture(scope="module")
def fmu_path(model, tmp_path_factory):
    return gp.export_fmu(model, tmp_path_factory.mktemp("validation") / "it.fmu")


@pytest.mark.parametrize(
    ("deviation", "size", "expected"), [(0.0, 0.0, 0.0), (1e-30, 0.0, np.inf), (1.0, 4.0, 0.25), (np.nan, 1.0, np.nan)]
)
def test_relative(deviation, size, expected):
    np.testing.assert_equal(measure.relative(np.array([deviation]), np.array([size])), expected)


def test_a_deviation_counts_relative_to_the_output():
    found = values()
    found["c.velocity_uy"] = found["c.velocity_uy"] * (1 + 1e-6)
    assert measure.largest_deviation(OUTPUTS, found, values(), DRIVE) == pytest.approx(1e-6, rel=1e-3)


def test_nan_never_passes():
    found = values()
    found["a.force_rx"][3] = np.nan
    assert np.isnan(measure.largest_deviation(OUTPUTS, found, values(), DRIVE))
    assert not suite.Check("it", float("nan"), 1.0, "").passed


def test_rounding_of_an_output_that_vanishes_by_symmetry_passes_and_more_does_not():
    expected, found = values(moment=1e-15), values(moment=-3e-15)
    assert measure.largest_deviation(OUTPUTS, found, expected, DRIVE) < 1e-10
    assert measure.largest_deviation(OUTPUTS, values(moment=1e-6), expected, DRIVE) > 1e-5


def test_tones_are_distinct_in_the_band_and_off_the_resonances(model):
    poles = np.linalg.eigvals(time_twin(gp.api.modal_network(model)).A)
    for band in ((20.0, 5000.0), (5.0, 60.0), (100.0, 150.0), (1000.0, 40000.0)):
        found = tones.tones(*band, poles)
        assert len(set(found)) == 10
        assert np.all(np.diff(found) > 0)
        assert found[0] >= 0.8 * band[0]
        assert found[-1] <= 1.2 * band[1]
    distance = abs(tones.tones(20.0, 5000.0, poles)[:, None] - abs(poles.imag)[None, :] / 2 / np.pi).min()
    assert distance > 5.0


def test_smooth_ramp_is_a_ramp():
    t = np.linspace(-0.1, 1.1, 1000)
    ramp = tones.smooth_ramp(t, 1.0)
    assert ramp[t <= 0].max() == 0.0
    assert ramp[t >= 1].min() == 1.0
    assert np.all(np.diff(ramp) >= 0)


def test_spectrum_check_sees_another_machine(model, fmu_path):
    network = gp.api.modal_network(model)
    heavier = gp.api.modal_network(model.replace({"components.casing.mass": 12.001}))
    with running(fmu_path) as fmu:
        fmu.start()
        f = np.array([50.0, 500.0])
        assert spectrum.deviation(fmu, network, f) < 1e-9
        assert spectrum.deviation(fmu, heavier, f) > 1e-6


def test_start_values_in_the_description_are_compared(model, fmu_path, tmp_path):
    altered = tmp_path / "altered.fmu"
    with zipfile.ZipFile(fmu_path) as old, zipfile.ZipFile(altered, "w") as new:
        for item in old.infolist():
            content = old.read(item)
            if item.filename == "modelDescription.xml":
                assert content.count(b'start="120000000') >= 1
                content = content.replace(b'start="120000000', b'start="920000000', 1)
            new.writestr(item, content)
    network = gp.api.modal_network(model)
    for path, passed in ((fmu_path, True), (altered, False)):
        with running(path) as fmu:
            assert exchange.start_check(fmu.description, network).passed is passed


def test_every_tunable_parameter_is_exchanged(model, fmu_path):
    network = gp.api.modal_network(model)
    before, after = exchange.parameters(network), exchange.parameters(exchange.exchanged(network))
    assert all(before[name] != after[name] for name in before)
    with running(fmu_path) as fmu:
        tunable = {v.name for v in fmu.description.modelVariables if v.causality == "parameter"}
    assert tunable == set(before)


@pytest.mark.slow
@pytest.mark.parametrize(
    "changes",
    [
        {f"joints.bearing_{k}.stiffness": [[1.2e8, 0.0], [0.0, 6.0e4]] for k in (1, 2, 3, 4)},
        {f"joints.bearing_{k}.stiffness": [[1.2e8, 0.0], [0.0, 0.0]] for k in (1, 2, 3, 4)},
        {"joints.bearing_1.between": ["gear_train.input@0.0", "ground"]},
        {"frequency.start": 5.0, "frequency.stop": 60.0},
        {"components.gear_train.modal_damping": 0.0, **{f"joints.mount_{k}.damping": 4.4 for k in (1, 2, 3, 4)}},
    ],
    ids=["diagonal", "radial", "to-ground", "low-band", "light"],
)
def test_right_fmus_pass(model, changes, tmp_path):
    changed = model.replace(changes)
    report = gp.validate_fmu(gp.export_fmu(changed, tmp_path / "it.fmu"), changed)
    assert report.passed, [(c.name, c.figure, c.limit) for c in report.checks if not c.passed]


def spoilt(path, to, old, new):
    """A copy of an FMU with a changed modelDescription.xml."""
    with zipfile.ZipFile(path) as source, zipfile.ZipFile(to, "w") as target:
        for name in source.namelist():
            content = source.read(name)
            if name == "modelDescription.xml":
                assert old in content
                content = content.replace(old, new, 1)
            target.writestr(name, content)
    return to


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b'guid="{', b'guid="{0'),
        (b"</ModelVariables>", b""),
        (b'valueReference="3"', b'valueReference="100003"'),
        (b'fmiVersion="2.0"', b'fmiVersion="1.0"'),
        (b'causality="input"', b'causality="output"'),
        (b'name="bearing_1.force_uy"', b'name="bearing_1.force_uz"'),
        (b'modelIdentifier="gearbox"', b'modelIdentifier="nothing"'),
    ],
)
def test_damaged_files_give_a_report(model, fmu_path, tmp_path, old, new):
    """Findings and failed checks, whatever cannot be run; no exception."""
    report = gp.validate_fmu(spoilt(fmu_path, tmp_path / "spoilt.fmu", old, new), model)
    assert not report.passed
    assert report.findings
    failed = [check.name for check in report.checks if not check.passed]
    assert failed[0].startswith("conformance to FMI")


def test_the_fmu_of_another_model_is_told_as_such(model, fmu_path):
    """By its variables, before any physics is compared."""
    last = gp.validate_fmu(fmu_path, gp.load(MODEL.parent / "helical_gearbox.toml")).checks[-1]
    assert (last.name, last.passed) == ("exported from this model", False)
    assert "it lacks bearing_1.damping[1,3]" in last.what  # six degrees of freedom there
    assert "another model" in last.what
    assert suite.same_model(fmu_path, gp.api.modal_network(model), "native", 20.0).passed


def test_an_fmu_with_a_source_is_not_that_of_a_model_without(model, tmp_path):
    mesh = next(iter(model.system.components["gear_train"].meshes))
    harmonic = {"order": 1, "amplitude": 1e-6, "phase": 0.0}
    source = {"mesh": f"gear_train.{mesh}", "speed": 1000.0, "teeth": 30, "harmonics": [harmonic]}
    path = gp.export_fmu(model.replace({"source": source}), tmp_path / "source.fmu", documentation=False)
    check = suite.same_model(path, gp.api.modal_network(model), "native", 20.0)
    assert not check.passed
    assert "the model has not" in check.what
