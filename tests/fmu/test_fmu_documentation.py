"""The page: its curves read back from the drawing, its tables against other computations, and nothing from outside."""

import re
import subprocess
import sys
import time
import xml.etree.ElementTree as ET
import zipfile
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import control
import numpy as np
import pytest
from fmu_helpers import export
from fmu_networks import gearbox

import gearpath as gp
from gearpath.api import amplitude as amplitude_of
from gearpath.api import modal_network
from gearpath.fmu.description import LOG_CATEGORIES
from gearpath.fmu.native_table import native_table
from gearpath.fmu.supplements import supplements
from gearpath.network.natural import natural_frequencies
from gearpath.network.records import MeshSource, Tone
from gearpath.network.response import frequency_response
from gearpath.network.time_twin import time_twin

MODEL = Path(__file__).resolve().parents[2] / "models" / "gearbox.toml"
F = np.array([20.0, 35.0, 100.0, 206.0, 470.0, 699.0, 1000.0, 1523.0, 2149.0, 2246.0, 2400.0, 3000.0, 4100.0, 5000.0])
ODD = "Größe <&\"> 'x' </svg>"
VOID = {"meta", "br"}


class Page(HTMLParser):
    """Raises AssertionError where an end tag does not fit the open element; gathers texts, links and drawings."""

    def __init__(self, html):
        super().__init__(convert_charrefs=True)
        self.stack, self.tags, self.text, self.rows = [], [], "", []
        self.feed(html)
        self.close()
        assert self.stack == []

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.stack.append(tag)
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_startendtag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        assert self.stack, f"</{tag}> closes nothing"
        assert self.stack.pop() == tag

    def handle_data(self, data):
        if "style" in self.stack:
            return
        self.text += data
        if {"td", "th"} & set(self.stack):
            self.rows[-1][-1] += data

    def values(self, attribute):
        return [attrs[attribute] for _, attrs in self.tags if attribute in attrs]


def shown_points(piece):
    """Corners of a polyline; a dash of one pixel is a point between gaps."""
    points = np.array(re.findall(r"(-?[\d.]+) (-?[\d.]+)", piece), float)
    dash = len(points) == 2 and points[0, 1] == points[1, 1] and abs(points[1, 0] - points[0, 0] - 1) < 0.02
    return points.mean(axis=0) if dash else points


def read(html):
    """Figure caption -> {curve name: (frequencies Hz, levels dB)}, by the numbers beside the axes."""
    found = {}
    for part in re.findall(r"<figure>.*?</figure>", html, re.S):
        caption = re.search(r"<figcaption>(.*?)</figcaption>", part)[1]
        svg = ET.fromstring(re.search(r"<svg.*?</svg>", part, re.S)[0])
        ticks = {g.get("class"): g for g in svg.iter("g") if g.get("class")}
        xs = np.array([(float(t.get("x")), np.log(float(t.text))) for t in ticks["x"]])
        ys = np.array([(float(t.get("y")) - 4.0, float(t.text)) for t in ticks["y"]])
        curves = {}
        (drawn,) = [g for g in svg.iter("g") if g.get("clip-path")]
        for path in drawn:
            points = np.vstack([shown_points(piece) for piece in path.get("d").split("M")[1:]])
            frequency = np.exp(np.polyval(np.polyfit(*xs.T, 1), points[:, 0]))
            curves[path.find("title").text] = frequency, np.polyval(np.polyfit(*ys.T, 1), points[:, 1])
        found[caption] = curves
    return found


@pytest.fixture(scope="module")
def model():
    return gp.load(MODEL)


@pytest.fixture(scope="module")
def modal_model(model):
    return modal_network(model)


def page(network, fmi="2.0", **settings):
    variables = native_table(network, 1000.0, fmi)
    return supplements(network, variables, fmi, description="A test", **settings)["documentation/index.html"].decode()


def test_plots_cover_the_models_own_range(tmp_path, model):
    """The range of the model file's [frequency], not a fixed one."""
    other = model.replace({"frequency.start": 150.0, "frequency.stop": 900.0})
    with zipfile.ZipFile(gp.export_fmu(other, tmp_path / "range.fmu")) as archive:
        text = archive.read("documentation/index.html").decode()
    assert "Power ratio and its parts from 150 to 900 Hz" in " ".join(text.split())


@pytest.fixture(scope="module")
def html(modal_model):
    return page(modal_model, frequencies=F)


