"""A nonlinear FMU against its closed form, in both versions, by its own derivatives and by differences."""

import inspect
import re
import zipfile

import numpy as np
import pytest
from pendulum import STOP, Case
from scipy.optimize import root

import gearpath as gp
from gearpath.fmu.linearizing.point import Point

POINTS = {
    "hanging": Case(),
    "swinging": Case(th=0.3, w=0.7, h=0.5, u=1.2, F=3.0, q=0.4),
    "at the stop": Case(th=0.8, w=-2.0, h=3.0, u=-4.0, F=-7.0, q=1.5),
    "far round": Case(th=-41.0, w=90.0, h=1e-3, u=1e3, F=1e-3, q=1e-6),
}
NAMES = {2: ("bob.th", "bob.w", "h"), 3: ("state[1]", "state[2]", "state[3]")}


def at(case, fmi):
    """Start values and states of an operating point."""
    starts = {"u": case.u, "F": case.F} if fmi == 2 else {"load": [case.u, case.F]}
    return {"start_values": {**starts, "q": case.q}, "states": dict(zip(NAMES[fmi], (case.th, case.w, case.h)))}


@pytest.mark.parametrize("point", POINTS)
@pytest.mark.parametrize(("fmi", "derivatives"), [(2, 0), (2, 1), (3, 0), (3, 1)])
def test_matrices_are_the_closed_form(pendulums, fmi, derivatives, point):
    case = POINTS[point]
    found = gp.linearize(pendulums(fmi, derivatives), **at(case, fmi))
    assert found.method == ("derivatives" if derivatives else "differences")
    tolerance = 1e-14 if derivatives else 1e-9
    for matrix, expected in zip((found.A, found.B, found.C[:4], found.D[:4]), case.matrices(), strict=True):
        scale = abs(expected).max(axis=1, keepdims=True)
        assert np.all(abs(matrix - expected) <= tolerance * scale)
    assert found.warnings == ()
    assert found.error < 1e-6


@pytest.mark.parametrize("step", [1.0, 1e-2, 1e-4, 1e-6])
def test_the_error_knows_what_rounding_takes(pendulums, step):
    """The smaller the first step, the fewer digits: never more of them lost than `error` says."""
    case = POINTS["swinging"]
    found = gp.linearize(pendulums(), method="differences", relative_step=step, **at(case, 2))
    expected = np.hstack(case.matrices()[:2])
    true = abs(np.hstack([found.A, found.B]) - expected) / abs(expected).max(axis=1, keepdims=True)
    assert true.max() <= 10.0 * found.error < 1e-6


def test_differences_that_vanish_show_in_the_error(pendulums, monkeypatch):
    """Steps that rounding swallows leave rows of zeros, which are not right because nothing moves."""
    monkeypatch.setattr("gearpath.fmu.linearizing.task._SMALLEST", 0.0)
    with pytest.warns(UserWarning, match="do not converge"):
        found = gp.linearize(pendulums(), method="differences", relative_step=1e-30, **at(POINTS["swinging"], 2))
    assert not found.A.any()
    assert found.error > 1.0


@pytest.mark.parametrize("fmi", [2, 3])
def test_operating_point_is_told(pendulums, fmi):
    """x0, u0, y0 and dx0: the tangent at a neighbouring point meets the model to second order."""
    case = POINTS["swinging"]
    found = gp.linearize(pendulums(fmi), **at(case, fmi))
    np.testing.assert_allclose(found.x0, [case.th, case.w, case.h])
    np.testing.assert_allclose(found.u0, [case.u, case.F, case.q])
    np.testing.assert_allclose(found.dx0, case.slope(case.th, case.w, case.h, case.u, case.F, case.q), rtol=1e-14)
    assert found.y0[0] == pytest.approx(0.5 * np.sin(0.3), rel=1e-11)
    rest = []
    for d in (1e-3, 5e-4):
        x, u = found.x0 + d * np.array([1, -2, 0.5]), found.u0 + d * np.array([3, 1, -1])
        rest.append(case.slope(*x, *u) - (found.dx0 + found.A @ (x - found.x0) + found.B @ (u - found.u0)))
    assert abs(rest[1]).max() < 1e-5
    np.testing.assert_allclose(rest[0][1:] / rest[1][1:], 4.0, rtol=5e-3)


