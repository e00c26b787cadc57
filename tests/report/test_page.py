"""The page as a file: complete, on its own, well formed, the same every time, and nothing where it fails."""

import json
import os
import subprocess
import sys

import pytest
from report_reader import MODEL, Reader, gearbox, mounts_only

import gearpath as gp
from gearpath.errors import GearpathError, InputError, MissingExtraError
from gearpath.report.page import figure_data, write_report

PARTS = "findings model natural ratio-section path-section ranking-section balance-section bode-section"
SECTIONS = [*PARTS.split(), "validation", "reproduce", "conventions"]


def test_every_section_is_there_and_says_something(page):
    found = [attrs["id"] for tag, attrs in page.tags if tag == "section"]
    assert found == SECTIONS
    assert all(len(page.of(section)) > 40 for section in SECTIONS)


def test_contents_lead_to_every_section(page):
    links = [attrs["href"] for tag, attrs in page.tags if tag == "a"]
    assert links == [f"#{section}" for section in SECTIONS]


def test_ids_are_unique_and_labels_refer_to_them(page):
    ids = [attrs["id"] for _, attrs in page.tags if "id" in attrs]
    assert len(ids) == len(set(ids))
    assert {attrs["aria-labelledby"] for _, attrs in page.tags if "aria-labelledby" in attrs} <= set(ids)


def test_nothing_is_fetched(page, written):
    assert not [tag for tag, _ in page.tags if tag in ("link", "img", "iframe", "object", "embed", "base", "form")]
    assert not [attrs for _, attrs in page.tags if {"src", "srcset", "data", "action"} & set(attrs)]
    assert not [attrs for _, attrs in page.tags if "http" in attrs.get("href", "") + attrs.get("style", "")]
    assert not [text for text in page.within("style") if "url(" in text or "@import" in text]
    (policy,) = [attrs["content"] for tag, attrs in page.tags if attrs.get("http-equiv") == "Content-Security-Policy"]
    assert "default-src 'none'" in policy
    assert "http" not in policy
    assert written.read_bytes().count(b"<script") >= 3


def test_every_plot_has_its_data_and_a_description(page):
    boxes = {attrs["id"]: attrs for _, attrs in page.tags if attrs.get("class") == "plot"}
    assert set(boxes) == set(page.figures) == {"ratio", "paths", "ranking", "balance", "shares"}
    assert all(len(attrs["aria-label"]) > 30 for attrs in boxes.values())
    for traces in page.figures.values():
        assert all(len(trace["x"]) == len(trace["y"]) for trace in traces)


def test_the_rows_of_every_table_are_as_wide_as_its_head(page):
    depth, width, count = 0, [], 0
    for tag, attrs in page.tags:
        if tag == "thead":
            width, depth = [], 1
        elif tag == "tbody":
            depth = 2
        elif tag == "section":
            depth = 0
        elif depth == 1 and tag == "th":
            width.append(attrs.get("class"))
        elif depth == 2 and tag in ("th", "td") and attrs.get("scope") == "rowgroup":
            assert int(attrs["colspan"]) == len(width)
            count += 1
    assert count == 5  # bands of the ranking


def test_the_model_is_repeated_whole(page, model):
    (text,) = [text for text in page.within("details") if text.lstrip().startswith("{")]
    assert json.loads(text) == json.loads(json.dumps(model.to_dict()))


def test_two_writes_give_the_same_bytes(model, written, tmp_path):
    assert write_report(model, tmp_path / "again.html").read_bytes() == written.read_bytes()


def test_another_process_gives_the_same_bytes(written, tmp_path):
    code = (
        "import sys, gearpath as gp; from gearpath.report.page import write_report; "
        "write_report(gp.load(sys.argv[1]).replace({'frequency.points': 120}), sys.argv[2])"
    )
    target = tmp_path / "other.html"
    environment = {**os.environ, "PYTHONHASHSEED": "7"}
    subprocess.run([sys.executable, "-c", code, str(MODEL), str(target)], check=True, env=environment)
    assert target.read_bytes() == written.read_bytes()


def test_names_are_escaped(read):
    name = 'a <b>&amp; </script><script>alert("x")</script> \\'
    model = gp.Model.from_dict({**gearbox().to_dict(), "name": name}, file='odd <i> & "file".toml')
    page = read(model)
    assert [tag for tag, _ in page.tags].count("b") == [tag for tag, _ in page.tags].count("i") == 0
    assert [tag for tag, _ in page.tags].count("script") == 3
    assert "".join(page.within("title")).startswith(name)
    assert name in "".join(page.within("h1"))
    assert 'odd <i> & "file".toml' in "".join(page.within("code"))


