import sys
from pathlib import Path

import pytest

pytest.importorskip("plotly")
pytest.importorskip("jinja2")

sys.path.insert(0, str(Path(__file__).parent))

from report_reader import Reader, gearbox

import gearpath as gp
from gearpath.report.page import write_report


@pytest.fixture(scope="session")
def model():
    return gearbox()


@pytest.fixture(scope="session")
def flow(model):
    return gp.power_flow(model)


@pytest.fixture(scope="session")
def written(model, tmp_path_factory):
    return write_report(model, tmp_path_factory.mktemp("report") / "report.html")


@pytest.fixture(scope="session")
def page(written):
    return Reader(written.read_text(encoding="utf-8"))


@pytest.fixture
def read(tmp_path):
    """Writes a report and reads it."""

    def call(model, **more):
        return Reader(write_report(model, tmp_path / "page.html", **more).read_text(encoding="utf-8"))

    return call