@pytest.mark.parametrize("fmi", [2, 3])
def test_discrete_variables_fit_the_operating_point(pendulums, fmi):
    """The stop takes hold in the second round of the event iteration, and stays as it is beside the point."""
    path = pendulums(fmi)
    near = 1e-6
    beyond, before = (
        gp.linearize(path, states={NAMES[fmi][0]: STOP + side}, method="differences") for side in (near, -near)
    )
    for found, case in ((beyond, Case(th=STOP + near)), (before, Case(th=STOP - near))):
        np.testing.assert_allclose(found.A, case.matrices()[0], rtol=1e-9)
    assert beyond.A[1, 0] - before.A[1, 0] == pytest.approx(-Case.k, rel=1e-4)


@pytest.mark.parametrize("fmi", [2, 3])
def test_after_a_run_through_an_event_it_is_at_the_equilibrium(pendulums, fmi):
    case = Case(u=12.0, q=0.1, c=8.0)
    start = at(case, fmi)["start_values"] | {"c": 8.0}
    found = gp.linearize(pendulums(fmi, 1), start_values=start, time=60.0)
    rest = root(lambda x: case.slope(*x, case.u, case.F, case.q), [1.0, 0.0, 0.3], tol=1e-13).x
    assert rest[0] > STOP
    assert found.time == 60.0
    np.testing.assert_allclose(found.x0, rest, atol=1e-5)
    assert abs(found.dx0).max() < 1e-5
    expected = Case(*found.x0, u=case.u, q=case.q, c=8.0).matrices()
    np.testing.assert_allclose(found.A, expected[0], rtol=1e-12)


def test_start_values_of_all_types(pendulums):
    heavy = gp.linearize(pendulums(2), start_values={"planets": 3, "m": 4.0})
    np.testing.assert_allclose(heavy.A, Case(g=3 * 9.81).matrices()[0], atol=1e-9)
    np.testing.assert_allclose(heavy.B, Case(m=4.0).matrices()[1], atol=1e-9)
    floating = gp.linearize(pendulums(3), start_values={"gravity_on": False, "label": "fine", "planets": 2})
    np.testing.assert_allclose(floating.A, Case(g=0.0).matrices()[0], atol=1e-9)


def test_inputs_do_not_leave_their_range(pendulums, monkeypatch):
    """q may not be negative: one side only, where flow = q + q^2 + h has curvature."""
    tried, put = [], Point.put
    monkeypatch.setattr(Point, "put", lambda self, known: (tried.append(known[-1]), put(self, known)))
    found = gp.linearize(pendulums(2), inputs="q", outputs="flow", method="differences")
    assert min(tried) == 0.0 < max(tried)
    assert found.D[0, 0] == pytest.approx(1.0, abs=1e-9)
    assert found.B[2, 0] == pytest.approx(1.0, abs=1e-12)


def test_what_does_not_depend_is_exactly_zero(pendulums):
    """Declared dependencies: no loop through D that is only rounding."""
    found = gp.linearize(pendulums(2), method="differences", **at(POINTS["swinging"], 2))
    rows = dict(zip(found.output_labels, found.D))
    assert [name for name, row in rows.items() if row.any()] == ["T", "P", "flow"]
    assert rows["T"][1] == pytest.approx(np.sin(0.3), rel=1e-9)
    assert np.flatnonzero(rows["T"]).tolist() == [1]


def test_signals_are_chosen_by_name(pendulums):
    found = gp.linearize(pendulums(2, 1), inputs=["F", "u"], outputs=["angle", "T", "bob.w"], states={"bob.th": 0.2})
    assert (found.input_labels, found.output_labels) == (["F", "u"], ["angle", "T", "bob/w"])
    _, B, C, D = Case(th=0.2).matrices()
    np.testing.assert_array_equal(found.C[[0, 2]], [[1, 0, 0], [0, 1, 0]])
    np.testing.assert_allclose(found.C[1], C[1], rtol=1e-14)
    np.testing.assert_allclose(found.B, B[:, [1, 0]], rtol=1e-14)
    np.testing.assert_allclose(found.D[1], D[1, [1, 0]], rtol=1e-14)


