"""Verdicts follow from the figures: they turn when the machine does."""

import numpy as np
import pytest

from gearpath.study.paper import completeness, fig08, fig09, fig11, fig15
from gearpath.study.paper.claims import judge, number_of, places
from gearpath.study.paper.machine import bearings, masked_bearings, scaled_joints, shipped


@pytest.fixture(scope="module")
def mirrored():
    """Couplings of opposite sign at the two ends of every shaft: symmetric, and no moment power."""
    turned = [[1.2e8, -1.8e6], [-1.8e6, 6.0e4]]
    return shipped().replace({f"joints.bearing_{k}.stiffness": turned for k in (2, 4)})


@pytest.mark.parametrize(
    ("values", "verdict", "outcome"),
    [
        ([1.0, 1.0, 1.0, 1.0], "holds", "holds"),
        ([0.0, 0.0, 0.0, 0.0], "does not hold", "fails"),
        ([1.0, 1.0, 0.0, 1.0], "holds only at 0–2 and 3–5 kHz", "in part"),
        ([0.0, 1.0, 0.0, 0.0], "holds only at 1–2 kHz", "in part"),
        ([np.nan, 1.0, np.nan, 1.0], "holds only at 1–2 and 3–5 kHz", "in part"),
        ([np.nan] * 4, "does not hold", "fails"),
    ],
)
def test_verdict_names_the_bands(values, verdict, outcome):
    claim = judge("", "", values, lambda v: v >= 1.0)
    assert (claim.verdict, claim.outcome) == (verdict, outcome)


def test_figures_in_words():
    claim = judge("", "", [(1.234, 0.5), (-2.0, 0.0)], np.greater, ["a", "b"])
    assert claim.found == "a: 1.23 against 0.50 dB; b: −2.00 against 0.00 dB"
    assert claim.verdict == "holds only for a"
    assert [number_of(v) for v in (-0.001, -np.inf, np.inf, np.nan)] == ["0.00", "vanishes", "∞", "–"]
    assert places(["0–1 kHz", "1–2 kHz", "2–3 kHz", "3–5 kHz"]) == "at 0–5 kHz"


def test_hard_bearings_do_move_little():
    """The paper's explanation of Fig. 9a holds where bearings are stiff beside their neighbours."""
    model = shipped()
    hard = model.replace(scaled_joints(model, bearings(model), stiffness=1e4))
    verdicts = [
        next(claim for claim in fig09.study(machine).claims if "relative motion" in claim.says).outcome
        for machine in (model, hard)
    ]
    assert verdicts == ["fails", "holds"]


def test_no_discrepancy_where_there_was_no_coupling():
    model = shipped()
    bare = model.replace(masked_bearings(model, [[1.0, 0.0], [0.0, 0.0]]))
    claims = fig08.study(bare).claims
    assert [claim.outcome for claim in claims] == ["fails"] * 4
    assert claims[-1].found.startswith("0–1 kHz: – dB")


@pytest.mark.parametrize("module", [fig11, fig15])
def test_machine_without_moment_power(mirrored, module):
    """A shift along x keeps the middle plane a plane of symmetry; one along z does not."""
    study = module.study(mirrored)
    assert not study.effects[0].original.ratio("moment").any()
    assert study.effects[0].changed.ratio("moment").any() == (module is fig11)
    assert all(check.passed for check in study.checks)
    assert "no power flows" in study.figures[0].caption


def test_free_modes_alone_never_do_and_a_single_start_stagnates():
    static, few = completeness.study().claims
    ((lanczos, free),) = (item.values for item in static.items)
    assert lanczos < 25
    assert free == np.inf
    assert few.verdict == "does not hold"
    assert all(0.5 < item.values[0] < 2.0 for item in few.items[:2])  # about 1 dB with 4 and 9 vectors