def close(found, f, values, lg):
    """Points of a curve against numbers at given frequencies: within half a hundredth of a pixel."""
    frequency, level = found
    np.testing.assert_allclose(frequency, f, rtol=1e-4)
    np.testing.assert_allclose(level, lg * np.log10(abs(values)), atol=0.01)


def test_power_curves_are_the_power_flow(html, model):
    flow, curves = gp.power_flow(model, F), read(html)["Power through the bearings over input power"]
    for name, key in (("all paths, alpha", "alpha"), ("force paths", "alpha_force"), ("moment paths", "alpha_moment")):
        ratio = flow[key].values
        close(curves[name], F[ratio > 0], ratio[ratio > 0], 10)
        if (ratio < 0).any():
            close(curves[f"{name}, returned to the source"], F[ratio < 0], ratio[ratio < 0], 10)
    assert (flow["alpha_moment"].values < 0).any()
    assert (flow["alpha_moment"].values > 0).any()
    assert len(curves) == 4


def test_transfer_curves_are_forces_and_velocities_of_the_power_flow(html, model):
    flow, figures = gp.power_flow(model, F), read(html)
    amplitude = amplitude_of(model)
    forces = figures["Forces on the receivers, uy, per unit of mesh.transmission_error"]
    moments = figures["Moments on the receivers, rx, per unit of mesh.transmission_error"]
    assert len(forces) == len(moments) == 4
    for k in range(1, 5):
        for curves, dof in ((forces, "uy"), (moments, "rx")):
            values = flow["force"].sel(path=f"bearing_{k}.{dof}").values / amplitude
            close(curves[f"bearing_{k}.force_{dof}"], F, values, 20)
    casing = [curves for caption, curves in figures.items() if "elocities" in caption]
    named = {name: curve for curves in casing for name, curve in curves.items()}
    response = gp.frequency_response(model, F, list(named), ["mesh.transmission_error"])
    assert {"casing.velocity_uy", "casing.velocity_rx", "casing.velocity_rz"} <= set(named)
    for name, curve in named.items():
        close(curve, F, response.sel(output=name).values[:, 0], 20)


def test_axes_show_the_curves(html):
    """At least the uppermost 100 dB, and nothing above the frame."""
    for part in re.findall(r"<figure>.*?</figure>", html, re.S):
        svg = ET.fromstring(re.search(r"<svg.*?</svg>", part, re.S)[0])
        left, top, right, bottom = 0.0, 0.0, *map(float, svg.get("viewBox").split()[2:])
        (drawn,) = [g for g in svg.iter("g") if g.get("clip-path")]
        points = np.array(re.findall(r"(-?[\d.]+) (-?[\d.]+)", "".join(path.get("d") for path in drawn)), float)
        assert points[:, 0].min() > left
        assert points[:, 0].max() < right
        assert points[:, 1].min() > top
        assert np.median(points[:, 1]) < bottom


def test_default_frequencies_reach_every_resonance(modal_model, model):
    curve = read(page(modal_model))["Power through the bearings over input power"]["all paths, alpha"]
    natural = gp.natural_frequencies(model)
    inside = natural[(natural > 20) & (natural < 5000)]
    assert inside.size > 8
    assert abs(curve[0][:, None] / inside - 1).min(axis=0).max() < 1e-3
    assert [round(x) for x in (curve[0].min(), curve[0].max())] == [20, 5000]
    marks = re.search(r'class="marks" d="([^"]*)"', page(modal_model))[1]
    assert marks.count("M") == inside.size


def number(text):
    text = text.replace("−", "-").replace("\xa0", " ")
    return float(re.sub(r" · 10", "e", text)) if "·" in text else float(text)


def section(html, key):
    return Page(re.search(rf'<section id="{key}">.*?</section>', html, re.S)[0])


def test_modes_are_those_of_python_control(html, model):
    w, zeta, _ = control.damp(gp.state_space(model), doprint=False)
    order = np.argsort(w)
    frequency, zeta = w[order][::2] / (2 * np.pi), zeta[order][::2]
    rows = section(html, "modes").rows[1:]
    assert len(rows) == (frequency <= 5000).sum()
    for row, f, z in zip(rows, frequency, zeta):
        assert number(row[1]) == pytest.approx(f, rel=1e-5)
        assert number(row[2]) == pytest.approx(100 * z, rel=1e-3)
    undamped = [206.63, 231.42, 295.59, 518.88, 699.38, 2149.2, 2245.6]  # as the project's equations list them
    np.testing.assert_allclose([number(row[1]) for row in rows[:7]], undamped, rtol=1e-3)


