"""Every number of the findings against the power flow, computed here anew."""

import re

import numpy as np
import pytest
import xarray as xr
from report_reader import BEARINGS, gearbox, mirrored, mounts_only, plain, single, translating

import gearpath as gp
from gearpath.report.findings import findings, key_figures
from gearpath.report.ranking import bands, ranking, total, whole_band
from gearpath.report.results import compute
from gearpath.report.tables import band_table, ranking_table

UPRIGHT = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
NUMBER = r"(-?[\d.]+)"
EDGES = {"20–1000 Hz": (0, 1000), "1–2 kHz": (1000, 2000), "2–3 kHz": (2000, 3000), "3–5 kHz": (3000, 5001)}


def lines(flow, label):
    low, high = EDGES.get(label, (0, np.inf))
    return flow.sel(frequency=(flow.frequency >= low) & (flow.frequency < high))


def summed(flow, label=""):
    """Net power of each bearing, by forces and by moments, and the input power, summed over the lines of a band."""
    part = lines(flow, label)
    power = (part.path_alpha * part.input_power).sum("frequency")
    bearing, dof = zip(*(path.rsplit(".", 1) for path in power.path.values))
    power = power.assign_coords(bearing=("path", list(bearing)), moment=("path", [d.startswith("r") for d in dof]))
    return power, float(part.input_power.sum())


def agrees(printed, value):
    """Whether a printed number is the value rounded to the digits printed."""
    mantissa, _, power = printed.partition(" × 10")
    unit = 10.0 ** int(power.translate(UPRIGHT) or 0)
    digits = len(mantissa.split(".")[1]) if "." in mantissa else 0
    return float(mantissa) * unit == pytest.approx(value, abs=0.5001 * 10.0**-digits * unit)


def said(model, label):
    return {item.label: plain(item.text) for item in findings(compute(model), [])}[label]


@pytest.fixture(scope="module")
def text(page):
    return page.of("findings")


def test_power_ratio_summed_over_the_band(text, flow):
    share, level = re.search(
        rf"Summed over 20 Hz–5 kHz, {NUMBER} % of the input power .*? 4 bearings \({NUMBER} dB\)", text
    ).groups()
    ratio = float((flow.alpha * flow.input_power).sum() / flow.input_power.sum())
    assert agrees(share, 100 * ratio)
    assert agrees(level, 10 * np.log10(ratio))


def test_what_the_sum_describes(text, flow):
    share, label = re.search(rf"of which {NUMBER} % enters in ([^:]+):", text).groups()
    assert agrees(share, 100 * summed(flow, label)[1] / summed(flow)[1])
    assert summed(flow, label)[1] == max(summed(flow, band)[1] for band in EDGES)


def test_mean_levels_by_band(text, flow):
    found = re.findall(rf"{NUMBER} dB in (\d[^,.]*?Hz)", text)
    assert [label for _, label in found] == list(EDGES)
    for printed, label in found:
        assert agrees(printed, float((10 * np.log10(abs(lines(flow, label).alpha))).mean()))


def test_largest_ratio(text, flow):
    at, share = re.search(rf"largest at {NUMBER} Hz, where {NUMBER} %", text).groups()
    assert agrees(at, float(flow.frequency[int(flow.alpha.values.argmax())]))
    assert agrees(share, 100 * float(flow.alpha.max()))


def test_bearings_that_pass_and_return_power(text, flow):
    net = summed(flow)[0].groupby("bearing").sum()
    entering = float(net.where(net > 0).sum())
    passing, returned, back, remaining = re.search(
        rf"the receiver casing comes through (.*?)\. Of this power, {NUMBER} % flows back into the source through "
        rf"(.*?); the remaining {NUMBER} % is",
        text,
    ).groups()
    pairs = [(item, 1) for item in re.findall(rf"(bearing_\d) \({NUMBER} %\)", passing)]
    pairs += [(item, -1) for item in re.findall(rf"(bearing_\d) \({NUMBER} %\)", back)]
    assert sorted(name for (name, _), _ in pairs) == BEARINGS
    for (name, printed), sign in pairs:
        assert agrees(printed, 100 * sign * float(net.sel(bearing=name)) / entering)
    assert agrees(returned, -100 * float(net.where(net < 0).sum()) / entering)
    assert agrees(remaining, 100 * float(net.sum()) / entering)
    order = [name for (name, _), sign in pairs if sign > 0]
    assert order == [b for b in net.bearing.values[np.argsort(-net.values)] if net.sel(bearing=b) > 0]


