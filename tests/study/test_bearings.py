"""Bearings at work: against a sum over the balls of their own, closed forms, statics and powers of the load."""

import warnings

import numpy as np
import pytest
from ball_sum import SHAPES, Balls, pushed, stiffness

import gearpath as gp
from gearpath.errors import InputError
from gearpath.study import bearings as record
from gearpath.study.bearings import FACTORS, curve_over, elements, measure
from gearpath.study.mounted_bearings import study_machine
from gearpath.study.single_bearing import Duty, arranged, study


def case(designation, load=None, displacement=None, *, phases=False, **more):
    pair = {key: more.pop(key) for key in ("mirrored", "arrangement", "distance") if key in more}
    bearing = arranged(gp.catalogue_bearing(designation), **pair)
    return study(designation, bearing, Duty(load or {}, displacement or {}, **more), phases=phases)


def close(K, expected, rtol=1e-9):
    size = np.sqrt(np.diag(expected))
    scale = np.outer(size, size)
    np.testing.assert_allclose(
        K / np.where(scale > 0, scale, 1.0), expected / np.where(scale > 0, scale, 1.0), atol=rtol
    )


LOADS = [
    ("6205-like", {"ux": 800.0, "uy": -300.0}),
    ("7210B-like", {"ux": 1000.0, "uz": 1500.0}),
    ("7210B-like", {"ux": 300.0, "uy": 900.0, "uz": 4000.0, "rx": 8.0, "ry": -15.0}),
]


@pytest.mark.parametrize(("designation", "load"), LOADS)
def test_state_is_what_the_balls_add_up_to(designation, load):
    found = case(designation, load)
    row = Balls(SHAPES[designation])
    q = found.state.displacement
    names = ("ux", "uy", "uz", "rx", "ry")
    carried = row.load(q[:5]).real
    for k, name in enumerate(names):
        if name in load:
            np.testing.assert_allclose(carried[k], load[name], rtol=1e-8)
        else:
            assert q[k] == 0.0
    np.testing.assert_allclose(found.state.load[:5], carried, atol=1e-8 * abs(carried).max())
    close(found.state.stiffness, stiffness([row], q))


def test_a_preloaded_pair_is_two_rows_that_were_pushed():
    found = case("7210B-like", {"uy": 700.0, "uz": -200.0}, arrangement="back_to_back", distance=0.03, preload=300.0)
    shape = SHAPES["7210B-like"]
    push = pushed(Balls(shape), 300.0)
    rows = [Balls(shape, 1.0, -0.015, push), Balls(shape, -1.0, 0.015, -push)]
    q = found.state.displacement
    np.testing.assert_allclose(sum(row.load(q[:5]) for row in rows).real[[1, 2]], [700.0, -200.0], rtol=1e-8)
    close(found.state.stiffness, stiffness(rows, q))
    assert [item.row for item in elements(found.bearing, found.state)] == [1] * 15 + [2] * 15


def test_pure_axial_load_has_its_closed_form():
    found = case("7210B-like", {"uz": 3000.0})
    row = Balls(SHAPES["7210B-like"])
    uz = found.state.displacement[2]
    a = np.arctan(np.tan(row.a0) + uz / (row.A0 * np.cos(row.a0)))
    A = row.A0 * np.cos(row.a0) / np.cos(a)
    Q = row.Kn * (A - row.A0) ** 1.5
    slope, across, s, c = 1.5 * Q / (A - row.A0), Q / A, np.sin(a), np.cos(a)
    K = found.state.stiffness
    np.testing.assert_allclose(15 * Q * s, 3000.0, rtol=1e-9)
    np.testing.assert_allclose(K[2, 2], 15 * (slope * s**2 + across * c**2), rtol=1e-9)
    np.testing.assert_allclose([K[0, 0], K[1, 1]], 7.5 * (slope * c**2 + across * s**2), rtol=1e-9)
    np.testing.assert_allclose([K[1, 3], -K[0, 4]], 7.5 * row.r * (slope - across) * s * c, rtol=1e-9)
    np.testing.assert_allclose([K[3, 3], K[4, 4]], row.r**2 * K[2, 2] / 2, rtol=1e-9)
    assert [item.contact_angle for item in elements(found.bearing, found.state)] == pytest.approx([a] * 15, rel=1e-9)
    assert np.count_nonzero(record.shown(K)) == 9