def test_most_kinetic_energy_is_where_it_should_be(html):
    """The casing on its mounts at low frequencies, bending shafts above 2 kHz."""
    where = [row[3] for row in section(html, "modes").rows[1:]]
    assert all("casing" in text for text in where[:3])
    assert all("gear_train" in text for text in where[5:])


def test_free_and_decaying_motions_are_counted(network, modal_model):
    """Without mounts the planar casing and what hangs on it moves freely; strong dampers leave real poles."""
    joints = tuple(joint for joint in modal_model.joints if not joint.grounded)
    outputs = tuple(output for output in modal_model.outputs if not output.name.startswith("mount"))
    free = replace(modal_model, joints=joints, outputs=outputs)
    # the planar machine as a whole: up and down, about x, and rolling about z, as the gears spin freely
    assert "3 rigid motions are free" in section(page(free, frequencies=F), "modes").text
    damped = network.with_joint("mount_1", 1e7 * np.ones((1, 1)), 1e7 * np.ones((1, 1)))
    poles = np.linalg.eigvals(time_twin(damped, outputs=()).A)
    assert f"{(poles.imag == 0).sum()} poles are real" in section(page(damped, frequencies=F), "modes").text
    assert (poles.imag == 0).any()


def test_joints_are_listed_with_their_matrices(html):
    rows = {row[0]: row for row in section(html, "joints").rows[1:]}
    assert len(rows) == 8
    bearing = rows["bearing_1"]
    assert bearing[1:3] == ["bearing", "gear_train, casing"]
    for entry in ("uy: 1.2 · 108 N/m", "uy,rx: 1.8 · 106 N/rad", "rx: 60000 N.m/rad"):
        assert entry in bearing[3].replace("\xa0", " ")
    assert "uy: 120 N.s/m" in bearing[4].replace("\xa0", " ")
    assert rows["mount_1"][2] == "casing, ground"


@pytest.mark.parametrize("fmi", ["2.0", "3.0"])
def test_every_variable_is_listed(network, fmi):
    variables = native_table(network, 500.0, fmi)
    found = supplements(network, variables, fmi, documentation=False, reference=False)
    rows = {row[0].split(" ")[0]: row for row in section(found["documentation/index.html"].decode(), "variables").rows}
    for variable in variables:
        row = rows[variable.name]
        assert row[1].split(" ")[0] == (variable.unit or "")
        assert row[3] == variable.description
        if isinstance(variable.start, float):
            assert number(row[2]) == pytest.approx(variable.start, rel=1e-5)
        if variable.shape:
            assert str(list(variable.shape)) in row[0]


@pytest.mark.parametrize("fmi", ["2.0", "3.0"])
def test_what_is_said_belongs_to_this_version(network, fmi):
    text, other = Page(page(network, fmi, frequencies=F)).text, "3" if fmi == "2.0" else "2"
    assert f"FMI {fmi}" in text
    assert f"fmi{other}" not in text
    for word in {"2.0": ["fmi2SetRealInputDerivatives", "fmi2GetDirectionalDerivative"],
                 "3.0": ["fmi3IntermediateUpdate", "fmi3GetAdjointDerivative", "system.*"]}[fmi]:  # fmt: skip
        assert word in text
    for category, meaning in LOG_CATEGORIES.items():
        assert category in text
        assert meaning in text


def test_a_gear_mesh_source_is_explained(network):
    source = MeshSource("mesh.transmission_error", 1450.0, 23, (Tone("mesh.harmonic_1", 1.0, 0.0, 2e-6, 0.0),))
    assert "gear mesh source" not in page(network, frequencies=F)
    assert "mesh.speed" in section(page(replace(network, source=source), frequencies=F), "equations").text


@pytest.mark.parametrize("name", ["gearbox", ODD])
def test_the_page_needs_nothing_else(network, name):
    files = supplements(replace(network, name=name), native_table(network, 500.0), description=ODD, frequencies=F)
    html = files["documentation/index.html"].decode()
    read_page = Page(html)
    tags = {tag for tag, _ in read_page.tags}
    assert html.startswith("<!DOCTYPE html>")
    assert not tags & {"script", "link", "img", "iframe", "object", "embed", "base", "form"}
    assert not [a for _, attrs in read_page.tags for a in attrs if a == "src" or a.startswith("on")]
    assert "http" not in html
    assert "@import" not in html
    assert set(re.findall(r"url\((.)", html)) == {"#"}
    ids = read_page.values("id")
    assert len(ids) == len(set(ids))
    for target in read_page.values("href"):
        assert target[1:] in ids if target.startswith("#") else f"documentation/{target}" in {
            *files, "documentation/licenses/license.txt"
        }  # fmt: skip
    for reference in read_page.values("clip-path") + read_page.values("aria-labelledby"):
        assert re.sub(r"url\(#(.*)\)", r"\1", reference) in ids
    assert read_page.text.count(ODD) == (3 if name == ODD else 1)  # title, heading and description


