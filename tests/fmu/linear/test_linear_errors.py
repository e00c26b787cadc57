"""What cannot become the FMU of a linear system is refused with one sentence, and nothing is written."""

import control
import numpy as np
import pytest
from linear_cases import random_system

import gearpath as gp
from gearpath.errors import InputError
from gearpath.fmu.linear_system import LARGEST, from_control


def one(**labels):
    return control.StateSpace([[-1.0]], [[1.0]], [[1.0]], [[0.0]], name="it", **labels)


def with_entry(letter, value):
    system = random_system(2)
    setattr(system, letter, np.where(np.eye(*getattr(system, letter).shape) > 0, value, getattr(system, letter)))
    return system


WRONG = {
    "sampled": (lambda: control.c2d(one(), 1e-3), r"it\$sampled: dt = 0.001 is a sampled system.*with dt = 0"),
    "sampled without a time": (lambda: control.ss([[0.5]], [[1]], [[1]], [[0]], True), "dt = True is a sampled system"),
    "complex": (lambda: with_entry("A", 1j), "matrix A has an entry that is complex"),
    "nan": (lambda: with_entry("B", np.nan), "matrix B has an entry that is complex or not finite"),
    "infinite": (lambda: with_entry("D", np.inf), "matrix D has an entry"),
    "improper": (lambda: control.tf([1, 2, 3], [1, 3], name="pd"), "pd: the transfer function is improper"),
    "name": (lambda: one(inputs="mount 1"), "it: 'mount 1' cannot name an FMU variable"),
    "name of a state": (lambda: one(states="2nd"), "'2nd' cannot name"),
    "name with an empty part": (lambda: one(outputs="a//b"), "'a..b' cannot name"),
    "input and output": (lambda: one(inputs="u", outputs="u"), "two of its inputs, outputs and states .*'u'"),
    "input and state": (lambda: one(inputs="v", states="v"), "are called 'v'; rename one"),
    "no output": (lambda: control.StateSpace([[-1]], [[1]], np.zeros((0, 1)), np.zeros((0, 1))), "no output"),
    "too many states": (lambda: control.ss(-np.eye(LARGEST + 1), *[np.ones(s) for s in SHAPES]), "1001 states"),
    "frequency data": (lambda: control.frd([1, 2], [1.0, 2.0]), "FrequencyResponseData cannot become an FMU"),
    "nothing of the kind": (lambda: 3.0, "model: float cannot become an FMU; give a Model, or"),
}
SHAPES = [(LARGEST + 1, 1), (1, LARGEST + 1), (1, 1)]


@pytest.mark.parametrize("case", WRONG)
def test_wrong_systems(case, tmp_path):
    make, sentence = WRONG[case]
    with pytest.raises(InputError, match=sentence) as error:
        gp.export_fmu(make(), tmp_path / "it.fmu")
    assert "\n" not in str(error.value)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"fmi": "1.0"}, "fmi: version '1.0' is not available"),
        ({"kind": "python"}, "kind: 'python' is for a Model"),
        ({"schedule": [1.0, 2.0]}, "schedule: is for a Model only"),
        ({"order": 4}, "order: is for a Model only"),
        ({"units": {"act1": "N"}}, "units: there is no signal 'act1'; did you mean 'act_1'"),
        ({"units": {"act_1": "lbf"}}, "the unit 'lbf' is not understood"),
        ({"step_size": 0.0}, "step 0.0 s are no experiment"),
        ({"step_size": float("nan")}, "no experiment"),
        ({"step_size": "a"}, "step_size: 'a' is not a number; give seconds"),
        ({"step_size": [1e-5]}, "step_size: .* is not a number"),
        ({"name": 5}, "name: 5 is no text"),
        ({"description": 5}, "description: 5 is no text"),
        ({"units": "N"}, "units: 'N' gives no units by name"),
    ],
    ids=str,
)
def test_wrong_requests(settings, sentence, tmp_path):
    with pytest.raises(InputError, match=sentence):
        gp.export_fmu(random_system(3), tmp_path / "it.fmu", **settings)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("path", ["it.zip", "."])
def test_wrong_paths(path, tmp_path):
    with pytest.raises(InputError, match=r"ends in \.fmu|is a folder"):
        gp.export_fmu(random_system(1), tmp_path / path)


def test_a_model_takes_nothing_of_it(tmp_path):
    model = gp.load("models/gearbox.toml")
    for settings in ({"units": {}}, {"name": "x"}, {"description": "x"}, {"step_size": 1e-4}):
        with pytest.raises(InputError, match=f"{next(iter(settings))}: is for a python-control system only"):
            gp.export_fmu(model, tmp_path / "it.fmu", **settings)


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"schedule": 5.0}, "schedule: 5.0 are no torques"),
        ({"schedule": ["a", "b"]}, "are no torques; give two or more numbers in N m"),
        ({"order": "a"}, "order: 'a' is not a number of coordinates"),
        ({"tolerance": "a"}, "tolerance: 'a' is not a relative error"),
        ({"order": 30, "band": "ab"}, "band: 'ab' is not a pair"),
        ({"path": 5}, "path: 5 is no path; give the name of a file"),
    ],
)
def test_numbers_that_are_none(settings, sentence, tmp_path):
    with pytest.raises(InputError, match=sentence):
        gp.export_fmu(gp.load("models/gearbox.toml"), **{"path": tmp_path / "it.fmu"} | settings)
    assert not list(tmp_path.iterdir())


def test_names_of_python_control_itself():
    """Defaults such as u[0] are names of FMI too; a transfer function keeps its own name."""
    system = from_control(control.ss([[-1, 0], [0, -2]], np.eye(2), np.eye(2), np.zeros((2, 2))))
    assert (system.inputs, system.outputs, system.states) == (
        ("u[0]", "u[1]"),
        ("y[0]", "y[1]"),
        ("x[0]", "x[1]"),
    )
    lag = from_control(control.tf([1.0], [1.0, 1.0], name="lag", inputs="housing/obs_uy/velocity"))
    assert (lag.name, lag.inputs) == ("lag", ("housing.obs_uy.velocity",))
    assert from_control(lag_unspecified()).states == ("x[0]",)


def lag_unspecified():
    return control.StateSpace([[-1.0]], [[1.0]], [[1.0]], [[0.0]], None)


def test_balance_is_of_powers_of_two():
    """Rows and columns of the balanced A are alike, and no input's column is larger than it."""
    system = from_control(control.tf([1.0], np.poly([-1.0, -1e3, -1e6]), name="lags"))
    unit = system.balance
    assert (np.log2(unit) == np.rint(np.log2(unit))).all()
    T, v = unit[:3], unit[3:]
    A, B = system.A * T / T[:, None], system.B * v / T[:, None]
    assert abs(A).max() < 1e7 < abs(system.A).max()
    assert 0.5 <= abs(B).sum(axis=0)[0] / abs(A).sum(axis=0).max() <= 2.0
