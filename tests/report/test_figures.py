"""What is drawn: the power flow and nothing else, returned power as such."""

from dataclasses import replace

import numpy as np
import pytest
from report_reader import BEARINGS, gearbox, mirrored

import gearpath as gp
from gearpath.report.balance import balance_figure, shares_figure
from gearpath.report.figures import path_figure, ranking_figure, ratio_figure
from gearpath.report.layout import RETURNED, signed
from gearpath.report.ranking import bands, ranking
from gearpath.report.results import compute


@pytest.fixture(scope="module")
def results(model):
    return compute(model)


def drawn(traces, name, f):
    """Values of all traces of a name on the lines; NaN where nothing is drawn."""
    y = np.full(len(f), np.nan)
    for trace in traces:
        if trace["name"] == name:
            at = np.searchsorted(f, np.array(trace["x"]) * (1 - 1e-8))
            values = np.array([np.nan if v is None else v for v in trace["y"]])
            y[at] = np.where(np.isnan(values), y[at], values)
    return y


def check_signed(traces, name, ratio, f):
    for mask, label in (ratio > 0, name), (ratio < 0, f"{name} (returned)"):
        y = drawn(traces, label, f)
        np.testing.assert_array_equal(np.isnan(y), ~mask)
        np.testing.assert_allclose(y[mask], 10 * np.log10(abs(ratio[mask])), rtol=1e-5)


def test_ratio_and_its_parts_are_those_of_the_power_flow(results, flow):
    traces = ratio_figure(results).data
    f = flow.frequency.values
    check_signed(traces, "all paths, α", flow.alpha.values, f)
    check_signed(traces, "force paths", flow.alpha_force.values, f)
    check_signed(traces, "moment paths", flow.alpha_moment.values, f)


def test_every_path_is_that_of_the_power_flow(results, flow):
    traces = path_figure(results).data
    f = flow.frequency.values
    for k, dof in enumerate(("uy", "rx")):
        panel = [trace for trace in traces if trace.get("yaxis") == ("y" if k == 0 else "y2")]
        for bearing in BEARINGS:
            check_signed(panel, bearing, flow.path_alpha.sel(path=f"{bearing}.{dof}").values, f)


def test_returned_power_is_dotted_and_in_the_legend(results):
    for figure in (ratio_figure(results), path_figure(results)):
        assert any(trace["name"].endswith("(returned)") for trace in figure.data)
        for trace in figure.data:
            back = trace["name"].endswith("(returned)") or trace["name"] == "returned to the source"
            if trace["mode"] == "lines":
                assert (trace["line"]["dash"] == RETURNED) == back
        shown = [trace["name"] for trace in figure.data if trace.get("showlegend", True)]
        assert any("returned" in name for name in shown)
        assert len(shown) == len(set(shown))
    assert path_figure(results).data[-1]["x"] == [None]  # plotly leaves traces without points out of the legend


def test_natural_frequencies_are_marked(results, model):
    (ticks,) = [trace for trace in ratio_figure(results).data if trace["name"] == "natural frequencies"]
    natural = gp.natural_frequencies(model)
    np.testing.assert_allclose(ticks["x"], natural[(natural >= 20) & (natural <= 5000)], rtol=1e-8)


def test_rounding_noise_is_not_drawn():
    results = compute(mirrored())
    assert not [trace for trace in ratio_figure(results).data if "moment" in trace["name"]]
    assert "moment paths carry no power" in ratio_figure(results).caption
    assert not [trace for trace in path_figure(results).data if trace.get("yaxis") == "y2"]


def test_a_line_between_gaps_becomes_a_dot():
    f = np.arange(1.0, 6.0)
    traces = signed(f, np.array([0.1, -0.1, 0.1, 0.1, 0.0]), "a", "#000000")
    dots = {trace["name"]: trace["x"] for trace in traces if trace["mode"] == "markers"}
    assert dots == {"a": [1.0], "a (returned)": [2.0]}
    assert signed(f, np.zeros(5), "a", "#000000") == []


def test_bars_are_the_shares_of_the_ranking(results):
    figure = ranking_figure(results)
    for k, band in enumerate(bands(results.frequency)):
        shares = {item.name: 100 * item.share for item in ranking(results, band)}
        assert {bar["name"]: pytest.approx(bar["y"][k], rel=1e-5) for bar in figure.data} == shares
        assert sum(max(bar["y"][k], 0.0) for bar in figure.data) == pytest.approx(100.0, rel=1e-4)


def test_balance_and_shares(results, flow):
    powers = {trace["name"]: np.array(trace["y"], float) for trace in balance_figure(results).data}
    np.testing.assert_allclose(powers["input power"], flow.input_power, rtol=1e-5)
    np.testing.assert_allclose(powers["sum of dissipated powers"], flow.input_power, rtol=1e-5)
    np.testing.assert_allclose(powers["through the bearings"], flow.transmitted_power, rtol=1e-5)
    shares = {trace["name"]: np.array(trace["y"], float) for trace in shares_figure(results).data}
    assert set(shares) == set(flow.element.values) - {"casing"}
    np.testing.assert_allclose(sum(shares.values()), 100.0, rtol=1e-4)


def test_machine_at_rest_draws_no_ratio():
    results = compute(gearbox(5))
    names = ["input_power", "path_power", "dissipated_power", "alpha", "alpha_force", "alpha_moment", "path_alpha"]
    rest = replace(results, **{name: np.zeros_like(getattr(results, name)) for name in names})
    assert [trace["name"] for trace in ratio_figure(rest).data] == ["natural frequencies"]
    assert shares_figure(rest).data == []
    assert {value for bar in ranking_figure(rest).data for value in bar["y"]} == {None}
