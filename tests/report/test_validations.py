"""Validations on the page: failures plainly, comparisons as Bode plots over the solver's own curve."""

from pathlib import Path

import numpy as np
import pytest

import gearpath as gp
from gearpath.fmu.checks import Check, Comparison, ValidationReport
from gearpath.report.bode import bode_figures, deviation

GOOD = Check("conformance to FMI 2.0", 0.0, 0.0, "problems found")
BAD = Check("steady <state>", 3.2e-4, 1e-6, "largest deviation")
NAN = Check("energy balance", float("nan"), 1e-6, "part of the input")


@pytest.fixture(scope="module")
def network(model):
    from gearpath.api import modal_network

    return modal_network(model)


def comparison(model, name="bearing_1.force_uy", load="mesh.transmission_error", unit="N per m", error=1e-4):
    f = np.geomspace(20.0, 5000.0, 10)
    exact = gp.frequency_response(model, f, name, load).values.reshape(-1)
    return Comparison(name, unit, f, exact * (1 + error), f, exact)


def report(*checks, file="box.fmu", kind="native", comparisons=(), **notes):
    return ValidationReport(Path("somewhere") / file, "gearbox", kind, checks, tuple(comparisons), notes)


def rows(page):
    return [attrs for tag, attrs in page.tags if tag == "tr" and attrs.get("class") == "failed"]


def test_a_failing_check_is_plain(model, read):
    page = read(model, validations=[report(GOOD), report(GOOD, BAD, NAN, file="a<b>&.fmu", kind="python")])
    findings, section = page.of("findings"), page.of("validation")
    assert "went through 4 checks; 2 FAILED: “steady <state>” of a<b>&.fmu and “energy" in findings
    assert "1 of 2 CHECKS FAILED" in findings
    assert "box.fmu (native): ✓ all checks passed" in section
    assert "a<b>&.fmu (python): ✗ FAILED" in section
    assert section.count("✗ FAILED") == 3
    assert section.count("✓ passed") == 2
    assert len(rows(page)) == 2
    assert "3.20 × 10⁻⁴" in section
    assert "not a number" in section
    assert "b" not in {tag for tag, _ in page.tags}


def test_all_passed_and_notes(model, read):
    page = read(model, validations=[report(GOOD, fmpy="0.3 <x>")])
    assert "1 FMU (box.fmu) went through 1 check; all of them passed" in page.of("findings")
    assert "FAILED" not in page.of("findings") + page.of("validation")
    assert "fmpy 0.3 <x>" in page.of("validation")
    assert rows(page) == []
    assert 'gp.validate_fmu(path, model) for path in ["box.fmu"]' in page.of("reproduce")


def test_no_checks_are_not_called_passed(model, read):
    page = read(model, validations=[report()])
    assert "no checks were made" in page.of("validation")
    assert "✓" not in page.of("validation")


def test_none_validated(page):
    assert "No FMU was validated" in page.of("validation")
    assert "No transfers" in page.of("bode-section")


def test_comparisons_are_drawn(model, read):
    names = [
        "bearing_1.force_uy",
        "bearing_2.force_rx",
        "bearing_1.velocity_uy",
        "bearing_3.force_uy",
        "bearing_4.force_uy",
    ]
    both = [
        report(GOOD, file=file, kind=kind, comparisons=[comparison(model, name) for name in names])
        for file, kind in (("box.fmu", "native"), ("<i>.fmu", "python"))
    ]
    page = read(model, validations=both)
    drawn = {key: traces for key, traces in page.figures.items() if key.startswith("bode-")}
    assert len(drawn) == 5
    boxes = [attrs["id"] for _, attrs in page.tags if attrs.get("class") == "plot"]
    assert set(drawn) <= set(boxes)
    assert "1 more transfer" in page.within("summary")
    item = both[0].comparisons[0]
    solver, phase, magnitude, _, other, _ = drawn["bode-0"]
    assert other["name"] == "&lt;i&gt;.fmu (python)"
    np.testing.assert_allclose(magnitude["y"], 20 * np.log10(abs(item.simulated)), rtol=1e-5)
    f = np.array(solver["x"])
    fine = gp.frequency_response(model, f, item.name, "mesh.transmission_error").values.reshape(-1)
    np.testing.assert_allclose(np.array(solver["y"], float), 20 * np.log10(abs(fine)), atol=1e-3)
    assert len(f) > 500
    assert max(np.min(abs(f / at - 1)) for at in item.frequency) < 1e-8
    shown = [(x, y) for x, y in zip(phase["x"], phase["y"]) if y is not None]
    assert all(abs(y) <= 180.0 for _, y in shown)


def test_resonances_are_on_the_curve(model, network):
    (figure,) = bode_figures([report(GOOD, comparisons=[comparison(model)])], network)
    natural = gp.natural_frequencies(model)
    inside = natural[(natural > 20) & (natural < 5000)]
    gaps = [np.min(abs(np.array(figure.data[0]["x"]) / f - 1)) for f in inside]
    assert max(gaps) < 1e-8
    assert "per unit of mesh.transmission_error" in figure.caption
    assert "1.0 × 10⁻⁴" in figure.caption.replace("\u202f", " ")


def test_transfers_from_different_inputs_are_not_mixed(model, network):
    two = [comparison(model, load=load, unit="N per N") for load in ("mesh.transmission_error", "mesh.force")]
    figures = bode_figures([report(GOOD, comparisons=two)], network)
    assert [figure.caption.split(". ")[0] for figure in figures] == [
        "bearing_1.force_uy per unit of mesh.transmission_error",
        "bearing_1.force_uy per unit of mesh.force",
    ]


def test_a_transfer_that_the_model_lacks_is_drawn_between_its_points(network):
    f = np.array([10.0, 20.0, 40.0])
    strange = Comparison("sensors.unknown", "m/s per N", f, f * (1 + 1j), f, f * (1 + 1j) + 1)
    other = Comparison("bearing_1.force_uy", "N per m", f, f * 1j, f, f * 1j)
    for item in (strange, other):
        (figure,) = bode_figures([report(GOOD, comparisons=[item])], network)
        assert figure.data[0]["x"] == [10.0, 20.0, 40.0]
        assert "straight between its points" in figure.caption
    empty = Comparison("bearing_1.force_uy", "N per m", f[:0], f[:0] * 1j, f[:0], f[:0] * 1j)
    assert bode_figures([report(GOOD, comparisons=[empty])], network) == []


def test_deviation_is_relative_to_the_largest_value():
    f = np.array([1.0, 2.0])
    solver = np.array([1.0, 100.0], complex)
    assert deviation(Comparison("a", "m", f, solver + np.array([0.5, 0]), f, solver)) == pytest.approx(0.005)


def test_simulated_phases_lie_beside_the_solver(model, network):
    (figure,) = bode_figures([report(GOOD, comparisons=[comparison(model, error=1e-3j)])], network)
    item = comparison(model)
    np.testing.assert_allclose(figure.data[3]["y"], np.degrees(np.angle(item.solver)) + np.degrees(1e-3), atol=1e-3)


def test_bode_figures_have_headings_and_round_ticks(model, network, read):
    page = read(model, validations=[report(GOOD, comparisons=[comparison(model)])])
    assert "bearing_1.force_uy" in page.within("h3")
    (figure,) = bode_figures([report(GOOD, comparisons=[comparison(model)])], network)
    assert figure.layout["xaxis"]["ticktext"] == ["20", "50", "100", "200", "500", "1000", "2000", "5000"]