def test_weak_couplings_are_shown_and_rounding_is_not():
    K = np.diag([1e8, 1e8, 1e7, 1e4, 1e4, 0.0])
    K[0, 1] = K[1, 0] = 1.0  # 1e-8 of the diagonal
    K[2, 4] = K[4, 2] = 1e-4  # 3e-10
    found = record.shown(K)
    assert (found[0, 1], found[2, 4]) == (1.0, 0.0)
    assert np.count_nonzero(found) == 7
    assert record.couplings(K[None], 1e-9) == [(0, 1)]


@pytest.mark.parametrize(("designation", "load"), LOADS)
def test_elements_carry_the_load(designation, load):
    found = case(designation, load)
    r = Balls(SHAPES[designation]).r
    total = np.zeros(5)
    for item in elements(found.bearing, found.state):
        across, along = item.load * np.cos(item.contact_angle), item.load * np.sin(item.contact_angle)
        c, s = np.cos(item.position), np.sin(item.position)
        total += np.array([across * c, across * s, along, r * s * along, -r * c * along])
    for k, name in enumerate(("ux", "uy", "uz", "rx", "ry")):
        if name in load:
            np.testing.assert_allclose(total[k], load[name], rtol=1e-8)


def test_stiffness_of_rollers_goes_with_the_tenth_root_of_their_load():
    curve = case("30206-like", {"ux": 900.0, "uz": 700.0}).curve
    assert curve.unit == "N"
    np.testing.assert_allclose(curve.values, np.hypot(900.0, 700.0) * curve.factors)
    for k in record.diagonal(curve.stiffness):
        slopes = np.diff(np.log(curve.stiffness[:, k, k])) / np.diff(np.log(curve.values))
        np.testing.assert_allclose(slopes, 0.1, atol=1e-7)


def test_stiffness_of_lightly_loaded_balls_goes_with_the_cube_root():
    curve = case("7210B-like", {"uz": 1e-3}).curve
    slopes = np.diff(np.log(curve.stiffness[:, 2, 2])) / np.diff(np.log(curve.values))
    np.testing.assert_allclose(slopes, 1.0 / 3.0, atol=1e-3)


def test_curve_passes_through_the_state_and_through_other_loads():
    found = case("7210B-like", {"ux": 1000.0, "uz": 1500.0})
    factors = found.curve.factors.tolist()
    assert [factors[k] for k in found.curve.rows()] == list(FACTORS)
    np.testing.assert_allclose(found.curve.stiffness[factors.index(1.0)], found.state.stiffness, rtol=1e-12)
    thrice = case("7210B-like", {"ux": 3000.0, "uz": 4500.0})
    q = thrice.state.displacement
    close(found.curve.stiffness[factors.index(3.0)], stiffness([Balls(SHAPES["7210B-like"])], q))


def test_preload_alone_is_an_axial_load():
    pressed, pushed_ = case("7210B-like", preload=500.0), case("7210B-like", {"uz": 500.0})
    assert pressed.over == "preload"
    np.testing.assert_allclose(pressed.curve.values, pushed_.curve.values)
    for one, other in zip(pressed.curve.stiffness, pushed_.curve.stiffness):
        close(one, other)


def test_displacement_is_taken_as_it_is():
    q = {"ux": 8e-6, "uz": 1.5e-5, "ry": 1e-4}
    found = case("7210B-like", displacement=q)
    row = Balls(SHAPES["7210B-like"])
    vector = [8e-6, 0.0, 1.5e-5, 0.0, 1e-4]
    np.testing.assert_allclose(found.state.load[:5], row.load(vector).real, rtol=1e-9, atol=1e-9)
    close(found.curve.stiffness[found.curve.factors == 2.0][0], stiffness([row], [2 * u for u in vector]))
    assert found.curve.unit == "1"  # metres and radians have no common size


def test_phases_turn_the_cage_through_one_distance():
    q = {"ux": 5e-6, "uy": 2e-6}
    found = case("6205-like", displacement=q, phases=True).phases
    each = [
        stiffness([Balls(SHAPES["6205-like"], turned=2.0 * np.pi * k / 16 / 9)], [5e-6, 2e-6, 0, 0, 0])
        for k in range(16)
    ]
    close(found.average, np.mean(each, axis=0))
    low, high = found.diagonal
    diagonals = np.array([np.diag(K) for K in each])
    np.testing.assert_allclose(low, diagonals.min(axis=0), rtol=1e-9)
    np.testing.assert_allclose(high, diagonals.max(axis=0), rtol=1e-9)
    assert (high[:5] > low[:5]).all()


