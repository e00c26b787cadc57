"""Rolling bearings in pages: only where the model has them, with figures that show the loads and stiffness computed."""

import json
import warnings

import numpy as np
import pytest
from ball_sum import SHAPES, Balls, stiffness
from report_reader import BEARINGS, Reader, gearbox

import gearpath as gp
from gearpath.report.bearing_page import bearing_page
from gearpath.report.page import write_report
from gearpath.study.single_bearing import Duty, arranged, study


class Page(Reader):
    """Figures may be polar: without abscissae."""

    @property
    def figures(self):
        (text,) = [t for ids, _, t in self.texts if "figure-data" in ids]
        book = json.loads(text)
        self.layouts = {key: figure["layout"] for key, figure in book["figures"].items()}
        return {
            key: [{**trace, "x": book["grids"][trace["x"]]} if "x" in trace else trace for trace in figure["data"]]
            for key, figure in book["figures"].items()
        }


def rolling():
    """Two ball bearings at the operating point, a pair, and one at a load of its own."""
    data = gearbox(points=30).to_dict()
    for name in BEARINGS:
        joint = data["joints"][name]
        del joint["stiffness"]
        joint["catalogue"] = "6205-like"
    data["joints"]["bearing_3"] |= {"catalogue": "7206B-like", "arrangement": "back_to_back"}
    data["joints"]["bearing_3"] |= {"distance": 0.016, "preload": 200.0}
    data["joints"]["bearing_4"] |= {"load": {"uy": 800.0}}
    data["operation"] = {"torque": 100.0, "speed": 12000.0}
    return gp.Model.from_dict(data)


@pytest.fixture(scope="module")
def machine():
    return rolling()