def test_light_and_dark(html):
    style = re.search(r"<style>(.*?)</style>", html, re.S)[1]
    assert "color-scheme: light dark" in style
    dark = re.search(r"prefers-color-scheme: dark\) \{(.*?)\n\}", style, re.S)[1]
    used = set(re.findall(r'<path[^>]* class="(c\d)"', html))
    assert used
    assert used <= set(re.findall(r"\.(c\d) \{", dark))


def test_odd_names_do_not_spoil_any_file(network):
    for content in (
        files := supplements(replace(network, name=ODD), native_table(network, 500.0), description=ODD)
    ).values():
        assert content
    for name, content in files.items():
        if name.endswith((".xml", ".exp", ".svg")):
            ET.fromstring(content)
    assert ODD in ET.fromstring(files["extra/org.fmi-standard.fmi-ls-ref/sweep.exp"]).get("name")
    assert ODD in files["documentation/fmi-ls-ref.txt"].decode()


def test_machines_without_bearings_or_reference(network):
    mounts = replace(network, paths=())
    variables = native_table(mounts, 500.0)
    files = supplements(mounts, variables, reference=False, frequencies=F)
    html = files["documentation/index.html"].decode()
    Page(html)
    assert "Power flow</h2>" not in html
    assert "Forces on the receivers, uy, per unit of mesh.transmission_error" in read(html)
    assert not [name for name in files if "ls-ref" in name]
    assert "fmi-ls-ref" not in html


def test_machines_without_damping(modal_model):
    """Nothing dissipates, so no power flows; transfers are drawn up to the resonances, where they have no end."""
    joints = tuple(replace(joint, damping=0.0 * joint.damping) for joint in modal_model.joints)
    undamped = replace(modal_model, joints=joints, modal_damping={"gear_train": 0.0})
    figures = read(page(undamped))
    forces = figures["Forces on the receivers, uy, per unit of mesh.transmission_error"]
    expected = frequency_response(undamped, 2 * np.pi * F, [undamped.outputs[0]], [undamped.loads[0]])[:, 0, 0]
    f, level = forces["bearing_1.force_uy"]
    natural = natural_frequencies(undamped)
    apart = abs(F[:, None] / natural[natural > 0] - 1).min(axis=1) > 0.02
    assert apart.sum() > 6
    np.testing.assert_allclose(np.interp(F, f, level)[apart], 20 * np.log10(abs(expected[apart])), atol=2.0)
    assert level.max() < 20 * np.log10(abs(expected).max()) + 80


def test_same_model_same_bytes_in_any_process(network):
    code = (
        "import hashlib, sys\n"
        f"sys.path[:0] = {[str(Path(__file__).parent), *sys.path]!r}\n"
        "from fmu_networks import gearbox\n"
        "from gearpath.fmu.native_table import native_table\n"
        "from gearpath.fmu.supplements import supplements\n"
        "n = gearbox()\n"
        "files = supplements(n, native_table(n, 500.0))\n"
        "print(hashlib.sha256(repr(sorted(files.items())).encode()).hexdigest())"
    )
    found = {
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=env).stdout
        for env in ({"PYTHONHASHSEED": "1"}, {"PYTHONHASHSEED": "2", "OPENBLAS_NUM_THREADS": "1"})
    }
    assert len(found) == 1
    assert supplements(network, native_table(network, 500.0)) == supplements(gearbox(), native_table(gearbox(), 500.0))


def least(work):
    """Least processor time of a few runs, s."""
    times = []
    for _ in range(5):
        begin = time.process_time()
        work()
        times.append(time.process_time() - begin)
    return min(times)


def test_it_is_fast(modal_model):
    variables = native_table(modal_model, 1000.0)
    assert least(lambda: supplements(modal_model, variables, documentation=False, reference=False)) < 0.02
    assert least(lambda: supplements(modal_model, variables)) < 1.0


def test_file_stays_small(modal_model, tmp_path):
    extra = supplements(modal_model, native_table(modal_model, 1000.0))
    with_plots = export(modal_model, tmp_path / "a.fmu", frequency=1000.0, extra_files=extra).stat().st_size
    assert with_plots < 1_000_000