def test_first_bearing_of_every_band(text, flow):
    listed = re.search(r"Band by band, most passes (.*?)\.", text).group(1)
    found = {}
    for part in listed.split("; "):
        name, where = re.fullmatch(r"through (bearing_\d) in (.*)", part).groups()
        found |= dict.fromkeys(re.split(", | and ", where), name)
    net = {label: summed(flow, label)[0].groupby("bearing").sum() for label in EDGES}
    assert found == {label: str(power.bearing.values[power.values.argmax()]) for label, power in net.items()}


def test_share_of_the_moment_paths(text, flow):
    power, _ = summed(flow)
    moment = float(power[power.moment].sum() / power.sum())
    assert moment < 0.0  # in this model
    share, often, force = re.search(
        rf"return power to the source, {NUMBER} % of the net transmitted power \(they do so on {NUMBER} % of the "
        rf"lines\); the force paths carry {NUMBER} %",
        text,
    ).groups()
    assert agrees(share, -100 * moment)
    assert agrees(force, 100 * (1 - moment))
    assert agrees(often, 100 * float((flow.alpha_moment < 0).mean()))


def test_where_moments_weigh_most(text, flow):
    at, moment, force = re.search(
        rf"weigh most at {NUMBER} Hz, where they pass {NUMBER} % of the input power and the force paths {NUMBER} %",
        text,
    ).groups()
    k = int((abs(flow.alpha_moment) / (abs(flow.alpha_moment) + abs(flow.alpha_force))).values.argmax())
    assert agrees(at, float(flow.frequency[k]))
    assert agrees(moment, 100 * float(flow.alpha_moment[k]))
    assert agrees(force, 100 * float(flow.alpha_force[k]))


def test_balance(text, flow):
    printed = re.search(r"agree within ([\d.]+ × 10\S+)", text).group(1)
    residual = float(abs(flow.dissipated_power.sum("element") / flow.input_power - 1).max())
    assert agrees(printed, residual)


def test_key_figures_repeat_the_findings(model, flow):
    figures = {item.label: plain(item.value + " | " + item.detail) for item in key_figures(compute(model), [])}
    power, _ = summed(flow)
    net = power.groupby("bearing").sum()
    name, share = re.match(rf"(\w+) \| {NUMBER} %", figures["bearing that passes most"]).groups()
    assert name == net.bearing.values[net.values.argmax()]
    assert agrees(share, 100 * float(net.max() / net.where(net > 0).sum()))
    assert agrees(figures["moment paths"].split()[0], 100 * float(power[power.moment].sum() / power.sum()))


def test_no_share_of_entering_power_exceeds_it(model):
    results = compute(model)
    for band in (*bands(results.frequency), whole_band(results.frequency)):
        order = ranking(results, band)
        assert sum(item.share for item in order if item.share > 0) == pytest.approx(1.0)
        assert sum(item.share for item in order) == pytest.approx(total(results, band).share)
        assert min(item.share for item in order) >= -1.0
        assert [item.ratio for item in order] == sorted((item.ratio for item in order), reverse=True)


def test_ranking_section_says_how_it_is_made(page):
    text = page.of("ranking-section")
    assert "ranked by net power into the receiver casing" in text
    assert "passes most is first" in text
    assert "negative share" in text