@pytest.fixture(scope="module")
def shown(machine, tmp_path_factory):
    target = tmp_path_factory.mktemp("bearings") / "report.html"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return Page(write_report(machine, target).read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """The page of one bearing under a load, and its case."""
    load = {"ux": 1000.0, "uz": 1500.0}
    case = study("7210B-like", arranged(gp.catalogue_bearing("7210B-like")), Duty(load, {}), phases=True)
    target = tmp_path_factory.mktemp("bearing") / "page.html"
    return Page(bearing_page(target)([case]).read_text(encoding="utf-8")), case


def test_section_stands_only_where_there_are_rolling_bearings(page, shown):
    assert "rolling-section" not in [attrs.get("id") for _, attrs in page.tags]
    assert not [key for key in page.figures if key.startswith("bearing")]
    assert "Rolling bearings" not in " ".join(text for _, _, text in page.texts[:200])
    links = [attrs["href"] for tag, attrs in shown.tags if tag == "a"]
    assert links[1:4] == ["#model", "#rolling-section", "#natural"]
    assert "100 N m on the driving shaft" in shown.of("rolling-section").replace("\u00a0", " ")


def test_every_plot_has_its_data(shown, alone):
    for reader in (shown, alone[0]):
        boxes = {attrs["id"] for _, attrs in reader.tags if attrs.get("class") == "plot"}
        assert boxes == set(reader.figures)
        ids = [attrs["id"] for _, attrs in reader.tags if "id" in attrs]
        assert len(ids) == len(set(ids))


def test_circles_show_the_loads_that_balance(shown, machine):
    traces = shown.figures["bearing-loads"]
    assert [trace["name"] for trace in traces] == [
        "bearing_1", "bearing_2", "bearing_3, row 1", "bearing_3, row 2", "bearing_4",
    ]  # fmt: skip
    force = {}
    for trace in traces:
        psi, a = np.radians(trace["theta"]), np.radians(trace["customdata"])
        name = trace["name"].split(",")[0]
        force[name] = force.get(name, 0.0) + np.array(trace["r"]) * np.cos(a) @ np.sin(psi)
    np.testing.assert_allclose(force["bearing_1"] + force["bearing_2"], -100.0 / 0.04975, rtol=1e-4)
    np.testing.assert_allclose(force["bearing_4"], 800.0, rtol=1e-4)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        states = gp.operating_point(machine)
    np.testing.assert_allclose(force["bearing_3"], states["bearing_3"].load[1], rtol=1e-4)


def test_each_circle_has_a_place_of_its_own(shown):
    subplots = {trace["subplot"] for trace in shown.figures["bearing-loads"]}
    assert subplots == {"polar", "polar2", "polar3", "polar4"}
    layout = shown.layouts["bearing-loads"]
    places = [tuple(layout[key]["domain"]["x"] + layout[key]["domain"]["y"]) for key in sorted(subplots)]
    for k, (x0, x1, y0, y1) in enumerate(places):
        assert 0.0 <= x0 < x1 <= 1.0
        assert 0.0 <= y0 < y1 <= 1.0
        assert not any(x0 < c[1] and c[0] < x1 and y0 < c[3] and c[2] < y1 for c in places[:k])
    assert all(layout[key]["barmode"] == "overlay" for key in subplots)  # rows of a pair are not piled up


def test_curves_follow_torque_or_the_own_load(shown):
    at = {trace["name"]: trace for trace in shown.figures["bearing-curve-0"]}["K uy"]
    assert 100.0 in at["x"]
    assert shown.layouts["bearing-curve-0"]["xaxis"]["title"]["text"] == "torque on the driving shaft, N m"
    own = {trace["name"]: trace for trace in shown.figures["bearing-curve-3"]}["K uy"]
    twice = study("", gp.catalogue_bearing("6205-like"), Duty({"uy": 1600.0}, {})).state.displacement
    K = stiffness([Balls(SHAPES["6205-like"])], twice)
    np.testing.assert_allclose(own["y"][own["x"].index(1600.0)], K[1, 1], rtol=1e-5)
    axes = shown.layouts["bearing-curve-3"]
    assert [axes[key]["type"] for key in ("xaxis", "yaxis", "yaxis2", "yaxis3")] == ["log"] * 4


def test_notes_name_their_bearing(shown):
    text = shown.of("rolling-section")
    assert "Where the theory of the bearings stops" in text
    assert "12000 rev/min" in text
    assert "bearing_3 row at z = 0.008 m" in text


def test_pairs_under_preload_alone_have_circles_and_no_curves(tmp_path):
    pair = {"catalogue": "7206B-like", "arrangement": "back_to_back", "distance": 0.016, "preload": 200.0}
    data = gearbox(points=10).to_dict()
    for name in BEARINGS:
        del data["joints"][name]["stiffness"]
        data["joints"][name] |= pair
    page = Page(write_report(gp.Model.from_dict(data), tmp_path / "page.html").read_text(encoding="utf-8"))
    assert [key for key in page.figures if key.startswith("bearing")] == ["bearing-loads"]
    loads = np.array([trace["r"] for trace in page.figures["bearing-loads"]])
    angles = np.radians([trace["customdata"] for trace in page.figures["bearing-loads"]])
    np.testing.assert_allclose((loads * np.sin(angles)).sum(axis=1), 4 * [200.0, -200.0], rtol=1e-4)
    text = page.of("rolling-section")
    assert "at the loads that the model gives them" in text
    assert "bearing_1 0 0 0 0 0" in text  # the rows hold each other: what is left of their sum is rounding


def test_report_equals_itself(machine, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        first, second = (write_report(machine, tmp_path / name).read_bytes() for name in ("a.html", "b.html"))
    assert first == second


def test_page_of_one_bearing_shows_its_matrix_with_units(alone):
    page, case = alone
    inner = [(names[-1], text.strip()) for ids, names, text in page.texts if names.count("table") == 2]
    found = [_number(text) for tag, text in inner if tag == "td" and text][:36]
    units = [text for tag, text in inner if tag == "span"]
    expected = stiffness([Balls(SHAPES["7210B-like"])], case.state.displacement)
    size = np.sqrt(np.diag(expected))
    scale = np.where(np.outer(size, size) > 0, np.outer(size, size), 1.0)
    np.testing.assert_allclose(np.reshape(found, (6, 6)) / scale, expected / scale, atol=1e-3)
    assert units[:6] == ["N/m"] * 3 + ["N/rad"] * 3
    assert units[18:24] == ["N m/m"] * 3 + ["N m/rad"] * 3


def _number(text):
    """3.81 × 10⁷ as a float."""
    plain = text.replace("−", "-").replace("\u202f", "")
    plain = plain.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
    mantissa, _, exponent = plain.partition("×10")
    return float(mantissa) * 10.0 ** int(exponent or 0)


def test_page_of_one_bearing_shows_its_distribution_and_curves(alone):
    page, case = alone
    (trace,) = page.figures["loads-0"]
    psi, a, Q = np.radians(trace["theta"]), np.radians(trace["customdata"]), np.array(trace["r"])
    sums = [Q * np.cos(a) @ np.cos(psi), Q * np.cos(a) @ np.sin(psi), Q @ np.sin(a)]
    np.testing.assert_allclose(sums, [1000.0, 0.0, 1500.0], atol=0.05)
    radial, axial = zip(*[(Qr, Qa) for _, Qr, Qa in Balls(SHAPES["7210B-like"]).balls(case.state.displacement[:5])])
    np.testing.assert_allclose(Q, np.hypot(radial, axial), rtol=1e-5, atol=1e-6)
    traces = {t["name"]: t for t in page.figures["curve-0"]}
    assert {"K ux", "K uy", "K uz", "K rx", "K ry", "K ux uz", "K uy rx"} <= set(traces)
    assert "K ux ry (−)" in traces
    K = stiffness([Balls(SHAPES["7210B-like"])], case.state.displacement)
    middle = case.curve.factors.tolist().index(1.0)
    for name, pair in (("K ux", (0, 0)), ("K ux ry (−)", (0, 4)), ("K ry", (4, 4))):
        np.testing.assert_allclose(traces[name]["y"][middle], abs(K[pair]), rtol=1e-5)
    assert len({traces[name].get("yaxis") for name in ("K ux", "K ux ry (−)", "K ry")}) == 3


def test_page_has_cage_positions_and_is_complete_without_scripts(alone):
    page, _ = alone
    text = page.of("bearing-0")
    assert "Over 16 positions of the cage" in text
    assert "Stiffness K, average over the positions of the cage" in text
    assert "Load distribution: 15 of 15 elements loaded" in text
    assert not [attrs for _, attrs in page.tags if {"src", "srcset"} & set(attrs)]