def test_data_are_safe_within_a_script_element():
    from gearpath.report.layout import Figure

    text = figure_data([Figure("k", "", "", [{"x": [1.0], "name": "</script>\u2028<!--"}], {"height": 1})])
    assert "<" not in text
    assert "\u2028" not in text
    assert json.loads(text)["figures"]["k"]["data"][0] == {"x": 0, "name": "</script>\u2028<!--"}


def test_equal_abscissae_are_stored_once(written):
    text = written.read_text(encoding="utf-8")
    grids = json.loads(text.split('id="figure-data">')[1].split("</script>")[0])["grids"]
    assert len(grids) == len({json.dumps(grid) for grid in grids})
    assert sum(len(grid) == 120 for grid in grids) == 1


def test_progress_is_told(tmp_path):
    told = []
    write_report(gearbox(5), tmp_path / "page.html", progress=told.append)
    assert len(told) >= 3
    assert str(tmp_path) in told[-1]


def test_folders_are_made_and_an_older_page_is_replaced(model, tmp_path):
    target = tmp_path / "new" / "deep" / "page.html"
    for text in ("", "old"):
        if text:
            target.write_text(text)
        assert write_report(model, str(target)) == target
        assert [item.name for item in target.parent.iterdir()] == ["page.html"]
        assert len(target.read_bytes()) > 1_000_000


def test_a_directory_is_not_replaced(model, tmp_path):
    with pytest.raises(InputError, match="is a directory"):
        write_report(model, tmp_path)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("place", ["file.txt/page.html", "file.txt/deep/page.html"])
def test_a_file_is_no_folder_and_that_is_said_before_the_work(model, tmp_path, place):
    (tmp_path / "file.txt").write_text("kept")
    told = []
    with pytest.raises(GearpathError, match=r"file\.txt is not a directory"):
        write_report(model, tmp_path / place, progress=told.append)
    assert told == []
    assert [(item.name, item.read_text()) for item in tmp_path.iterdir()] == [("file.txt", "kept")]


def test_a_failing_write_leaves_the_old_page_and_no_other_file(model, tmp_path, monkeypatch):
    target = tmp_path / "page.html"
    target.write_text("old")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(type(target), "replace", full)
    with pytest.raises(GearpathError, match="No space left"):
        write_report(model, target)
    assert [(item.name, item.read_text()) for item in tmp_path.iterdir()] == [("page.html", "old")]


@pytest.mark.skipif(not os.path.isdir("/proc/self"), reason="needs a place that even root cannot write")
def test_an_unwritable_place(model):
    with pytest.raises(GearpathError, match="cannot be written"):
        write_report(model, "/proc/gearpath/page.html")


@pytest.mark.parametrize(("library", "modules"), [("plotly", ["plotly", "plotly.offline"]), ("jinja2", ["jinja2"])])
def test_a_missing_library_is_named(model, tmp_path, monkeypatch, library, modules):
    for module in modules:
        monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(MissingExtraError, match=rf"{library}.*gearpath\[report\]"):
        write_report(model, tmp_path / "page.html")
    assert list(tmp_path.iterdir()) == []


def test_the_package_can_be_imported_without_its_libraries():
    code = (
        "import sys\n"
        "for name in ('plotly', 'plotly.offline', 'jinja2', 'markupsafe'): sys.modules[name] = None\n"
        "import gearpath as gp\n"
        "from gearpath.report import write_report\n"
        "try: write_report(gp.load(sys.argv[1]), 'nowhere.html')\n"
        "except gp.MissingExtraError: print('named')\n"
    )
    done = subprocess.run([sys.executable, "-c", code, str(MODEL)], check=True, capture_output=True, text=True)
    assert done.stdout.strip() == "named"


def test_without_bearings_the_page_is_whole(read):
    page = read(mounts_only())
    assert [attrs["id"] for tag, attrs in page.tags if tag == "section"] == SECTIONS
    assert set(page.figures) == {"balance", "shares"}
    assert "no joint of kind bearing" in page.of("findings")
    assert "no paths" in page.of("ratio-section")
    assert "α" not in page.of("natural")
    assert not {"nan", "not a number"} & set(page.of("balance-section").lower().split())


def test_reader_notices_mismatched_tags():
    with pytest.raises(AssertionError, match="</p> closes <b>"):
        Reader("<p><b></p>")