def test_ranking_table_against_the_flow(model, flow):
    item = ranking_table(compute(model))
    assert [plain(group.label) for group in item.groups] == [*EDGES, "whole band"]
    for group in item.groups:
        power, entering = summed(flow, plain(group.label))
        for row in group.rows:
            cells = [plain(cell).removesuffix(" %") for cell in row]
            own = power.where(power.bearing == cells[1], drop=True)
            part = own.path.values
            alpha = lines(flow, plain(group.label)).path_alpha.sel(path=part).sum("path")
            assert agrees(cells[3], 100 * float(own.sum()) / entering)
            assert agrees(cells[4], 10 * np.log10(abs(float(own.sum())) / entering))
            assert agrees(cells[5], 100 * float(own[own.moment].sum() / own.sum()))
            assert agrees(cells[6], float((10 * np.log10(abs(alpha))).mean()))
            assert agrees(cells[7], 100 * float((alpha < 0).mean()))


def test_band_table_against_the_flow(model, flow):
    (group,) = band_table(compute(model)).groups
    for row in group.rows:
        cells = [plain(cell).removesuffix(" %") for cell in row]
        power, entering = summed(flow, cells[0])
        assert int(cells[1]) == lines(flow, cells[0]).sizes["frequency"]
        assert agrees(cells[2], 100 * float(power.sum()) / entering)
        assert agrees(cells[6], 100 * float(power[power.moment].sum() / power.sum()))


def test_bands_share_every_line_once():
    for f in (np.linspace(20, 5000, 997), np.linspace(1000, 3000, 21), np.linspace(1, 8000, 50), np.array([7.0, 9.0])):
        found = bands(f)
        assert (sum(band.lines.astype(int) for band in found) == 1).all()
    assert [plain(band.label) for band in found] == ["7–9 Hz"]


def test_mirrored_couplings_leave_exactly_nothing_to_the_moments():
    model = mirrored()
    raw = gp.power_flow(model)
    results = compute(model)
    assert isinstance(raw, xr.Dataset)
    assert 0.0 < abs(raw.alpha_moment).max() < 1e-12  # what rounding leaves
    assert not results.alpha_moment.any()
    assert total(results, whole_band(results.frequency)).moment == 0.0
    assert "carry no net power" in said(model, "Moments")
    assert {row[-1] for row in band_table(results).groups[0].rows} == {"0\u00a0%"}


def test_bearings_equal_but_for_rounding_share_the_first_place():
    text = said(mirrored(), "Bearings")
    assert "bearing_1 (50.0 %) and bearing_2 (50.0 %)" in text
    assert "In every band most passes through bearing_1 and bearing_2 alike." in text
    (first,) = [item for item in key_figures(compute(mirrored()), []) if item.label == "bearing that passes most"]
    assert first.value == "bearing_1 and bearing_2"


def test_translation_alone_has_no_moment_paths(read):
    model = translating()
    assert said(model, "Moments") == "The bearings have no moment paths."
    page = read(model)
    assert not [trace for trace in page.figures["ratio"] if "moment" in trace["name"]]
    drawn = {trace["legendgroup"].split()[0] for trace in page.figures["paths"] if "legendgroup" in trace}
    assert drawn == set(BEARINGS)
    assert "The moment paths carry no power" in page.of("ratio-section")


def test_a_single_bearing_carries_everything():
    assert said(single(), "Bearings") == "All of it passes through bearing_1."
    assert "leaves the source through the bearing (" in said(single(), "Power ratio")


def test_without_bearings():
    labels = [item.label for item in findings(compute(mounts_only()), [])]
    assert labels == ["Paths", "Balance"]
    assert [item.label for item in key_figures(compute(mounts_only()), [])] == ["power balance"]


def test_one_band_is_not_said_twice():
    text = said(gearbox(**{"frequency.stop": 900.0}), "Bearings")
    assert "Band by band" not in text
    assert "in every band" not in text.lower()
    assert len(ranking_table(compute(gearbox(**{"frequency.stop": 900.0}))).groups) == 1