def test_arrays_are_taken_element_by_element(pendulums):
    path = pendulums(3, 1)
    whole = gp.linearize(path, states={"state[1]": 0.2})
    assert whole.input_labels == ["load[1]", "load[2]", "q"]
    assert whole.output_labels == ["out[1]", "out[2]", "out[3]", "flow"]
    part = gp.linearize(path, inputs=["load[2]"], outputs=["out[2]", "state"], states={"state[1]": 0.2})
    assert part.output_labels == ["out[2]", "state[1]", "state[2]", "state[3]"]
    np.testing.assert_array_equal(part.B, whole.B[:, [1]])
    np.testing.assert_array_equal(part.C, np.vstack([whole.C[1], np.eye(3)]))
    np.testing.assert_array_equal(part.D, [[whole.D[1, 1]], [0], [0], [0]])


def test_without_inputs_outputs_or_states(pendulums, tmp_path):
    """Of an autonomous FMU the poles are left; one without outputs shows its states; one without states is a matrix."""
    alone = gp.linearize(pendulums(2), inputs=[], outputs=["h", "x"])
    assert alone.B.shape == (3, 0)
    np.testing.assert_allclose(np.sort_complex(alone.poles()), np.sort_complex(np.linalg.eigvals(Case().matrices()[0])))

    def changed(name, pattern):
        with zipfile.ZipFile(pendulums(2)) as old, zipfile.ZipFile(tmp_path / name, "w") as new:
            text = re.sub(pattern, "", old.read("modelDescription.xml").decode(), flags=re.DOTALL)
            new.writestr("modelDescription.xml", text)
            library = next(entry for entry in old.namelist() if entry.endswith(".so"))
            new.writestr(library, old.read(library))
        return tmp_path / name

    silent = gp.linearize(changed("silent.fmu", ' causality="output"|<Outputs>.*</Outputs>'))
    assert silent.output_labels == silent.state_labels
    np.testing.assert_allclose(silent.C, np.eye(3), rtol=0.0, atol=1e-12)
    static = gp.linearize(changed("static.fmu", '<Derivatives>.*</Derivatives>| derivative="."'), outputs=["flow", "x"])
    assert static.nstates == 0
    np.testing.assert_allclose(static.D, [[0, 0, 1], [0, 0, 0]], atol=1e-9)


def test_names_and_units(pendulums):
    found = gp.linearize(pendulums(2, 1))
    assert found.name == "Test/Pendulum"
    assert found.state_labels == ["bob/th", "bob/w", "h"]
    assert found.input_units == {"u": "N.m", "F": "N", "q": ""}
    assert found.output_units["angle"] == "rad"
    assert found.state_units == {"bob/th": "rad", "bob/w": "rad/s", "h": "m"}
    text = inspect.getdoc(found)
    assert "bob/w (rad/s)" in text
    assert "q (1)" in text


@pytest.mark.parametrize("fmi", [2, 3])
def test_wrong_derivatives_are_noticed(pendulums, fmi):
    with pytest.warns(UserWarning, match="directional derivatives and differences are 2 apart"):
        found = gp.linearize(pendulums(fmi, 2), **at(POINTS["swinging"], fmi))
    assert (found.method, len(found.warnings)) == ("derivatives", 1)
    assert found.error == pytest.approx(2.0, rel=1e-6)


@pytest.mark.parametrize("fmi", [2, 3])
def test_refused_derivatives_are_replaced(pendulums, fmi):
    case, path = POINTS["swinging"], pendulums(fmi, 3)
    with pytest.warns(UserWarning, match="no derivatives today"):
        found = gp.linearize(path, **at(case, fmi))
    assert found.method == "differences"
    np.testing.assert_allclose(found.A, case.matrices()[0], atol=1e-9)
    with pytest.raises(gp.InputError, match="no derivatives today"):
        gp.linearize(path, method="derivatives")


def test_a_kink_is_noticed(pendulums):
    """sqrt h at h = 0 has no derivative."""
    with pytest.warns(UserWarning, match=r"der\(h\) by h do not converge"):
        found = gp.linearize(pendulums(2), states={"h": 0.0}, method="differences")
    assert found.error > 1e-3