def test_what_cannot_be_carried_is_a_gap():
    bearing = gp.catalogue_bearing("6205-like")

    def at(factor):
        if factor > 1.0:
            raise InputError("comes apart")
        return bearing.equilibrium({"ux": 100.0 * factor})

    curve = curve_over("load", 100.0, "N", at)
    assert np.isnan(curve.stiffness).all(axis=(1, 2)).tolist() == [f > 1.0 for f in curve.factors]
    assert record.diagonal(curve.stiffness) == [0, 1, 2, 3, 4]
    assert (1, 3) not in record.couplings(curve.stiffness)


def test_units_of_blocks_and_sizes():
    assert [record.unit(*pair) for pair in ((0, 1), (2, 3), (3, 2), (4, 3))] == ["N/m", "N/rad", "N m/m", "N m/rad"]
    assert measure("load", {"ux": 3.0, "uz": -4.0, "rx": 0.0}) == (5.0, "N")
    assert measure("load", {"rx": -2.0}) == (2.0, "N m")
    assert measure("displacement", {"ux": 1e-6, "rx": 1e-5}) == (1.0, "1")


def test_speed_is_judged_and_warns_nobody():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        slow, fast = (case("7210B-like", {"uz": 100.0}, speed=speed) for speed in (100.0, 9000.0))
    assert slow.state.notes == ()
    assert "9000 rev/min" in fast.state.notes[0]


@pytest.mark.parametrize(
    ("words", "arguments"),
    [
        ("both given", {"load": {"ux": 1.0}, "displacement": {"uz": 1e-6}}),
        ("no degree of freedom 'x'", {"displacement": {"x": 1e-6}}),
        ("turns freely", {"load": {"rz": 1.0}}),
        ("no rolling element", {}),
        ("no rolling element", {"displacement": {"uz": -1e-5}}),
        ("negative", {"load": {"uz": 1.0}, "preload": -1.0}),
        ("finite", {"load": {"uz": 1.0}, "speed": float("inf")}),
    ],
)
def test_refusals(words, arguments):
    with pytest.raises(InputError, match=words):
        case("7210B-like", **arguments)


@pytest.fixture(scope="module")
def machine():
    data = gp.load("models/gearbox.toml").to_dict()
    for name in (f"bearing_{k}" for k in (1, 2, 3, 4)):
        joint = data["joints"][name]
        del joint["stiffness"]
        joint["catalogue"] = "6205-like"
    data["joints"]["bearing_4"]["load"] = {"uy": 800.0}
    data["operation"] = {"torque": 100.0}
    return gp.Model.from_dict(data)


def test_machine_shares_the_tooth_force_among_its_bearings(machine):
    cases = {item.name: item for item in study_machine(machine.system)}
    force = 100.0 / 0.04975  # N, on the line of action
    carried = sum(cases[name].state.load[1] for name in ("bearing_1", "bearing_2"))
    np.testing.assert_allclose(carried, -force, rtol=1e-6)
    assert [item.over for item in cases.values()] == ["torque", "torque", "torque", "load"]
    for item in cases.values():
        row = Balls(SHAPES["6205-like"])
        close(item.state.stiffness, stiffness([row], item.state.displacement))


def test_machine_curves_go_with_torque_and_own_loads_with_theirs(machine):
    cases = {item.name: item for item in study_machine(machine.system)}
    twice = gp.operating_point(machine.replace({"operation.torque": 200.0}))["bearing_1"]
    at = cases["bearing_1"].curve.factors == 2.0
    assert cases["bearing_1"].curve.values[at] == 200.0
    close(cases["bearing_1"].curve.stiffness[at][0], stiffness([Balls(SHAPES["6205-like"])], twice.displacement))
    own = cases["bearing_4"].curve
    np.testing.assert_allclose(own.values, 800.0 * own.factors)
    alone = case("6205-like", {"uy": 2400.0}).state.stiffness
    close(own.stiffness[own.factors == 3.0][0], alone)


def test_machine_phases_keep_the_tooth_force(machine):
    (found,) = study_machine(machine.system, "bearing_4", phases=True)
    alone = case("6205-like", {"uy": 800.0}, phases=True)
    for one, other in zip(found.phases.stiffness, alone.phases.stiffness):
        close(one, other)


def test_machine_without_rolling_bearings_or_with_another_joint(machine):
    with pytest.raises(InputError, match="no bearing given by geometry"):
        study_machine(gp.load("models/gearbox.toml").system)
    with pytest.raises(InputError, match=r"'mount_1'.*bearing_1"):
        study_machine(machine.system, "mount_1")
