"""The study of static completeness on the default gearbox: what it finds, draws and tabulates."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from systems import default_gearbox

import gearpath as gp
from gearpath.errors import InputError
from gearpath.network.assemble import assemble, to_modes
from gearpath.network.power import power_flow
from gearpath.reduction import craig_bampton, reduced_modes
from gearpath.study.completeness import completeness_figure, completeness_table, static_completeness

MODEL = Path(__file__).resolve().parents[2] / "models" / "gearbox.toml"
COUNTS = (2, 4, 6, 9, 12, 18, 30)


@pytest.fixture(scope="module")
def study():
    return static_completeness(gp.load(MODEL), COUNTS)


def test_grid_and_sizes(study):
    assert (study.component, study.coordinates) == ("gear_train", 69)
    np.testing.assert_array_equal(study.frequency, np.arange(10.0, 5001.0, 10.0))
    extra = {"Lanczos, block start": 9, "Lanczos, mesh start": 9, "fixed-interface modes": 10}
    extra |= {"free-interface modes": 4, "free-interface modes with residuals": 14}
    assert [curve.method for curve in study.curves] == list(extra)
    for curve in study.curves:
        np.testing.assert_array_equal(curve.vectors, COUNTS)
        np.testing.assert_array_equal(curve.size, curve.vectors + extra[curve.method])


def test_one_entry_by_another_way(study):
    """Craig-Bampton with 12 modes: the deviation from alpha by direct solution of the network, transmission error."""
    network = assemble(default_gearbox())
    source = network.structures["gear_train"]
    modal = to_modes(network, {**network.bases, "gear_train": reduced_modes(source, craig_bampton(source, 12))})
    omega = 2 * np.pi * study.frequency
    levels = [10 * np.log10(power_flow(item, omega).share()) for item in (network.modal(), modal)]
    curve = study.curve("fixed-interface modes")
    k = list(curve.vectors).index(12)
    assert curve.mean[k] == pytest.approx(abs(levels[1] - levels[0]).mean(), rel=1e-6)
    assert curve.maximum[k] == pytest.approx(abs(levels[1] - levels[0]).max(), rel=1e-6)


def test_what_the_study_finds(study):
    """Static completeness decides: 3e-4 dB by 18 block Lanczos vectors, 0.4 dB by 18 free modes without residuals."""

    def mean(method, count):
        curve = study.curve(method)
        return curve.mean[list(curve.vectors).index(count)]

    assert mean("Lanczos, block start", 18) == pytest.approx(3.35e-4, rel=0.05)
    assert all(0.8 < mean("Lanczos, mesh start", count) < 1.6 for count in (4, 6, 9))
    assert mean("free-interface modes", 18) > 0.3
    assert mean("free-interface modes with residuals", 18) < 1e-4
    assert mean("fixed-interface modes", 18) < 1e-2
    for curve in study.curves:
        assert curve.mean[-1] < 0.1 * curve.mean[0]
        np.testing.assert_allclose(curve.estimate, curve.deviation, rtol=0.3)


def test_static_defect_goes_with_the_basis(study):
    assert study.curve("free-interface modes with residuals").static_defect.max() < 1e-10
    block = study.curve("Lanczos, block start")
    assert block.static_defect[block.vectors >= 9].max() < 1e-10  # the first block of nine is complete
    assert block.static_defect[0] > 1e-3
    assert study.curve("free-interface modes").static_defect.min() > 1e-2


def test_table_has_a_row_for_every_basis(study):
    table = completeness_table(study)
    assert [group.label for group in table.groups] == [curve.method for curve in study.curves]
    for group, curve in zip(table.groups, study.curves):
        for k, row in enumerate(group.rows):
            assert len(row) == len(table.head)
            assert [float(cell) for cell in row[:2]] == [curve.vectors[k], curve.size[k]]
            expected = [curve.mean[k], curve.maximum[k], curve.static_defect[k], curve.estimate[k], curve.deviation[k]]
            np.testing.assert_allclose([float(cell) for cell in row[2:]], expected, rtol=0.05)


def test_figure_shows_every_method_and_is_reproducible(study, tmp_path, monkeypatch):
    from matplotlib.figure import Figure

    drawn = []
    save = Figure.savefig
    monkeypatch.setattr(Figure, "savefig", lambda figure, *a, **k: (drawn.append(figure), save(figure, *a, **k)))
    one, two = (completeness_figure(study, tmp_path / name).read_bytes() for name in ("a.svg", "b.svg"))
    assert one == two
    assert one.startswith(b"<?xml")
    for axes, key in zip(drawn[0].axes, ("mean", "maximum")):
        assert axes.get_yscale() == "log"
        for line, curve in zip(axes.get_lines(), study.curves, strict=True):
            assert line.get_label() == curve.method
            np.testing.assert_array_equal(line.get_xdata(), curve.size)
            np.testing.assert_array_equal(line.get_ydata(), getattr(curve, key))


def test_counts_that_the_source_does_not_have_are_left_out():
    model = gp.load(MODEL)
    study = static_completeness(model, counts=(5, 1000), frequencies_hz=np.array([100.0, 1000.0]))
    assert all(list(curve.vectors) == [5] for curve in study.curves)
    with pytest.raises(InputError, match="'gear_train' can be reduced to 0 to 60 vectors"):
        static_completeness(model, counts=(1000,))


def test_the_study_does_not_depend_on_the_amplitude(study):
    model = gp.load(MODEL)
    other = static_completeness(model.replace({"excitation.displacement": 5e-6}), counts=(9,))
    for curve, first in zip(other.curves, study.curves):
        assert curve.mean[0] == pytest.approx(first.mean[list(first.vectors).index(9)], rel=1e-9)


def test_point_forces_are_judged_as_they_are():
    model = gp.load(MODEL)
    forced = model.replace({"excitation": {"point": "gear_train.input@0.06", "dof": "uy"}})
    study = static_completeness(forced, counts=(4, 30), frequencies_hz=np.arange(50.0, 2001.0, 50.0))
    curve = replace(study.curve("Lanczos, block start"))
    assert curve.mean[1] < 1e-2 * curve.mean[0]
