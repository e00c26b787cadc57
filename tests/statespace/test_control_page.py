"""What docs/control.md shows is run, and does what it says."""

import re
import warnings
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest

pytest.importorskip("control")
pytest.importorskip("fmpy")
mpl.use("Agg")
ROOT = Path(__file__).resolve().parents[2]


def test_the_page_runs(tmp_path, monkeypatch):
    (tmp_path / "models").symlink_to(ROOT / "models")
    monkeypatch.chdir(tmp_path)
    plt.close("all")  # what other tests left open
    page, scope = (ROOT / "docs" / "control.md").read_text(), {}
    blocks = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    with warnings.catch_warnings():
        warnings.simplefilter("error", UserWarning)  # interconnect warns of signals that are left over
        for block in blocks:
            exec(block, scope)
    assert len(blocks) == 5
    assert scope["small"].nstates < scope["plant"].nstates / 2
    assert scope["loop"].output_labels == ["mount_1/force_uy"]
    assert abs(scope["run"].outputs).max() > 0.1
    expected = scope["damped"](1j * scope["closed"].omega)
    assert abs(scope["closed"].frdata[0, 0] - expected).max() < 1e-8 * abs(expected).max()
    run = scope["run"].outputs.ravel()[1:]
    assert abs(np.array(scope["mount"]) - run).max() < 0.015 * abs(run).max()
    e = 1e-6 * np.sin(2 * np.pi * 400.0 * scope["t"])
    alone = scope["plant"]["mount_1/force_uy", "mesh/transmission_error"]
    open_ = scope["control"].forced_response(alone, scope["t"], e).outputs[1:]
    assert abs(open_ - run).max() > 0.3 * abs(run).max()  # the loop is no small matter
    line = plt.figure(1).axes[0].lines[0]
    assert (line.get_xdata()[0], line.get_xdata()[-1]) == pytest.approx((20.0, 5000.0))  # Hz, the whole axis
    plt.close("all")
    found, gp = scope["found"], scope["gp"]
    flow = gp.power_flow(scope["model"], [699.99, 700.01]).alpha.values
    assert found.D[1, 1] == pytest.approx(np.diff(flow)[0] / 0.02, rel=1e-5)
    assert abs(found.x0).max() > 0.0
    assert found.time == 0.005


def test_links_lead_somewhere():
    for target in re.findall(r"\]\(([^)#]+)\)", (ROOT / "docs" / "control.md").read_text()):
        assert target.startswith("http") or (ROOT / "docs" / target).exists(), target
