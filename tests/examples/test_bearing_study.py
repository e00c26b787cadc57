"""The bearing study: README against a fresh run, operating points against statics by hand, power balance."""

import json
import re
import runpy
import warnings
from math import cos, sin
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "examples" / "bearing_study"
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")
NAMES = ("deep groove", "angular contact, O", "angular contact, X", "cylindrical", "tapered, O", "tapered, X")

# Numbers of the model file: the normal tooth force on the wheel, by hand (right-hand pinion that turns about +z).
TORQUE, BASE_RADIUS, PRESSURE, BASE_HELIX = 100.0, 0.0311684, 0.362392, 0.266248
ACROSS = TORQUE / BASE_RADIUS
ON_WHEEL = ACROSS * np.array([sin(PRESSURE), cos(PRESSURE), -sin(BASE_HELIX) / cos(BASE_HELIX)])
PITCH_POINT = np.array([-0.05 + 0.1 / 3.0, 0.0, 0.0])  # 32 and 64 teeth on a centre distance of 100 mm
AXES = {"input": np.array([-0.05, 0.0, 0.0]), "output": np.array([0.05, 0.0, 0.0])}
SEATS = {"bearing_1": -0.050, "bearing_2": 0.070, "bearing_3": -0.0505, "bearing_4": 0.0695}
SHAFTS = {"input": (-1.0, ("bearing_1", "bearing_2")), "output": (1.0, ("bearing_3", "bearing_4"))}


@pytest.fixture(scope="module")
def example():
    return runpy.run_path(str(FOLDER / "bearing_study.py"))


@pytest.fixture(scope="module")
def cases(example):
    return example["study"]()


@pytest.fixture(scope="module")
def sweep(example):
    return example["torque_sweep"]()


def test_readme_has_the_words_and_numbers_of_a_fresh_run(example, cases, sweep):
    """Every number to 2 % or a unit of its last place: other machines round the last digits differently."""
    readme = (FOLDER / "README.md").read_text(encoding="utf-8")
    blocks = {words(block): block for block in readme.split("\n\n")}
    for part in example["text"](cases, sweep).split("\n\n"):
        assert words(part) in blocks, part
        for fresh, old in zip(NUMBER.findall(part), NUMBER.findall(blocks[words(part)]), strict=True):
            assert float(fresh) == pytest.approx(float(old), rel=0.02, abs=1.01 * last_place(old)), (fresh, old, part)


def words(text):
    return " ".join(NUMBER.sub("#", text).split())


def last_place(text):
    mantissa, _, exponent = text.partition("e")
    return 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


def test_conclusions_follow_from_the_numbers(example, cases):
    """What the statement says in words."""
    high = example["high"]
    strong = [case for name, case in cases.items() if name.startswith(("angular", "tapered"))]
    weak = [case for name, case in cases.items() if not name.startswith(("angular", "tapered"))]
    for part in ("diagonal", "radial"):
        assert min(high(case, part) for case in strong) > 1.7 * max(high(case, part) for case in weak)
    angular, tapered = strong[:2], strong[2:]
    mixed = "no force-moment coupling"
    assert min(high(case, mixed) for case in angular) > 1.5 * max(high(case, mixed) for case in tapered)
    assert all(high(case, mixed) < 0.6 * high(case, "diagonal") for case in tapered)
    for case in cases.values():
        flow = case.flows["full"]
        order = [name for name, _ in example["joints_ranked"](flow)]
        assert set(order[:2]) == {"bearing_1", "bearing_2"}
        assert dict(example["joints_ranked"](flow))["bearing_3"] < 0.0
        assert {path.split(".")[1] for path, _ in example["ranking"](flow)[:4]} <= {"ux", "uy"}
        assert not case.flows["radial"].path_alpha[example["is_moment"](flow)].any()


@pytest.mark.parametrize("name", NAMES)
def test_every_shaft_is_in_balance(cases, name):
    """Forces and moments of the bearings on each shaft against the tooth force at the pitch point."""
    states = cases[name].states
    for shaft, (sign, joints) in SHAFTS.items():
        force = sign * ON_WHEEL
        arm = PITCH_POINT - AXES[shaft]
        rest, turning = force.copy(), np.cross(arm, force)
        for joint in joints:
            load = states[joint].load
            rest -= load[:3]
            turning -= load[3:] + np.cross([0.0, 0.0, SEATS[joint]], load[:3])
        scale = np.linalg.norm(force)
        assert np.abs(rest).max() < 1e-9 * scale, (shaft, rest)
        assert np.abs(turning[:2]).max() < 1e-9 * scale * 0.1, (shaft, turning)


@pytest.mark.parametrize("name", NAMES)
def test_radial_loads_are_those_of_a_beam_on_two_supports(cases, name):
    """Two supports where the bearings' loads pass through the axis: seats, moved by tilting moment over radial force.

    A beam on the seats alone is statically determinate; its supports differ from the bearings by the tilting moments.
    """
    states = cases[name].states
    for shaft, (sign, joints) in SHAFTS.items():
        force = sign * ON_WHEEL
        moment = np.cross(PITCH_POINT - AXES[shaft], force)
        a, b = (SEATS[joint] for joint in joints)
        for i, turn in ((0, moment[1]), (1, -moment[0])):  # x: My = z Fx; y: Mx = -z Fy
            second = (turn - a * force[i]) / (b - a)
            determinate = {joints[0]: force[i] - second, joints[1]: second}
            tilt = sum((states[j].load[4] if i == 0 else -states[j].load[3]) for j in joints)
            allowed = abs(tilt) / (b - a) + 1e-4 * np.linalg.norm(force)
            for joint in joints:
                assert abs(states[joint].load[i] - determinate[joint]) < allowed, (joint, i)
            assert allowed < 0.2 * np.linalg.norm(force)


@pytest.mark.parametrize("name", NAMES)
def test_power_is_balanced_and_flows_one_way(cases, name):
    for flow in cases[name].flows.values():
        lost = flow.dissipated_power.sum("element") / flow.input_power
        assert abs(lost.values - 1.0).max() < 1e-8
        assert flow.alpha.values.min() > 0.0
        assert flow.alpha.values.max() < 1.0


@pytest.mark.parametrize("name", NAMES)
def test_synthesis_agrees_with_the_unsynthesised_solution(cases, name):
    from gearpath.study.sweeping import reference_checks

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = reference_checks(cases[name].model.replace({"frequency.points": 200}), quiet=True)
    assert all(check.passed for check in found), found


def test_shipped_model_is_the_deep_groove_case(example, cases):
    import gearpath as gp

    shipped = gp.load(ROOT / "models" / "bearing_study.toml")
    assert json.dumps(shipped.to_dict(), sort_keys=True) == json.dumps(
        cases["deep groove"].model.to_dict(), sort_keys=True
    )
    flow = gp.power_flow(shipped, example["LINES"])
    np.testing.assert_allclose(flow.alpha, cases["deep groove"].flows["full"].alpha, rtol=1e-9)
